#include "collocation/problem/check_derivatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace possibility::collocation {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = DerivativeFault::Kind;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The greatest finite element.
double Greatest(const MatrixXd& elements) {
  double greatest = 0;
  for (const double element : elements.reshaped()) {
    if (std::isfinite(element)) greatest = std::max(greatest, std::abs(element));
  }
  return greatest;
}

/// Derivatives with their estimated errors, which are infinite where the function is undefined.
struct Differences {
  VectorXd values, errors;
};

/// The derivative at 0 of a vector function of one number. Of all central differences and their
/// extrapolations, each element takes the one that differs least from its neighbours. Rounding may
/// make neighbours equal by chance, so no error counts as less than that of rounding.
Differences Extrapolated(const std::function<VectorXd(double)>& f, double size) {
  constexpr int kSteps = 7;
  constexpr double kRatio = 3, kRounding = 1e-12;
  std::array<VectorXd, kSteps> before, now;
  Differences best;
  double step = 0.1 * size, greatest = 0;
  for (int i = 0; i < kSteps; ++i, step /= kRatio) {
    const VectorXd ahead = f(step);
    greatest = std::max(greatest, Greatest(ahead));
    now[0] = (ahead - f(-step)) / (2 * step);
    if (i == 0) best = {now[0], VectorXd::Constant(now[0].size(), HUGE_VAL)};
    double power = 1;
    for (int j = 1; j <= i; ++j) {
      power *= kRatio * kRatio;
      now[j] = (power * now[j - 1] - before[j - 1]) / (power - 1);
      // The sum of both distances, so that one that is not a number counts as none.
      const VectorXd errors =
          (now[j] - now[j - 1]).cwiseAbs() + (now[j] - before[j - 1]).cwiseAbs();
      for (Eigen::Index k = 0; k < errors.size(); ++k) {
        if (!(errors[k] < best.errors[k])) continue;
        best.errors[k] = errors[k];
        best.values[k] = now[j][k];
      }
    }
    std::swap(before, now);
  }
  best.errors = best.errors.cwiseMax(kRounding * greatest / size);
  return best;
}

/// One function at one point.
class Comparison {
 public:
  Comparison(Function* f, const VectorXd& z, const DerivativeCheck& check)
      : f_(*f), z_(z), check_(check) {}

  void CompareJacobian() {
    const MatrixXd given = Jacobian(z_);
    const Matrices differences = Differenced([this](const VectorXd& z) { return Values(z); });
    const Mask mask = f_.JacobianMask();
    for (int o = 0; o < f_.num_outputs(); ++o) {
      Compare({Kind::kJacobian, o, 0, o}, given.row(o), differences.values.row(o),
              differences.errors.row(o), mask.row(o));
    }
  }

  void CompareHessians() {
    const int n = f_.num_inputs(), m = f_.num_outputs();
    // Row o + m a, column b: the derivative of the Jacobian's element (o, a) by argument b.
    const Matrices differences =
        Differenced([this](const VectorXd& z) { return VectorXd(Jacobian(z).reshaped()); });
    MatrixXd sum = MatrixXd::Zero(n, n), sum_of_errors = MatrixXd::Zero(n, n);
    const VectorXd multipliers = Multipliers();
    for (int o = 0; o < m; ++o) {
      const auto rows = Eigen::seqN(o, n, m);
      const MatrixXd of_output = differences.values(rows, Eigen::all);
      const MatrixXd errors = differences.errors(rows, Eigen::all);
      CompareHessian(VectorXd::Unit(m, o), o, of_output, errors);
      sum += multipliers[o] * of_output;
      sum_of_errors += std::abs(multipliers[o]) * errors;
    }
    if (faults_.empty()) CompareHessian(multipliers, -1, sum, sum_of_errors);
  }

  const std::vector<DerivativeFault>& faults() const { return faults_; }

 private:
  struct Matrices {
    MatrixXd values, errors;
  };

  VectorXd Values(const VectorXd& z) const {
    VectorXd y(f_.num_outputs());
    f_.Evaluate(z, &y);
    return y;
  }

  MatrixXd Jacobian(const VectorXd& z) const {
    MatrixXd J = MatrixXd::Constant(f_.num_outputs(), f_.num_inputs(), kNaN);
    f_.Jacobian(z, &J);
    // What lies outside the mask need not be written.
    return (J.array().isNaN() && !f_.JacobianMask()).select(0.0, J.array());
  }

  VectorXd Multipliers() const {
    if (check_.multipliers.size() > 0) return check_.multipliers;
    VectorXd multipliers(f_.num_outputs());
    for (int o = 0; o < multipliers.size(); ++o) multipliers[o] = std::cos(o + 0.5);
    return multipliers;
  }

  double SizeOf(int argument) const {
    return check_.sizes.size() == 0 ? 1 : check_.sizes[argument];
  }

  /// Column by column: the derivatives of a vector function by the arguments.
  Matrices Differenced(const std::function<VectorXd(const VectorXd&)>& function) const {
    const Eigen::Index rows = function(z_).size();
    Matrices all{MatrixXd(rows, f_.num_inputs()), MatrixXd(rows, f_.num_inputs())};
    for (int a = 0; a < f_.num_inputs(); ++a) {
      const auto shifted = [&](double step) -> VectorXd {
        VectorXd z = z_;
        z[a] += step;
        try {
          return function(z);
        } catch (const std::runtime_error&) {  // undefined there
          return VectorXd::Constant(rows, kNaN);
        }
      };
      const Differences column = Extrapolated(shifted, SizeOf(a));
      all.values.col(a) = column.values;
      all.errors.col(a) = column.errors;
    }
    return all;
  }

  void CompareHessian(const VectorXd& multipliers, int output, const MatrixXd& differences,
                      const MatrixXd& errors) {
    const int n = f_.num_inputs();
    MatrixXd given = MatrixXd::Constant(n, n, kNaN);
    f_.Hessian(z_, multipliers, &given);
    const Mask mask = f_.HessianMask();
    given = (given.array().isNaN() && !mask).select(0.0, given.array()).eval();
    // The scale of a row alone would be zero for an argument that enters linearly.
    const double scale = Greatest(differences);
    for (int a = 0; a < n; ++a) {
      Compare({Kind::kHessian, a, 0, output}, given.row(a), differences.row(a), errors.row(a),
              mask.row(a), scale);
    }
  }

  void Compare(DerivativeFault place, const Eigen::RowVectorXd& given,
               const Eigen::RowVectorXd& differences, const Eigen::RowVectorXd& errors,
               const Eigen::Array<bool, 1, Eigen::Dynamic>& mask, double scale = 0) {
    // The estimate of the error is itself only an estimate.
    constexpr double kDoubt = 10, kZero = 1e-12;
    scale = std::max(scale, Greatest(differences));
    for (int c = 0; c < given.size(); ++c) {
      const double noise = check_.tolerance * scale + kDoubt * errors[c];
      if (!std::isfinite(noise)) continue;
      place.column = c;
      place.given = given[c];
      place.differenced = differences[c];
      const bool is_wrong = !(std::abs(given[c] - differences[c]) <= noise);
      const bool is_zero = std::abs(given[c]) <= kZero * scale;
      const bool is_hidden = !mask[c] && (!is_zero || std::abs(differences[c]) > noise);
      if (!is_wrong && !is_hidden) continue;
      DerivativeFault fault = place;
      if (is_hidden) {
        fault.kind = place.kind == Kind::kJacobian ? Kind::kJacobianMask : Kind::kHessianMask;
      }
      faults_.push_back(fault);
    }
  }

  Function& f_;
  const VectorXd& z_;
  const DerivativeCheck& check_;
  std::vector<DerivativeFault> faults_;
};

void CheckSize(Eigen::Index size, int expected, bool may_be_empty, const char* what) {
  if (size == expected || (may_be_empty && size == 0)) return;
  throw std::invalid_argument(
      fmt::format("CheckDerivatives: {} {}, expected {}", size, what, expected));
}

}  // namespace

std::vector<DerivativeFault> CheckDerivatives(Function* f, const VectorXd& z,
                                              const DerivativeCheck& check) {
  CheckSize(z.size(), f->num_inputs(), false, "arguments");
  CheckSize(check.sizes.size(), f->num_inputs(), true, "sizes");
  CheckSize(check.multipliers.size(), f->num_outputs(), true, "multipliers");
  Comparison comparison(f, z, check);
  comparison.CompareJacobian();
  if (comparison.faults().empty()) comparison.CompareHessians();
  return comparison.faults();
}

}  // namespace possibility::collocation
