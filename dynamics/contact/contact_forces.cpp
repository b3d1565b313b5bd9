#include "dynamics/contact/contact_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/contact/cone_forces.h"

namespace possibility::dynamics {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr const char* kCaller = "DistributeContactForces";
// Limits are tightened by this factor, so that rounding cannot push a force over the true limit.
constexpr double kInside = 1 - 1e-9;
// Tolerated residual of the base wrench, as a fraction of the weight (times a metre).
constexpr double kResidual = 1e-9;

void CheckSettings(const ContactForceSettings& settings, std::size_t num_points) {
  for (const double setting : {settings.friction, settings.friction_margin, settings.torque_margin,
                               settings.normal_reserve}) {
    if (!(setting >= 0 && std::isfinite(setting))) {
      throw std::invalid_argument(
          fmt::format("{}: settings must be finite and not negative", kCaller));
    }
  }
  if (settings.cone_edges < 3) {
    throw std::invalid_argument(
        fmt::format("{}: cone_edges is {}, expected 3 or more", kCaller, settings.cone_edges));
  }
  if (!settings.shares.empty() && settings.shares.size() != num_points) {
    throw std::invalid_argument(
        fmt::format("{}: {} shares, expected {}", kCaller, settings.shares.size(), num_points));
  }
  for (const double share : settings.shares) {
    if (!(share > 0 && share <= 1)) {
      throw std::invalid_argument(
          fmt::format("{}: a share is {}, expected more than 0, at most 1", kCaller, share));
    }
  }
}

/// The balance of a motion: the required generalised forces (base first) and the Jacobian of every
/// point, in the same velocities.
struct Balance {
  VectorXd required;
  MatrixXd jacobians;  // 3 points x nv
  VectorXd efforts;    // by joint
  int num_base = 6;
  double weight = 0;  // N
};

void CheckFinite(const Balance& balance) {
  // The numbers are squared below.
  if (std::isfinite(balance.required.squaredNorm() + balance.jacobians.squaredNorm())) return;
  throw std::invalid_argument(fmt::format(
      "{}: q, v, the acceleration or a point is so large that the forces are not finite", kCaller));
}

/// The problem in forces as fractions of `unit` (N) times the point's share.
class ForceProblem {
 public:
  ForceProblem(const Balance& balance, const std::vector<ContactPoint>& points,
               const ContactForceSettings& settings)
      : balance_(balance), points_(points), settings_(settings) {
    unit_ = balance.weight / std::max<double>(1, points.size());
    if (!(unit_ > 0)) unit_ = 1;
    required_ = balance.required / unit_;
    for (Eigen::Index joint = 0; joint < balance.efforts.size(); ++joint) {
      const bool loaded = !balance.jacobians.col(balance.num_base + joint).isZero(0);
      (loaded ? loaded_ : unloaded_).push_back(static_cast<int>(joint));
    }
    WriteProblem();
  }

  std::optional<ContactForces> Solution() const {
    for (const int joint : unloaded_) {
      if (std::abs(required_[balance_.num_base + joint]) > Limit(joint)) return std::nullopt;
    }
    VectorXd x = VectorXd::Zero(problem_.balance_loads.cols());
    if (x.size() > 0) {
      const std::optional<VectorXd> solution = SolveConeForces(problem_);
      if (!solution) return std::nullopt;
      x = *solution;
    }
    const VectorXd left = problem_.balance_required - problem_.balance_loads * x;
    const double tolerance = kResidual * std::max(1.0, problem_.balance_required.norm());
    if (left.cwiseAbs().maxCoeff() > tolerance) return std::nullopt;
    ContactForces result = Evaluate(x);
    if (result.torque_utilisation > settings_.torque_margin) return std::nullopt;
    return result;
  }

 private:
  double Limit(int joint) const {
    return balance_.efforts[joint] * settings_.torque_margin * kInside / unit_;
  }

  double FrictionAt(const ContactPoint& point) const {
    return std::min(settings_.friction, point.friction);
  }

  void WriteProblem() {
    for (const ContactPoint& point : points_) {
      problem_.normals.push_back(point.normal_W);
      problem_.slopes.push_back(FrictionAt(point) * settings_.friction_margin * kInside);
    }
    problem_.cone_edges = settings_.cone_edges;
    problem_.normal_reserve = settings_.normal_reserve / unit_;
    problem_.balance_loads = balance_.jacobians.leftCols(balance_.num_base).transpose();
    problem_.balance_required = required_.head(balance_.num_base);
    problem_.bounded_loads.resize(loaded_.size(), balance_.jacobians.rows());
    problem_.bounded_required.resize(loaded_.size());
    problem_.bounds.resize(loaded_.size());
    for (std::size_t k = 0; k < loaded_.size(); ++k) {
      const int index = balance_.num_base + loaded_[k];
      problem_.bounded_loads.row(k) = balance_.jacobians.col(index).transpose();
      problem_.bounded_required[k] = required_[index];
      problem_.bounds[k] = Limit(loaded_[k]);
    }
    for (std::size_t i = 0; i < settings_.shares.size(); ++i) {
      problem_.balance_loads.middleCols<3>(3 * i) *= settings_.shares[i];
      problem_.bounded_loads.middleCols<3>(3 * i) *= settings_.shares[i];
    }
  }

  ContactForces Evaluate(const VectorXd& x) const {
    ContactForces result;
    result.forces = unit_ * Eigen::Map<const Eigen::Matrix3Xd>(x.data(), 3, x.size() / 3);
    result.torques = unit_ * required_.tail(balance_.efforts.size());
    for (std::size_t i = 0; i < settings_.shares.size(); ++i) {
      result.forces.col(i) *= settings_.shares[i];
    }
    const VectorXd loads = unit_ * (problem_.bounded_loads * x);
    for (std::size_t k = 0; k < loaded_.size(); ++k) result.torques[loaded_[k]] -= loads[k];
    if (settings_.friction > 0) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const double used = FrictionUsed(points_[i], result.forces.col(i)) / FrictionAt(points_[i]);
        result.friction_utilisation = std::max(result.friction_utilisation, used);
      }
    }
    for (Eigen::Index i = 0; i < result.torques.size(); ++i) {
      if (balance_.efforts[i] <= 0) continue;
      const double used = std::abs(result.torques[i]) / balance_.efforts[i];
      result.torque_utilisation = std::max(result.torque_utilisation, used);
    }
    return result;
  }

  const Balance& balance_;
  const std::vector<ContactPoint>& points_;
  const ContactForceSettings& settings_;
  std::vector<int> loaded_;    // joints that carry the load of some point
  std::vector<int> unloaded_;  // all others
  double unit_ = 1;
  VectorXd required_;
  ConeForceProblem problem_;
};

}  // namespace

std::optional<ContactForces> DistributeContactForces(MultibodyDynamics* dynamics,
                                                     const std::vector<ContactPoint>& points,
                                                     const ContactForceSettings& settings) {
  const MultibodyModel& model = dynamics->model();
  CheckSettings(settings, points.size());
  CheckContactPoints(kCaller, model.tree().num_links(), points);
  Balance balance;
  balance.required = dynamics->InverseDynamics();
  balance.weight = dynamics->kinematics().total_mass() * kGravity;
  balance.num_base = model.num_base_velocities();
  balance.efforts = dynamics->torque_limits();
  balance.jacobians.resize(3 * points.size(), model.nv());
  for (std::size_t i = 0; i < points.size(); ++i) {
    dynamics->Jacobian(points[i], balance.jacobians.middleRows<3>(3 * i));
  }
  CheckFinite(balance);
  return ForceProblem(balance, points, settings).Solution();
}

double FrictionUsed(const ContactPoint& point, const Vector3d& force) {
  const double along = force.dot(point.normal_W);
  return along > 0 ? (force - along * point.normal_W).norm() / along : 0;
}

}  // namespace possibility::dynamics
