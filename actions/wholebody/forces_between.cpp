#include "actions/wholebody/forces_between.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "actions/plan/force_change.h"
#include "actions/plan/interpolation.h"
#include "models/robot/mimic_joints.h"

namespace possibility::actions {
namespace {

using dynamics::ContactPoint;

constexpr int kPieces = 4;               // of an interval: the verifier's samples are 5 ms apart
constexpr double kConeTolerance = 5e-7;  // of the weight, half of the verifier's
constexpr double kOfTorque = 1 + 1e-9;

/// Forces that change by less, as a share of each point's load, have room in the margins that the
/// knots keep. Here both the even and the odd part of the quintic's acceleration have more than
/// four fifths of what they have anywhere, and they cancel in one place at most.
constexpr double kLittle = 0.04;
constexpr double kProbes[] = {0.3, 0.7};  // of the interval

/// A state between two knots, and what its interpolated forces leave.
class StateBetween {
 public:
  /// Sets the state of `dynamics`, which must outlive it.
  StateBetween(const Knot& knot, const std::vector<ContactPoint>& points,
               dynamics::MultibodyDynamics* dynamics)
      : knot_(knot), points_(points), dynamics_(dynamics), arms_(3, points.size()) {
    dynamics->SetState(knot.q, knot.v, knot.a);
    for (std::size_t i = 0; i < points.size(); ++i) {
      arms_.col(static_cast<Eigen::Index>(i)) =
          dynamics->Position(points[i]) - knot.q.segment<3>(4);
    }
    missing_ = dynamics->InverseDynamics().head<6>() - WrenchOf(arms_, knot.forces);
  }

  /// Those of the format.
  Eigen::Matrix3Xd Forces(double weight) const {
    if (points_.empty()) return knot_.forces;
    return knot_.forces + LeastForceChange(arms_, knot_.forces, weight, missing_);
  }

  /// That go with these forces.
  Eigen::VectorXd Torques(const Eigen::Matrix3Xd& forces) const {
    Eigen::VectorXd required = dynamics_->InverseDynamics();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      dynamics_->AddPointForce(points_[i], -forces.col(static_cast<Eigen::Index>(i)), required);
    }
    return required.tail(required.size() - 6);
  }

 private:
  const Knot& knot_;
  const std::vector<ContactPoint>& points_;
  dynamics::MultibodyDynamics* dynamics_;
  Eigen::Matrix3Xd arms_;
  Eigen::Matrix<double, 6, 1> missing_;
};

/// By how much a force pulls at its ground or exceeds its friction, N.
double OutsideCone(const ContactPoint& point, const Eigen::Vector3d& force, double friction) {
  const double load = point.normal_W.dot(force);
  const double tangential = (force - load * point.normal_W).norm();
  return std::max(-load, tangential - std::min(friction, point.friction) * std::max(load, 0.0));
}

/// Whether forces are much different from the interpolated ones of the knot.
bool Strays(const Knot& knot, const Eigen::Matrix3Xd& forces,
            const std::vector<ContactPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double load = points[i].normal_W.dot(knot.forces.col(column));
    if ((forces - knot.forces).col(column).norm() > kLittle * load) return true;
  }
  return false;
}

std::optional<MotionError> FaultAt(const models::RobotModel& robot,
                                   const std::vector<ContactPoint>& points, const Knot& knot,
                                   double t, dynamics::MultibodyDynamics* dynamics) {
  const double weight = robot.TotalMass() * dynamics::kGravity;
  const StateBetween state(knot, points, dynamics);
  const Eigen::Matrix3Xd forces = state.Forces(weight);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double outside =
        OutsideCone(points[i], forces.col(static_cast<Eigen::Index>(i)), robot.friction);
    if (outside <= kConeTolerance * weight) continue;
    return MotionError(fmt::format("a contact force leaves its friction cone by {:.2f} N at "
                                   "{:.3f} s, between knots",
                                   outside, t),
                       -1, MotionError::Limit::kFriction);
  }
  const Eigen::VectorXd borne = models::MotorTorques(robot, state.Torques(forces));
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const double limit = joint.actuator.Limit(joint.effort, borne[j], knot.v[6 + j]);
    if (joint.mimic || std::abs(borne[j]) <= kOfTorque * limit) continue;
    return MotionError(fmt::format("{} needs {:.1f} of {:.1f} N m at {:.3f} s, between knots",
                                   joint.name, std::abs(borne[j]), limit, t),
                       -1, MotionError::Limit::kTorque);
  }
  return std::nullopt;
}

}  // namespace

std::optional<MotionError> ForceFaultBetween(const models::RobotModel& robot,
                                             const std::vector<ContactPoint>& points,
                                             const Knot& from, const Knot& to, double t,
                                             dynamics::MultibodyDynamics* dynamics) {
  const double weight = robot.TotalMass() * dynamics::kGravity;
  const KnotInterpolant motion(from, to);
  const auto strays_at = [&](double share) {
    const Knot knot = motion.At(from.t + share * motion.duration());
    return Strays(knot, StateBetween(knot, points, dynamics).Forces(weight), points);
  };
  if (!points.empty() && std::none_of(std::begin(kProbes), std::end(kProbes), strays_at)) {
    return std::nullopt;
  }
  for (int piece = 1; piece < kPieces; ++piece) {
    const double passed = motion.duration() * piece / kPieces;
    auto fault = FaultAt(robot, points, motion.At(from.t + passed), t + passed, dynamics);
    if (fault) return fault;
  }
  return std::nullopt;
}

}  // namespace possibility::actions
