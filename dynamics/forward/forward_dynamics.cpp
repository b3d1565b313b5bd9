#include "dynamics/forward/forward_dynamics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace possibility::dynamics {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Fractions of what a constraint balances: the residual that is tolerated, and the residual above
// which the slower, more exact solver is used.
constexpr double kUnmet = 1e-8;
// The same of the feedback of drift, over kUnmet. A rigid body that has turned by e since it was
// held cannot give all its points the feedback that each asks for: e/2 of it is left. Feedback need
// not be exact.
constexpr double kUnmetDrift = 1e-3 / kUnmet;
constexpr double kRefine = 1e-12;

/// Per joint, the independent velocities that move its link: only these share mass.
std::vector<std::vector<int>> VelocityCliques(const MultibodyModel& model) {
  const std::vector<models::Joint>& joints = model.tree().joints;
  std::vector<std::vector<int>> cliques(1 + joints.size());
  for (int i = 0; i < model.num_base_velocities(); ++i) cliques[0].push_back(i);
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    std::vector<int>& clique = cliques[joint + 1];
    clique = cliques[joints[joint].parent];
    const int independent = model.couplings()[6 + joint].independent;
    if (independent >= 0) clique.push_back(independent);
  }
  return cliques;
}

const ContactPoint& PointOf(const HeldPoint& held) { return held.point; }
const ContactPoint& PointOf(const ContactPoint& point) { return point; }

std::string VelocityName(const MultibodyModel& model, int index) {
  if (index < model.num_base_velocities()) return "the base";
  const int joint = model.joints()[index - model.num_base_velocities()];
  return fmt::format("joint '{}'", model.tree().joints[joint].name);
}

}  // namespace

ForwardDynamics::ForwardDynamics(std::shared_ptr<const MultibodyModel> model,
                                 const ForwardDynamicsSettings& settings)
    : settings_(settings),
      dynamics_(std::move(model)),
      mass_factor_(dynamics_.model().nv(), VelocityCliques(dynamics_.model())) {
  if (!(settings.drift_time > 0)) {
    throw std::invalid_argument(
        fmt::format("ForwardDynamics: the drift time is {}, expected a positive number or infinity",
                    settings.drift_time));
  }
  zero_.setZero(dynamics_.model().nv());
}

void ForwardDynamics::SetState(const Eigen::Ref<const VectorXd>& q,
                               const Eigen::Ref<const VectorXd>& v) {
  has_state_ = has_factor_ = false;
  dynamics_.SetState(q, v);
  bias_ = dynamics_.InverseDynamics();
  if (!bias_.allFinite()) {
    throw std::invalid_argument(
        "ForwardDynamics: q or v is so large that the forces it needs are not finite");
  }
  velocity_ = v;
  has_state_ = true;
}

const VectorXd& ForwardDynamics::Free(const Eigen::Ref<const VectorXd>& forces) {
  RequireState();
  CheckForces(forces);
  Factor();
  AccelerateFreely(forces);
  has_points_ = false;
  return free_;
}

ConstrainedResponse ForwardDynamics::Response() {
  RequireState();
  Factor();
  const Eigen::Index nv = model().nv();
  ConstrainedResponse response;
  response.to_forces.resize(nv, nv);
  VectorXd column(nv);
  for (Eigen::Index i = 0; i < nv; ++i) {
    column = VectorXd::Unit(nv, i);
    mass_factor_.Solve(&column);
    response.to_forces.col(i) = column;
  }
  response.to_drift.setZero(nv, nv);
  if (!has_points_) return response;
  // With Z = M^-1 J' Q and the Gram matrix G = Q' J Z: M^-1 - Z G^+ Z', and Z G^+ Q' J.
  MatrixXd Z = half_solved_;
  for (Eigen::Index i = 0; i < Z.cols(); ++i) mass_factor_.SolveLower(Z.col(i));
  const MatrixXd shares = gram_.SolveRoughly(Z.transpose());
  response.to_drift.noalias() = Z * (shares * dynamics_.MassMatrix());
  response.to_forces.noalias() -= Z * shares;
  return response;
}

const ConstrainedMotion& ForwardDynamics::Held(const Eigen::Ref<const VectorXd>& forces,
                                               const std::vector<HeldPoint>& points) {
  RequireState();
  CheckForces(forces);
  const bool feedback = std::isfinite(settings_.drift_time);
  for (std::size_t i = 0; i < points.size(); ++i) {
    CheckPoint(i, points[i].point);
    if (feedback && !points[i].anchor.allFinite()) {
      throw std::invalid_argument(fmt::format("ForwardDynamics: the anchor of {} is not finite",
                                              Described(i, points[i].point)));
    }
  }
  Factor();
  AccelerateFreely(forces);
  dynamics_.SetAcceleration(zero_);
  Constrain(points);
  const double rate = feedback ? 1 / settings_.drift_time : 0;
  double scale = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& point = points[i].point;
    const Vector3d unforced = jacobians_.middleRows<3>(3 * i) * free_;
    const Vector3d bias = dynamics_.Acceleration(point);
    Vector3d drift = Vector3d::Zero();
    if (feedback) {
      drift = 2 * rate * dynamics_.Velocity(point) +
              rate * rate * (dynamics_.Position(point) - points[i].anchor);
    }
    required_.segment<3>(3 * i) = -(unforced + bias + drift);
    for (const Vector3d& term : {unforced, bias, Vector3d(kUnmetDrift * drift)}) {
      scale = std::max(scale, term.lpNorm<Eigen::Infinity>());
    }
  }
  SolveMultipliers(points, scale, "m/s^2");
  has_points_ = true;
  motion_.acceleration = free_ + change_;
  motion_.forces = Eigen::Map<const Eigen::Matrix3Xd>(multipliers_.data(), 3, points.size());
  return motion_;
}

const Impact& ForwardDynamics::Hit(const std::vector<ContactPoint>& points) {
  RequireState();
  for (std::size_t i = 0; i < points.size(); ++i) CheckPoint(i, points[i]);
  Factor();
  has_points_ = false;
  Constrain(points);
  double scale = 0;
  if (!points.empty()) {
    required_.noalias() = -(jacobians_ * velocity_);
    scale = (jacobians_.cwiseAbs() * velocity_.cwiseAbs()).maxCoeff();
  }
  SolveMultipliers(points, scale, "m/s");
  impact_.velocity = velocity_ + change_;
  impact_.impulses = Eigen::Map<const Eigen::Matrix3Xd>(multipliers_.data(), 3, points.size());
  // With J v+ = 0: T- - T+ is the kinetic energy of v- - v+, half the square of Y Lambda.
  impact_.energy_lost = 0.5 * (half_solved_ * reduced_).squaredNorm();
  return impact_;
}

void ForwardDynamics::RequireState() const {
  if (has_state_) return;
  throw std::invalid_argument("ForwardDynamics: there is no state q, v; SetState comes first");
}

void ForwardDynamics::CheckForces(const Eigen::Ref<const VectorXd>& forces) const {
  if (forces.size() != model().nv()) {
    throw std::invalid_argument(fmt::format("ForwardDynamics: forces has {} elements, expected {}",
                                            forces.size(), model().nv()));
  }
  if (!forces.allFinite()) {
    throw std::invalid_argument("ForwardDynamics: forces is not finite");
  }
}

void ForwardDynamics::CheckPoint(std::size_t index, const ContactPoint& point) const {
  const int links = model().tree().num_links();
  if (point.link < 0 || point.link >= links) {
    throw std::invalid_argument(fmt::format(
        "ForwardDynamics: point {} is on link {}, expected 0 to {}", index, point.link, links - 1));
  }
  if (!point.p_L.allFinite()) {
    throw std::invalid_argument(
        fmt::format("ForwardDynamics: {} is not finite", Described(index, point)));
  }
}

std::string ForwardDynamics::Described(std::size_t index, const ContactPoint& point) const {
  return fmt::format("point {} (link '{}')", index, model().tree().links[point.link].name);
}

void ForwardDynamics::Factor() {
  if (has_factor_) return;
  const int failed = mass_factor_.Factor(dynamics_.MassMatrix());
  if (failed >= 0) {
    throw std::runtime_error(
        fmt::format("ForwardDynamics: the mass matrix is not positive definite: {} moves nothing "
                    "that has mass",
                    VelocityName(model(), failed)));
  }
  has_factor_ = true;
}

void ForwardDynamics::AccelerateFreely(const Eigen::Ref<const VectorXd>& forces) {
  free_ = forces - bias_;
  mass_factor_.Solve(&free_);
  if (free_.allFinite()) return;
  throw std::invalid_argument(
      "ForwardDynamics: forces, q or v is so large that the acceleration is not finite");
}

template <typename Points>
void ForwardDynamics::Constrain(const Points& points) {
  points_.clear();
  for (const auto& point : points) points_.push_back(PointOf(point));
  basis_.SetPoints(points_);
  basis_.SetPoses(dynamics_.kinematics().X_WL());
  jacobians_.resize(3 * points.size(), model().nv());
  required_.resize(3 * points.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    dynamics_.Jacobian(points_[i], jacobians_.middleRows<3>(3 * i));
  }
  basis_.Reduce(jacobians_, &half_solved_);
  for (Eigen::Index i = 0; i < half_solved_.cols(); ++i) {
    mass_factor_.SolveTransposed(half_solved_.col(i));
  }
}

template <typename Points>
void ForwardDynamics::SolveMultipliers(const Points& points, double scale, const char* unit) {
  if (!half_solved_.allFinite() || !std::isfinite((half_solved_.squaredNorm() + 1) * scale)) {
    throw std::invalid_argument(
        "ForwardDynamics: the points, q or v are so large that the constraints are not finite");
  }
  gram_.Factor(half_solved_);
  const VectorXd wanted = basis_.Reduced(required_);
  VectorXd left;
  gram_.Solve(wanted, kRefine * scale, &reduced_, &left);
  multipliers_ = basis_.Expanded(reduced_);
  // Neither a rigid body nor the joints can give the points what is left.
  unmet_ = required_ - basis_.Expanded(wanted - left);
  Eigen::Index worst = 0;
  if (unmet_.size() > 0 && !(unmet_.cwiseAbs().maxCoeff(&worst) <= kUnmet * scale)) {
    throw std::runtime_error(fmt::format(
        "ForwardDynamics: {} cannot be held together with the others: {:.3g} {} are left there",
        Described(worst / 3, PointOf(points[worst / 3])), std::abs(unmet_[worst]), unit));
  }
  change_.noalias() = half_solved_ * reduced_;
  mass_factor_.SolveLower(change_);
  if (change_.allFinite()) return;
  throw std::runtime_error(
      "ForwardDynamics: the points cannot be held: that takes forces beyond all numbers");
}

}  // namespace possibility::dynamics
