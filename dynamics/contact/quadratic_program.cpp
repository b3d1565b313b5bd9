#include "dynamics/contact/quadratic_program.h"

#include <Eigen/Cholesky>
#include <Eigen/Householder>
#include <Eigen/Jacobi>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace possibility::dynamics {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kFeasibility = 1e-11;  // relative to the sizes of x and of the bound
constexpr double kRounding = 1e-13;     // of a dual step, relative to the new normal
constexpr double kDependence = 1e-10;   // sine of the angle to the span of the active normals

void CheckProgram(const QuadraticProgram& p) {
  const Index n = p.g.size();
  const auto fits = [n](const MatrixXd& rows, const VectorXd& bounds) {
    return rows.rows() == bounds.size() && (rows.rows() == 0 || rows.cols() == n);
  };
  if (p.H.rows() != n || p.H.cols() != n || !fits(p.E, p.e) || !fits(p.C, p.d)) {
    throw std::invalid_argument("QuadraticProgram: the sizes of its parts disagree");
  }
  if (!p.H.allFinite() || !p.g.allFinite() || !p.E.allFinite() || !p.e.allFinite() ||
      !p.C.allFinite() || !p.d.allFinite()) {
    throw std::invalid_argument("QuadraticProgram: a number is not finite");
  }
}

/// The working set W of active constraints n_i'x = b_i, with H = J^-T J^-1 and J'N = [R; 0] kept
/// up to date (Goldfarb & Idnani 1983, section 4). An inequality is held as -C x >= -d.
class WorkingSet {
 public:
  explicit WorkingSet(const QuadraticProgram& program) : n_(program.g.size()), g_(program.g) {
    const Eigen::LLT<MatrixXd> llt(program.H);
    if (llt.info() != Eigen::Success) {
      throw std::invalid_argument("QuadraticProgram: H is not positive definite");
    }
    J_.setIdentity(n_, n_);
    llt.matrixU().solveInPlace(J_);
    R_.setZero(n_, n_);
    bounds_.resize(n_);
    gradient_.noalias() = J_.transpose() * g_;
    x_ = -(J_ * gradient_);
    direction_.resize(n_);
    dual_step_.resize(n_);
    workspace_.resize(n_);
    multipliers_.reserve(n_ + 1);
    rows_.reserve(n_ + 1);
  }

  Index size() const { return static_cast<Index>(rows_.size()); }
  const VectorXd& x() const { return x_; }
  const std::vector<int>& rows() const { return rows_; }
  const std::vector<double>& multipliers() const { return multipliers_; }

  /// Computes the primal and dual steps for a new normal. True if it is independent of the active
  /// ones.
  bool Consider(const VectorXd& normal) {
    projected_.noalias() = J_.transpose() * normal;
    const Index q = size();
    curvature_ = projected_.tail(n_ - q).squaredNorm();
    dual_step_.head(q) = projected_.head(q);
    R_.topLeftCorner(q, q).triangularView<Eigen::Upper>().solveInPlace(dual_step_.head(q));
    const bool independent = curvature_ > kDependence * kDependence * projected_.squaredNorm();
    if (independent) {
      direction_.noalias() = J_.rightCols(n_ - q) * projected_.tail(n_ - q);
    } else {
      direction_.setZero();
    }
    return independent;
  }

  /// Length of the step that makes a constraint violated by `violation` active.
  double FullStep(double violation) const { return violation / curvature_; }

  /// The longest step that keeps the multipliers of inequalities (from position `first` on)
  /// non-negative, and the position that ends it.
  double PartialStep(Index first, Index* blocking) const {
    double step = std::numeric_limits<double>::infinity();
    const double rounding = kRounding * projected_.norm();
    for (Index i = first; i < size(); ++i) {
      if (dual_step_[i] * R_.col(i).head(i + 1).norm() <= rounding) continue;
      const double ratio = std::max(0.0, multipliers_[i]) / dual_step_[i];
      if (ratio < step) {
        step = ratio;
        *blocking = i;
      }
    }
    return step;
  }

  void Step(double length) {
    x_ += length * direction_;
    for (Index i = 0; i < size(); ++i) multipliers_[i] -= length * dual_step_[i];
  }

  /// Adds the constraint last considered.
  void Add(int row, double bound, double multiplier) {
    const Index q = size();
    auto tail = projected_.tail(n_ - q);
    double tau = 0;
    double beta = 0;
    tail.makeHouseholderInPlace(tau, beta);
    J_.rightCols(n_ - q).applyHouseholderOnTheRight(tail.tail(n_ - q - 1), tau, workspace_.data());
    R_.col(q).head(q) = projected_.head(q);
    R_(q, q) = beta;
    bounds_[q] = bound;
    rows_.push_back(row);
    multipliers_.push_back(multiplier);
  }

  void Drop(Index position) {
    const Index q = size();
    for (Index i = position; i + 1 < q; ++i) {
      R_.col(i).head(i + 2) = R_.col(i + 1).head(i + 2);
      bounds_[i] = bounds_[i + 1];
    }
    rows_.erase(rows_.begin() + position);
    multipliers_.erase(multipliers_.begin() + position);
    for (Index i = position; i + 1 < q; ++i) {
      Eigen::JacobiRotation<double> rotation;
      double diagonal = 0;
      rotation.makeGivens(R_(i, i), R_(i + 1, i), &diagonal);
      R_(i, i) = diagonal;
      R_(i + 1, i) = 0;
      auto right = R_.block(0, i + 1, q, q - i - 2);
      right.applyOnTheLeft(i, i + 1, rotation.adjoint());
      J_.applyOnTheRight(i, i + 1, rotation);
    }
    R_.col(q - 1).setZero();
  }

  /// Recomputes x and the multipliers from the factors, which removes the rounding of the steps.
  /// With x = J s, the active rows read R's = b and the rest of s minimises the cost.
  void Polish() {
    const Index q = size();
    const auto R = R_.topLeftCorner(q, q).triangularView<Eigen::Upper>();
    gradient_.noalias() = J_.transpose() * g_;
    VectorXd s = -gradient_;
    s.head(q) = bounds_.head(q);
    R.transpose().solveInPlace(s.head(q));
    x_.noalias() = J_ * s;
    VectorXd multipliers = s.head(q) + gradient_.head(q);
    R.solveInPlace(multipliers);
    for (Index i = 0; i < q; ++i) multipliers_[i] = multipliers[i];
  }

 private:
  Index n_;
  const VectorXd& g_;
  MatrixXd J_;
  MatrixXd R_;
  VectorXd bounds_;
  VectorXd gradient_;  // J'g
  VectorXd x_;
  VectorXd projected_;
  VectorXd direction_;
  VectorXd dual_step_;
  VectorXd workspace_;
  double curvature_ = 0;
  std::vector<int> rows_;
  std::vector<double> multipliers_;
};

class Solver {
 public:
  explicit Solver(const QuadraticProgram& program)
      : program_(program),
        working_(program),
        norms_(program.C.rows() > 0 ? VectorXd(program.C.rowwise().norm()) : VectorXd::Zero(0)),
        size_(working_.x().norm()) {}

  QuadraticProgramSolution Run() {
    QuadraticProgramSolution solution;
    solution.status = AddEqualities() ? AddInequalities(&solution.iterations)
                                      : QuadraticProgramStatus::kInfeasible;
    solution.x = working_.x();
    if (solution.status == QuadraticProgramStatus::kSolved) CopyMultipliers(&solution);
    return solution;
  }

 private:
  /// Adds the equalities. False if they contradict each other. Dependent rows are left out.
  bool AddEqualities() {
    for (Index i = 0; i < program_.e.size(); ++i) {
      const VectorXd normal = program_.E.row(i);
      const double residual = program_.e[i] - normal.dot(working_.x());
      if (working_.Consider(normal)) {
        const double step = working_.FullStep(residual);
        working_.Step(step);
        working_.Add(static_cast<int>(i), program_.e[i], step);
        size_ = std::max(size_, working_.x().norm());
      } else if (std::abs(residual) >
                 program_.equality_tolerance * (std::abs(program_.e[i]) + normal.norm() * size_)) {
        return false;
      }
    }
    equalities_ = working_.size();
    working_.Polish();
    return true;
  }

  QuadraticProgramStatus AddInequalities(int* iterations) {
    const int limit = 20 * static_cast<int>(program_.g.size() + program_.d.size()) + 20;
    bool polished = true;
    while (*iterations < limit) {
      double violation = 0;
      const int row = MostViolated(&violation);
      if (row < 0 && polished) return QuadraticProgramStatus::kSolved;
      if (row < 0) {
        working_.Polish();
        polished = true;
        continue;
      }
      polished = false;
      if (!Activate(row, violation, limit, iterations)) {
        return *iterations <= limit ? QuadraticProgramStatus::kInfeasible
                                    : QuadraticProgramStatus::kIterationLimit;
      }
      size_ = std::max(size_, working_.x().norm());
    }
    return QuadraticProgramStatus::kIterationLimit;
  }

  /// The row that is violated by the greatest distance; -1 if none. `violation` > 0.
  int MostViolated(double* violation) {
    if (program_.d.size() == 0) return -1;
    excess_.noalias() = program_.C * working_.x();
    excess_ -= program_.d;
    int worst = -1;
    double worst_distance = 0;
    for (Index i = 0; i < excess_.size(); ++i) {
      const double tolerance = kFeasibility * (std::abs(program_.d[i]) + norms_[i] * size_);
      if (excess_[i] <= tolerance) continue;
      const double distance = norms_[i] > 0 ? excess_[i] / norms_[i] : excess_[i];
      if (worst < 0 || distance > worst_distance) {
        worst = static_cast<int>(i);
        worst_distance = distance;
        *violation = excess_[i];
      }
    }
    return worst;
  }

  /// Makes a violated row active and drops rows that block it. False if no point satisfies it
  /// together with the equalities and active rows, or at the iteration limit.
  bool Activate(int row, double violation, int limit, int* iterations) {
    normal_ = -program_.C.row(row);
    double multiplier = 0;
    while (++*iterations <= limit) {
      const bool independent = working_.Consider(normal_);
      const double full =
          independent ? working_.FullStep(violation) : std::numeric_limits<double>::infinity();
      Index blocking = -1;
      const double partial = working_.PartialStep(equalities_, &blocking);
      const double step = std::min(full, partial);
      if (!std::isfinite(step)) return false;
      working_.Step(step);
      multiplier += step;
      if (full <= partial) {
        working_.Add(static_cast<int>(program_.e.size()) + row, -program_.d[row], multiplier);
        return true;
      }
      working_.Drop(blocking);
      violation = program_.C.row(row).dot(working_.x()) - program_.d[row];
    }
    return false;
  }

  void CopyMultipliers(QuadraticProgramSolution* solution) const {
    const Index equalities = program_.e.size();
    solution->y.setZero(equalities);
    solution->z.setZero(program_.d.size());
    for (Index i = 0; i < working_.size(); ++i) {
      const int row = working_.rows()[i];
      if (row < equalities) {
        solution->y[row] = -working_.multipliers()[i];
      } else {
        solution->z[row - equalities] = std::max(0.0, working_.multipliers()[i]);
      }
    }
  }

  const QuadraticProgram& program_;
  WorkingSet working_;
  VectorXd norms_;
  VectorXd excess_;
  VectorXd normal_;
  double size_;  // largest size of x so far; tolerances are relative to it
  Index equalities_ = 0;
};

}  // namespace

QuadraticProgramSolution Solve(const QuadraticProgram& program) {
  CheckProgram(program);
  return Solver(program).Run();
}

}  // namespace possibility::dynamics
