#include "collocation/problem/table.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>
#include <string>

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void RequireTable(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument("table: " + what);
}

/// The spline through given values is a sum of them with weights that depend on x alone.
class SplineWeights {
 public:
  explicit SplineWeights(const VectorXd& knots) : knots_(knots) {
    const Eigen::Index n = knots.size();
    RequireTable(n >= 4, fmt::format("{} knots, expected 4 or more", n));
    RequireTable(knots.allFinite(), "a knot is not finite");
    for (Eigen::Index i = 1; i < n; ++i) {
      RequireTable(knots[i] > knots[i - 1],
                   fmt::format("knot {} at {} does not lie beyond the one before, at {}", i,
                               knots[i], knots[i - 1]));
    }
    // Rows: the first derivative is continuous at inner knots (A m = B y, de Boor 1978, chapter 4),
    // the third one at the second knot from either end.
    MatrixXd A = MatrixXd::Zero(n, n);
    MatrixXd B = MatrixXd::Zero(n, n);
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      const double before = knots[i] - knots[i - 1];
      const double after = knots[i + 1] - knots[i];
      A.row(i).segment<3>(i - 1) << before / 6, (before + after) / 3, after / 6;
      B.row(i).segment<3>(i - 1) << 1 / before, -1 / before - 1 / after, 1 / after;
    }
    for (const Eigen::Index end : {Eigen::Index{0}, n - 1}) {
      const Eigen::Index first = end == 0 ? 0 : n - 3;
      const double before = knots[first + 1] - knots[first];
      const double after = knots[first + 2] - knots[first + 1];
      A.row(end).segment<3>(first) << after, -(before + after), before;
    }
    second_ = A.partialPivLu().solve(B);
  }

  /// Of the spline's derivative of an order from 0 to 2 at x.
  VectorXd At(double x, int order) const {
    const auto after = std::upper_bound(knots_.begin(), knots_.end(), x);
    const Eigen::Index k =
        std::clamp<Eigen::Index>(after - knots_.begin() - 1, 0, knots_.size() - 2);
    const double h = knots_[k + 1] - knots_[k];
    const double right = (x - knots_[k]) / h;
    const double left = 1 - right;
    VectorXd weights = VectorXd::Zero(knots_.size());
    const auto add = [&](double value, double next, double second, double next_second) {
      weights[k] += value;
      weights[k + 1] += next;
      weights += second * second_.row(k) + next_second * second_.row(k + 1);
    };
    if (order == 0) {
      add(left, right, (left * left - 1) * left * h * h / 6,
          (right * right - 1) * right * h * h / 6);
    } else if (order == 1) {
      add(-1 / h, 1 / h, (1 - 3 * left * left) * h / 6, (3 * right * right - 1) * h / 6);
    } else {
      add(0, 0, left, right);
    }
    return weights;
  }

 private:
  VectorXd knots_;
  MatrixXd second_;  ///< second derivatives at the knots, by the values
};

class TableOfOne final : public Function {
 public:
  TableOfOne(const VectorXd& knots, const VectorXd& values)
      : Function(1, 1), weights_(knots), values_(values) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = Derivative(z[0], 0); }
  void Jacobian(const VectorXd& z, MatrixXd* J) override { (*J)(0, 0) = Derivative(z[0], 1); }
  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    (*H)(0, 0) = multipliers[0] * Derivative(z[0], 2);
  }

 private:
  double Derivative(double x, int order) const { return weights_.At(x, order).dot(values_); }

  SplineWeights weights_;
  VectorXd values_;
};

class TableOfTwo final : public Function {
 public:
  TableOfTwo(const VectorXd& x_knots, const VectorXd& y_knots, const MatrixXd& values)
      : Function(2, 1), x_weights_(x_knots), y_weights_(y_knots), values_(values) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = Derivative(z, 0, 0); }
  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    *J << Derivative(z, 1, 0), Derivative(z, 0, 1);
  }
  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const double mixed = Derivative(z, 1, 1);
    *H << Derivative(z, 2, 0), mixed, mixed, Derivative(z, 0, 2);
    *H *= multipliers[0];
  }

 private:
  double Derivative(const VectorXd& z, int x_order, int y_order) const {
    return x_weights_.At(z[0], x_order).dot(values_ * y_weights_.At(z[1], y_order));
  }

  SplineWeights x_weights_, y_weights_;
  MatrixXd values_;
};

}  // namespace

std::shared_ptr<Function> Table(const VectorXd& knots, const VectorXd& values) {
  RequireTable(values.size() == knots.size(),
               fmt::format("{} values for {} knots", values.size(), knots.size()));
  RequireTable(values.allFinite(), "a value is not finite");
  return std::make_shared<TableOfOne>(knots, values);
}

std::shared_ptr<Function> Table(const VectorXd& x_knots, const VectorXd& y_knots,
                                const MatrixXd& values) {
  RequireTable(values.rows() == x_knots.size() && values.cols() == y_knots.size(),
               fmt::format("{} x {} values for {} and {} knots", values.rows(), values.cols(),
                           x_knots.size(), y_knots.size()));
  RequireTable(values.allFinite(), "a value is not finite");
  return std::make_shared<TableOfTwo>(x_knots, y_knots, values);
}

}  // namespace possibility::collocation
