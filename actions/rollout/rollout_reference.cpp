#include "actions/rollout/rollout_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "actions/plan/contact_name.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A rigid sole bears on an edge that it overlaps: so far may one of its points be beyond it, m, if
/// the sole reaches back across it within twice as much.
constexpr double kEdge = 0.01;
constexpr double kRest = 1e-3;  // m/s and rad/s

std::set<int> PlanesUsed(const Segment& segment, const models::RobotModel& robot,
                         const models::GroundMap& ground) {
  std::set<int> planes;
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : segment.phases) {
    kinematics.SetPosition(phase.knots.front().q);
    for (const BearingPatch& bearing : BearingPatches(robot, phase)) {
      const models::ContactPatch& patch = robot.contacts[bearing.patch];
      for (const int i : bearing.points) {
        const Vector3d p = kinematics.Position(patch.link, patch.points[i]);
        const std::vector<int> here =
            ground.PlanesAt(p.head<2>(), p.z() - kTouching, p.z() + kTouching);
        const auto highest = std::max_element(here.begin(), here.end(), [&](int a, int b) {
          return ground.planes()[a].HeightAt(p.head<2>()) <
                 ground.planes()[b].HeightAt(p.head<2>());
        });
        if (highest != here.end()) planes.insert(*highest);
      }
    }
  }
  return planes;
}

/// The point, moved into its patch.
Vector3d Inside(const models::ContactPatch& patch, std::size_t point) {
  const Vector3d inwards = patch.Centre() - patch.points[point];
  const double length = inwards.norm();
  return length > 2 * kEdge ? Vector3d(patch.points[point] + 2 * kEdge / length * inwards)
                            : patch.Centre();
}

/// The robot's tree at the configuration that was asked for last: a simulation asks for all
/// contacts at one configuration.
class LastPose {
 public:
  explicit LastPose(const dynamics::MultibodyModel& model)
      : model_(model), kinematics_(model.tree()) {}

  const dynamics::TreeKinematics& At(const VectorXd& q) {
    if (q_.size() != q.size() || q_ != q) {
      q_ = q;
      kinematics_.SetPosition(model_.TreeConfiguration(q));
    }
    return kinematics_;
  }

 private:
  const dynamics::MultibodyModel& model_;
  dynamics::TreeKinematics kinematics_;
  VectorXd q_;
};

double Turned(const Eigen::Ref<const VectorXd>& q, const VectorXd& planned) {
  return Quaterniond(q[0], q[1], q[2], q[3])
      .normalized()
      .angularDistance(Quaterniond(planned[0], planned[1], planned[2], planned[3]));
}

}  // namespace

RolloutReference::Track::Track(const Segment& segment) {
  for (const Phase& phase : segment.phases) {
    for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
      starts_.push_back(phase.knots[i].t);
      intervals_.emplace_back(phase.knots[i], phase.knots[i + 1]);
    }
  }
}

const KnotInterpolant& RolloutReference::Track::Around(double t) const {
  const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), t);
  return intervals_[after - starts_.begin() - 1];
}

RolloutReference::RolloutReference(const Segment& segment, const models::RobotModel& robot,
                                   const models::GroundMap& ground,
                                   const Perturbation& perturbation, const RolloutGains& gains)
    : segment_(segment),
      ground_(ground),
      perturbation_(perturbation),
      stiffness_(JointStiffness(robot, gains)),
      damping_time_(gains.damping_time),
      origin_(segment.phases.front().knots.front().q.segment<3>(4)),
      tilt_(perturbation.Tilt()),
      model_(dynamics::MultibodyModel::Spatial(perturbation.Perturbed(robot))),
      track_(segment),
      planes_(PlanesUsed(segment, robot, ground)) {}

bool RolloutReference::ends_at_rest() const {
  return segment_.phases.back().knots.back().v.lpNorm<Eigen::Infinity>() < kRest;
}

VectorXd RolloutReference::Configuration(double t) const { return Configuration(track_.At(t)); }
VectorXd RolloutReference::Velocity(double t) const { return Velocity(track_.At(t)); }

bool RolloutReference::IsTilted() const {
  return perturbation_.slope != 0 || perturbation_.side_slope != 0;
}

VectorXd RolloutReference::Configuration(const Knot& knot) const {
  VectorXd q(model_->nq());
  q.head<7>() = knot.q.head<7>();
  q.segment<3>(4) -= origin_;
  if (IsTilted()) {
    q.segment<3>(4) = tilt_ * q.segment<3>(4).eval();
    const Quaterniond turned = Quaterniond(tilt_) * Quaterniond(q[0], q[1], q[2], q[3]);
    q.head<4>() << turned.w(), turned.x(), turned.y(), turned.z();
  }
  for (int j = 0; j < model_->num_joints(); ++j) q[7 + j] = knot.q[7 + model_->joints()[j]];
  return q;
}

VectorXd RolloutReference::Velocity(const Knot& knot) const {
  VectorXd v(model_->nv());
  v.head<6>() = knot.v.head<6>();
  if (IsTilted()) {
    v.head<3>() = tilt_ * v.head<3>().eval();
    v.segment<3>(3) = tilt_ * v.segment<3>(3).eval();
  }
  for (int j = 0; j < model_->num_joints(); ++j) v[6 + j] = knot.v[6 + model_->joints()[j]];
  return v;
}

std::vector<dynamics::RolloutContact> RolloutReference::Contacts() const {
  const models::RobotModel& robot = model_->tree();
  const auto pose = std::make_shared<LastPose>(*model_);
  std::vector<dynamics::RolloutContact> contacts;
  for (const int index : planes_) {
    const models::GroundPlane& plane = ground_.planes()[index];
    for (const models::ContactPatch& patch : robot.contacts) {
      for (std::size_t i = 0; i < patch.points.size(); ++i) {
        dynamics::RolloutContact contact;
        contact.name = fmt::format("{} {}", patch.name, i);
        contact.point = {patch.link, patch.points[i], tilt_ * plane.normal};
        contact.offset = plane.offset - plane.normal.dot(origin_);
        contact.friction = std::min(robot.friction, plane.friction);
        if (planes_.size() > 1) {
          contact.lands = [this, pose, index, point = contact.point,
                           inside = Inside(patch, i)](const VectorXd& q) {
            const dynamics::TreeKinematics& kinematics = pose->At(q);
            const auto clearance = [&](const Vector3d& p_L) {
              const Vector3d p = origin_ + tilt_.transpose() * kinematics.Position(point.link, p_L);
              return ground_.Clearance(index, p.head<2>());
            };
            const double here = clearance(point.p_L);
            return here >= 0 || (here > -kEdge && clearance(inside) >= 0);
          };
        }
        contacts.push_back(std::move(contact));
      }
    }
  }
  return contacts;
}

VectorXd RolloutReference::TreeConfiguration(double t) const {
  return model_->TreeConfiguration(Configuration(t));
}

RootTilt RolloutReference::Tilt(double t, const VectorXd& q, const VectorXd& v) const {
  const VectorXd planned = Configuration(t);
  const Quaterniond now = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  const Quaterniond then = Quaterniond(planned[0], planned[1], planned[2], planned[3]).normalized();
  return {models::RotationVector(Quaterniond(now * then.conjugate())),
          v.head<3>() - Velocity(t).head<3>()};
}

dynamics::JointControl RolloutReference::Control(const StepFeedback* steps) const {
  dynamics::JointControl control;
  control.stiffness = stiffness_(model_->joints());
  control.damping = damping_time_ * control.stiffness;
  control.command = [this, steps, planned = dynamics::JointCommand()](
                        double t, dynamics::JointCommand* command) mutable {
    track_.Around(t).JointsAt(t, &planned.position, &planned.velocity, &planned.torque);
    if (steps && steps->IsCorrecting()) {
      const auto correction = steps->CorrectionAt(t, TreeConfiguration(t));
      planned.position += correction->position;
      planned.velocity += correction->velocity;
    }
    command->position = planned.position(model_->joints());
    command->velocity = planned.velocity(model_->joints());
    VectorXd forces = VectorXd::Zero(model_->tree().nv());
    forces.tail(planned.torque.size()) = planned.torque;
    command->torque = model_->IndependentForces(forces).tail(model_->num_joints());
  };
  return control;
}

dynamics::RootPush RolloutReference::Push() const {
  if (perturbation_.push == 0) return {};
  return [this](double t) { return perturbation_.PushAt(t, start(), end()); };
}

void RolloutReference::Compare(double t, const VectorXd& q, RolloutDrift* drift) const {
  const VectorXd planned = Configuration(t);
  const double turned = Turned(q, planned);
  drift->worst_position = std::max(drift->worst_position, (q - planned).segment<3>(4).norm());
  drift->worst_orientation = std::max(drift->worst_orientation, turned);
  const double joint = (q - planned).tail(model_->num_joints()).lpNorm<Eigen::Infinity>();
  drift->worst_joint = std::max(drift->worst_joint, joint);
  if (!drift->fell_at && Uprightness(t, q) < 0) drift->fell_at = t;
}

void RolloutReference::CompareEnd(const VectorXd& q, const VectorXd& v, RolloutDrift* drift) const {
  const VectorXd planned = Configuration(end());
  drift->end_position = (q - planned).segment<3>(4).norm();
  drift->end_orientation = Turned(q, planned);
  drift->end_speed = std::max(v.head<3>().norm(), v.segment<3>(3).norm());
}

double RolloutReference::Uprightness(double t, const Eigen::Ref<const VectorXd>& q) const {
  const VectorXd planned = Configuration(t);
  const double sunk = std::abs(normal().dot((q - planned).segment<3>(4)));
  return 1 - std::max(Turned(q, planned) / kFallOrientation, sunk / kFallHeight);
}

}  // namespace possibility::actions
