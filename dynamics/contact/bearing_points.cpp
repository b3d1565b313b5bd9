#include "dynamics/contact/bearing_points.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/contact/quadratic_program.h"

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// kRegularisation: fraction of the inverse inertia that makes the dual strictly convex if points
// share loads. kAtRest: fraction of the greatest motion below which a point is at rest.
constexpr double kRegularisation = 1e-9;
constexpr double kAtRest = 1e-6;
// Larger sets are not searched exhaustively.
constexpr int kMostSearched = 10;

void Check(const UnilateralContacts& contacts) {
  const Eigen::Index nv = contacts.mass.rows(), rows = 3 * contacts.normals.size();
  if (contacts.mass.cols() != nv || contacts.jacobian.rows() != rows ||
      contacts.jacobian.cols() != nv || contacts.unconstrained.size() != rows) {
    throw std::invalid_argument("SelectBearingPoints: sizes disagree");
  }
  bool is_finite = contacts.mass.allFinite() && contacts.jacobian.allFinite() &&
                   contacts.unconstrained.allFinite();
  is_finite &= std::isfinite(contacts.staying);
  for (const Vector3d& normal : contacts.normals) is_finite &= normal.allFinite();
  if (!is_finite) throw std::invalid_argument("SelectBearingPoints: a number is not finite");
}

/// Two tangents and the normal, as rows.
Matrix3d ContactAxes(const Vector3d& normal) {
  Matrix3d axes;
  axes.row(0) = normal.unitOrthogonal();
  axes.row(1) = normal.cross(Vector3d(axes.row(0)));
  axes.row(2) = normal;
  return axes;
}

class Selection {
 public:
  explicit Selection(const UnilateralContacts& contacts)
      : count_(static_cast<int>(contacts.normals.size())) {
    MatrixXd J(3 * count_, contacts.mass.rows());
    unconstrained_.resize(3 * count_);
    for (int i = 0; i < count_; ++i) {
      const Matrix3d axes = ContactAxes(contacts.normals[i]);
      J.middleRows<3>(3 * i) = axes * contacts.jacobian.middleRows<3>(3 * i);
      unconstrained_.segment<3>(3 * i) = axes * contacts.unconstrained.segment<3>(3 * i);
    }
    const Eigen::LLT<MatrixXd> mass(contacts.mass);
    if (mass.info() != Eigen::Success) {
      throw std::invalid_argument("SelectBearingPoints: the mass matrix is not positive definite");
    }
    inverse_inertia_ = J * mass.solve(J.transpose());
    at_rest_ = kAtRest * unconstrained_.lpNorm<Eigen::Infinity>();
    staying_ = std::max(at_rest_, contacts.staying);
  }

  BearingSelection Run() {
    std::vector<bool> bears(count_, true);
    std::vector<std::vector<bool>> tried;
    while (std::find(tried.begin(), tried.end(), bears) == tried.end()) {
      tried.push_back(bears);
      const VectorXd motion = PushedMotion(Indices(bears));
      for (int i = 0; i < count_; ++i) {
        bears[i] = bears[i] ? motion[i] <= staying_ : motion[i] < -at_rest_;
      }
      if (bears == tried.back()) return {Indices(bears), {}};
    }
    if (const auto found = Search()) return {*found, {}};
    return Jam(std::move(bears));
  }

 private:
  static std::vector<int> Indices(const std::vector<bool>& bears) {
    std::vector<int> indices;
    for (size_t i = 0; i < bears.size(); ++i) {
      if (bears[i]) indices.push_back(static_cast<int>(i));
    }
    return indices;
  }

  /// The largest set whose points stay at rest without pulling while no other enters the ground.
  std::optional<std::vector<int>> Search() const {
    if (count_ > kMostSearched) return std::nullopt;
    std::optional<std::vector<int>> best;
    for (unsigned mask = 0; mask < 1u << count_; ++mask) {
      std::vector<bool> bears(count_);
      for (int i = 0; i < count_; ++i) bears[i] = mask >> i & 1;
      const std::vector<int> set = Indices(bears);
      if (best && set.size() <= best->size()) continue;
      const VectorXd motion = PushedMotion(set);
      bool fits = true;
      for (int i = 0; i < count_; ++i) {
        fits &= bears[i] ? motion[i] <= staying_ : motion[i] >= -at_rest_;
      }
      if (fits) best = set;
    }
    return best;
  }

  /// Holds every point that would enter the ground, pulling or not.
  BearingSelection Jam(std::vector<bool> bears) const {
    for (bool has_changed = true; has_changed;) {
      const VectorXd motion = AlongNormals(HoldingForces(Indices(bears)), Indices(bears));
      has_changed = false;
      for (int i = 0; i < count_; ++i) {
        if (bears[i] || motion[i] >= -at_rest_) continue;
        bears[i] = has_changed = true;
      }
    }
    BearingSelection result;
    result.points = Indices(bears);
    const VectorXd forces = HoldingForces(result.points);
    for (size_t i = 0; i < result.points.size(); ++i) {
      if (forces[3 * i + 2] < 0) result.jammed.push_back(result.points[i]);
    }
    return result;
  }

  static std::vector<int> Rows(const std::vector<int>& set) {
    std::vector<int> rows;
    for (const int point : set) rows.insert(rows.end(), {3 * point, 3 * point + 1, 3 * point + 2});
    return rows;
  }

  /// Motion of all points along their normals, under forces on those in `set`.
  VectorXd AlongNormals(const VectorXd& forces, const std::vector<int>& set) const {
    VectorXd motion = unconstrained_;
    if (!set.empty()) motion += inverse_inertia_(Eigen::all, Rows(set)) * forces;
    VectorXd along_normals(count_);
    for (int i = 0; i < count_; ++i) along_normals[i] = motion[3 * i + 2];
    return along_normals;
  }

  VectorXd PushedMotion(const std::vector<int>& set) const {
    return AlongNormals(set.empty() ? VectorXd() : PushingForces(Rows(set)), set);
  }

  /// Forces of least norm that hold all points of `set`.
  VectorXd HoldingForces(const std::vector<int>& set) const {
    if (set.empty()) return {};
    const std::vector<int> rows = Rows(set);
    MatrixXd gram = inverse_inertia_(rows, rows);
    gram.diagonal().array() += kRegularisation * gram.diagonal().mean();
    return -gram.ldlt().solve(unconstrained_(rows));
  }

  /// Forces that keep the points from entering the ground and from sliding, without pulling.
  VectorXd PushingForces(const std::vector<int>& rows) const {
    const Eigen::Index size = static_cast<Eigen::Index>(rows.size());
    QuadraticProgram program;
    program.H = inverse_inertia_(rows, rows);
    // Scaled so that the motion and the forces are about 1.
    const double inertia = program.H.diagonal().mean();
    const double scale = std::max(unconstrained_.lpNorm<Eigen::Infinity>(), 1e-300);
    program.H = program.H / inertia + kRegularisation * MatrixXd::Identity(size, size);
    program.g = unconstrained_(rows) / scale;
    program.E.resize(0, size);
    program.e.resize(0);
    program.C.setZero(size / 3, size);
    for (Eigen::Index i = 0; i < size / 3; ++i) program.C(i, 3 * i + 2) = -1;
    program.d.setZero(size / 3);
    const QuadraticProgramSolution solution = Solve(program);
    if (solution.status != QuadraticProgramStatus::kSolved) {
      throw std::runtime_error("SelectBearingPoints: the quadratic program was not solved");
    }
    return solution.x * (scale / inertia);
  }

  int count_;
  VectorXd unconstrained_;
  MatrixXd inverse_inertia_;
  double at_rest_ = 0;
  double staying_ = 0;
};

}  // namespace

BearingSelection SelectBearingPoints(const UnilateralContacts& contacts) {
  Check(contacts);
  if (contacts.normals.empty()) return {};
  return Selection(contacts).Run();
}

}  // namespace possibility::dynamics
