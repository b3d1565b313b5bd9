#include "actions/verify/plan_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/verify/zero_moment_point.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/world/collision.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr double kSameHeight = 1e-3;  // m, as the verifier tolerates
constexpr double kLightLoad = 1e-3;   // of the weight: friction of lighter points is not measured

void KeepLeast(const Margin& later, Margin* margin) {
  if (later.segment >= 0 && (margin->segment < 0 || later.value < margin->value)) *margin = later;
}

void KeepGreatest(const Margin& later, Margin* margin) {
  if (later.segment >= 0 && (margin->segment < 0 || later.value > margin->value)) *margin = later;
}

}  // namespace

void PlanMargins::Add(const PlanMargins& later) {
  KeepLeast(later.zmp, &zmp);
  KeepLeast(later.ground_edge, &ground_edge);
  KeepGreatest(later.torque, &torque);
  KeepGreatest(later.friction, &friction);
  KeepGreatest(later.joint_speed, &joint_speed);
  KeepLeast(later.self_distance, &self_distance);
  KeepLeast(later.obstacle_distance, &obstacle_distance);
}

/// Measures knots, and keeps the worst of each kind.
class MarginMeasurement {
 public:
  MarginMeasurement(const models::RobotModel& robot, const models::Environment& environment,
                    const models::GroundMap& ground)
      : robot_(robot),
        environment_(environment),
        ground_(ground),
        checker_(robot, environment),
        kinematics_(robot),
        weight_(robot.TotalMass() * dynamics::kGravity) {}

  void Enter(int segment, const Phase& phase) {
    segment_ = segment;
    points_ = BearingPoints(robot_, phase);
  }

  void Measure(const Knot& knot) {
    time_ = knot.t;
    kinematics_.SetPosition(knot.q);
    MeasureJoints(knot);
    MeasureContacts(knot);
    MeasureDistances();
  }

  const PlanMargins& margins() const { return margins_; }
  /// Forgets what was measured.
  void Clear() { margins_ = {}; }

 private:
  void Least(double value, Margin* margin) const {
    if (std::isnan(value) || (margin->segment >= 0 && value >= margin->value)) return;
    *margin = {value, segment_, time_};
  }
  void Greatest(double value, Margin* margin) const {
    if (!std::isfinite(value) || (margin->segment >= 0 && value <= margin->value)) return;
    *margin = {value, segment_, time_};
  }

  void MeasureJoints(const Knot& knot) {
    for (int j = 0; j < robot_.num_joints(); ++j) {
      const models::Joint& joint = robot_.joints[j];
      Greatest(std::abs(knot.v[6 + j]) / joint.velocity, &margins_.joint_speed);
      if (joint.mimic) continue;
      const double limit = joint.actuator.Limit(joint.effort, knot.tau[j], knot.v[6 + j]);
      Greatest(std::abs(knot.tau[j]) / limit, &margins_.torque);
    }
  }

  void MeasureContacts(const Knot& knot) {
    Eigen::Matrix3Xd places(3, points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector3d p = kinematics_.Position(points_[i].link, points_[i].p_L);
      const Vector3d force = knot.forces.col(i);
      places.col(i) = p;
      const std::vector<int> planes =
          ground_.PlanesAt(p.head<2>(), p.z() - kSameHeight, p.z() + kSameHeight);
      MeasureFriction(force, planes);
      if (planes.empty()) continue;
      double edge = -std::numeric_limits<double>::infinity();
      for (const int plane : planes) edge = std::max(edge, ground_.Clearance(plane, p.head<2>()));
      Least(edge, &margins_.ground_edge);
    }
    if (const auto zmp = ZeroMomentPoint(places, knot.forces, kLightLoad * weight_)) {
      Least(SupportMargin(places, zmp->head<2>()), &margins_.zmp);
    }
  }

  /// On the most favourable of the planes; level without any.
  void MeasureFriction(const Vector3d& force, const std::vector<int>& planes) {
    double least = std::numeric_limits<double>::infinity();
    const auto measure = [&](const Vector3d& normal, double friction) {
      const double load = normal.dot(force);
      if (load <= kLightLoad * weight_) return;
      least = std::min(
          least, (force - load * normal).norm() / (std::min(robot_.friction, friction) * load));
    };
    for (const int plane : planes) {
      measure(ground_.planes()[plane].normal, ground_.planes()[plane].friction);
    }
    if (planes.empty()) measure(Vector3d::UnitZ(), robot_.friction);
    Greatest(least, &margins_.friction);
  }

  void MeasureDistances() {
    const auto& X_WL = kinematics_.X_WL();
    double own = PlanMargins::kFarthest;
    for (const models::Proximity& pair : checker_.SelfProximities(X_WL, own)) {
      own = std::min(own, pair.distance);
    }
    Least(own, &margins_.self_distance);
    double other = PlanMargins::kFarthest;
    for (const models::Proximity& pair : checker_.EnvironmentProximities(X_WL, other)) {
      if (!environment_.obstacles[pair.other].is_ground) other = std::min(other, pair.distance);
    }
    Least(other, &margins_.obstacle_distance);
  }

  const models::RobotModel& robot_;
  const models::Environment& environment_;
  const models::GroundMap& ground_;
  models::CollisionChecker checker_;
  dynamics::TreeKinematics kinematics_;
  double weight_;  ///< N
  PlanMargins margins_;
  std::vector<BearingPoint> points_;
  int segment_ = 0;
  double time_ = 0;
};

InstantMargins::InstantMargins(const models::RobotModel& robot,
                               const models::Environment& environment,
                               const models::GroundMap& ground)
    : measurement_(std::make_unique<MarginMeasurement>(robot, environment, ground)) {}

InstantMargins::~InstantMargins() = default;

PlanMargins InstantMargins::At(int segment, const Phase& phase, const Knot& knot) {
  measurement_->Clear();
  measurement_->Enter(segment, phase);
  measurement_->Measure(knot);
  return measurement_->margins();
}

PhaseMeasurement::PhaseMeasurement(const models::RobotModel& robot,
                                   const models::Environment& environment,
                                   const models::GroundMap& ground)
    : measurement_(std::make_unique<MarginMeasurement>(robot, environment, ground)) {}

PhaseMeasurement::~PhaseMeasurement() = default;

PlanMargins PhaseMeasurement::Of(const Phase& phase) {
  measurement_->Clear();
  measurement_->Enter(0, phase);
  for (const Knot& knot : phase.knots) measurement_->Measure(knot);
  return measurement_->margins();
}

PlanMargins MeasureMargins(const Plan& plan, const models::RobotModel& robot,
                           const models::Environment& environment,
                           const models::GroundMap& ground) {
  MarginMeasurement measurement(robot, environment, ground);
  for (std::size_t segment = 0; segment < plan.segments.size(); ++segment) {
    for (const Phase& phase : plan.segments[segment].phases) {
      measurement.Enter(static_cast<int>(segment), phase);
      for (const Knot& knot : phase.knots) measurement.Measure(knot);
    }
  }
  return measurement.margins();
}

}  // namespace possibility::actions
