#include "actions/rollout/rollout_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>
#include <set>
#include <vector>

#include "actions/plan/contact_name.h"
#include "actions/plan/interpolation.h"
#include "dynamics/rollout/robot_rollout.h"
#include "dynamics/tree/multibody_model.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kTouching = 1.1e-3;  // m: a plan's points bear within 1 mm of their ground
constexpr double kEdge = 0.01;        // m: a rigid sole bears on an edge that it overlaps
constexpr double kRest = 1e-3;        // m/s and rad/s
/// Friction is averaged over this many samples, because a sole that comes down sticks to the ground
/// with one corner first, and that strains it for less than a millisecond. Patches with less than
/// this share of the weight may slide: two feet that both stick strain against each other.
constexpr int kFrictionSamples = 4;
constexpr double kFrictionLoad = 0.2;
/// Within 1 ms. Many points that share little load come and go in bursts of tens of events.
constexpr int kZenoEvents = 1000;

/// The knots of a segment as one function of time.
class Track {
 public:
  explicit Track(const Segment& segment) {
    for (const Phase& phase : segment.phases) {
      for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
        starts_.push_back(phase.knots[i].t);
        intervals_.emplace_back(phase.knots[i], phase.knots[i + 1]);
      }
    }
  }

  /// The knot at time `t`, clamped to the track. At the meeting of two phases: the later one's.
  Knot At(double t) const {
    const auto after = std::upper_bound(starts_.begin() + 1, starts_.end(), t);
    return intervals_[after - starts_.begin() - 1].At(t);
  }

 private:
  std::vector<double> starts_;
  std::vector<KnotInterpolant> intervals_;
};

/// Ground levels on which the segment bears.
std::set<int> LevelsUsed(const Segment& segment, const models::RobotModel& robot,
                         const models::GroundMap& ground) {
  std::set<int> levels;
  dynamics::TreeKinematics kinematics(robot);
  for (const Phase& phase : segment.phases) {
    kinematics.SetPosition(phase.knots.front().q);
    for (const BearingPatch& bearing : BearingPatches(robot, phase)) {
      const models::ContactPatch& patch = robot.contacts[bearing.patch];
      for (const int i : bearing.points) {
        const Vector3d p = kinematics.Position(patch.link, patch.points[i]);
        const auto level = ground.LevelAt(p.head<2>(), p.z(), kTouching);
        if (level) levels.insert(*level);
      }
    }
  }
  return levels;
}

/// Every contact point of the robot with every level used, relative to `origin` and turned by
/// `tilt`. The extent of levels matters only if there are several.
std::vector<dynamics::RolloutContact> ContactsOver(const std::set<int>& levels,
                                                   const dynamics::MultibodyModel& model,
                                                   const models::GroundMap& ground,
                                                   const Vector3d& origin, const Matrix3d& tilt) {
  const models::RobotModel& robot = model.tree();
  const auto kinematics = std::make_shared<dynamics::TreeKinematics>(robot);
  std::vector<dynamics::RolloutContact> contacts;
  for (const int level : levels) {
    for (const models::ContactPatch& patch : robot.contacts) {
      for (std::size_t i = 0; i < patch.points.size(); ++i) {
        dynamics::RolloutContact contact;
        contact.name = fmt::format("{} {}", patch.name, i);
        contact.point = {patch.link, patch.points[i], tilt.col(2)};
        contact.offset = ground.levels()[level] - origin.z();
        contact.friction = robot.friction;
        if (levels.size() > 1) {
          contact.lands = [kinematics, &model, &ground, level, origin, tilt,
                           point = contact.point](const VectorXd& q) {
            kinematics->SetPosition(model.TreeConfiguration(q));
            const Vector3d p =
                origin + tilt.transpose() * kinematics->Position(point.link, point.p_L);
            return ground.Clearance(level, p.head<2>()) > -kEdge;
          };
        }
        contacts.push_back(std::move(contact));
      }
    }
  }
  return contacts;
}

/// By contact of ContactsOver: its patch and level.
std::vector<int> PatchesOver(const std::set<int>& levels, const models::RobotModel& robot) {
  std::vector<int> patches;
  int patch = 0;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    for (const models::ContactPatch& contact : robot.contacts) {
      patches.insert(patches.end(), contact.points.size(), patch++);
    }
  }
  return patches;
}

/// Simulates relative to the segment's beginning: far from the origin, the integrator's relative
/// tolerance would be too coarse for the motion.
class Rollout {
 public:
  Rollout(const Segment& segment, const models::RobotModel& robot, const models::GroundMap& ground,
          const RolloutCheckSettings& settings)
      : segment_(segment),
        settings_(settings),
        origin_(segment.phases.front().knots.front().q.segment<3>(4)),
        tilt_(settings.perturbation.Tilt()),
        planned_(dynamics::MultibodyModel::Spatial(robot)),
        model_(dynamics::MultibodyModel::Spatial(settings.perturbation.Perturbed(robot))),
        track_(segment),
        patches_(PatchesOver(LevelsUsed(segment, robot, ground), robot)),
        simulator_(
            model_,
            ContactsOver(LevelsUsed(segment, robot, ground), *model_, ground, origin_, tilt_),
            Control(), SimulatorSettings()) {}

  void Run(RolloutDrift* drift) {
    const Knot& first = segment_.phases.front().knots.front();
    const Knot& last = segment_.phases.back().knots.back();
    drift->ends_at_rest = last.v.lpNorm<Eigen::Infinity>() < kRest;
    const double end = last.t + (drift->ends_at_rest ? settings_.settling_time : 0);
    const dynamics::RobotRollout rollout =
        simulator_.Run(Configuration(first), Velocity(first), first.t, end);
    Compare(rollout, drift);
    if (rollout.time < end) {
      drift->failure = fmt::format("ends at {:.3f} s: {}", rollout.time, rollout.reason);
    }
  }

 private:
  dynamics::JointControl Control() const {
    dynamics::JointControl control;
    control.stiffness = planned_->effort() / settings_.full_effort_error;
    // Joints without a limit would get an infinite gain.
    for (double& k : control.stiffness) k = std::isfinite(k) ? k : 0;
    control.damping = settings_.damping_time * control.stiffness;
    control.command = [this](double t, dynamics::JointCommand* command) {
      const Knot knot = track_.At(t);
      const int n = model_->num_joints();
      command->position = Configuration(knot).tail(n);
      command->velocity = Velocity(knot).tail(n);
      VectorXd forces = VectorXd::Zero(model_->tree().nv());
      forces.tail(knot.tau.size()) = knot.tau;
      command->torque = model_->IndependentForces(forces).tail(n);
    };
    return control;
  }

  dynamics::RobotRolloutSettings SimulatorSettings() const {
    dynamics::RobotRolloutSettings settings;
    settings.touching = kTouching;
    dynamics::OdeSettings& integration = settings.hybrid.integration;
    integration.relative_tolerance = settings_.tolerance;
    integration.absolute_tolerances.resize(model_->nq() + model_->nv());
    integration.absolute_tolerances << VectorXd::Constant(model_->nq(), settings_.tolerance),
        VectorXd::Constant(model_->nv(), settings_.velocity_tolerance);
    integration.cancellation = settings_.cancellation;
    settings.hybrid.end_at_zeno = true;
    settings.hybrid.zeno_events = kZenoEvents;
    const Perturbation& perturbation = settings_.perturbation;
    if (perturbation.push != 0) {
      const double begin = segment_.phases.front().knots.front().t;
      const double stop = segment_.phases.back().knots.back().t;
      settings.push = [&perturbation, begin, stop](double t) {
        return perturbation.PushAt(t, begin, stop);
      };
    }
    return settings;
  }

  bool IsTilted() const {
    return settings_.perturbation.slope != 0 || settings_.perturbation.side_slope != 0;
  }

  /// Configuration of the independent joints, relative to the origin of the simulation.
  VectorXd Configuration(const Knot& knot) const {
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

  VectorXd Velocity(const Knot& knot) const {
    VectorXd v(model_->nv());
    v.head<6>() = knot.v.head<6>();
    if (IsTilted()) {
      v.head<3>() = tilt_ * v.head<3>().eval();
      v.segment<3>(3) = tilt_ * v.segment<3>(3).eval();
    }
    for (int j = 0; j < model_->num_joints(); ++j) v[6 + j] = knot.v[6 + model_->joints()[j]];
    return v;
  }

  void Compare(const dynamics::RobotRollout& rollout, RolloutDrift* drift) {
    const double end = std::min(drift->end, rollout.time);
    const auto samples = static_cast<int>(std::ceil((end - drift->start) / settings_.sample_time));
    for (int i = 0; i <= samples; ++i) {
      CompareAt(std::min(end, drift->start + i * settings_.sample_time), rollout, drift);
    }
    const VectorXd planned = Configuration(segment_.phases.back().knots.back());
    const VectorXd q = rollout.Configuration(rollout.time);
    const VectorXd v = rollout.Velocity(rollout.time);
    drift->end_position = Apart(q, planned);
    drift->end_orientation = Turned(q, planned);
    drift->end_speed = std::max(v.head<3>().norm(), v.segment<3>(3).norm());
    drift->torque_used = rollout.torque_utilisation.maxCoeff();
    if (settings_.measures_friction) MeasureFriction(rollout, drift);
    for (const dynamics::RobotContactEvent& event : rollout.events) {
      drift->impacts += event.energy_lost > 0 ? 1 : 0;
    }
  }

  void MeasureFriction(const dynamics::RobotRollout& rollout, RolloutDrift* drift) {
    const double end = std::min(drift->end, rollout.time);
    const double window = kFrictionSamples * settings_.sample_time;
    for (double begin = drift->start; begin + window <= end; begin += window) {
      Matrix3Xd sum = Matrix3Xd::Zero(3, 1 + *std::max_element(patches_.begin(), patches_.end()));
      for (int i = 0; i < kFrictionSamples; ++i) {
        const dynamics::RobotMotion motion =
            simulator_.MotionAt(rollout, begin + i * settings_.sample_time);
        for (std::size_t k = 0; k < patches_.size(); ++k) {
          sum.col(patches_[k]) += motion.forces.col(static_cast<Eigen::Index>(k));
        }
      }
      RecordFriction(begin, sum / kFrictionSamples, drift);
    }
  }

  /// `forces`: mean over a window, by patch.
  void RecordFriction(double t, const Matrix3Xd& forces, RolloutDrift* drift) const {
    const models::RobotModel& robot = model_->tree();
    const double least = kFrictionLoad * robot.TotalMass() * dynamics::kGravity;
    for (const Vector3d force : forces.colwise()) {
      const double load = tilt_.col(2).dot(force);
      if (load < least) continue;
      const double used = (force - load * tilt_.col(2)).norm() / (robot.friction * load);
      if (used > 1 && !drift->slipped_at) drift->slipped_at = t;
      drift->friction_used = std::max(drift->friction_used, used);
    }
  }

  void CompareAt(double t, const dynamics::RobotRollout& rollout, RolloutDrift* drift) const {
    const VectorXd planned = Configuration(track_.At(t));
    const VectorXd q = rollout.Configuration(t);
    const double turned = Turned(q, planned);
    drift->worst_position = std::max(drift->worst_position, Apart(q, planned));
    drift->worst_orientation = std::max(drift->worst_orientation, turned);
    const double joint = (q - planned).tail(model_->num_joints()).lpNorm<Eigen::Infinity>();
    drift->worst_joint = std::max(drift->worst_joint, joint);
    const double sunk = std::abs(tilt_.col(2).dot((q - planned).segment<3>(4)));
    if (!drift->fell_at && (turned > kFallOrientation || sunk > kFallHeight)) drift->fell_at = t;
  }

  static double Apart(const VectorXd& q, const VectorXd& planned) {
    return (q - planned).segment<3>(4).norm();
  }

  static double Turned(const VectorXd& q, const VectorXd& planned) {
    return Quaterniond(q[0], q[1], q[2], q[3])
        .angularDistance(Quaterniond(planned[0], planned[1], planned[2], planned[3]));
  }

  const Segment& segment_;
  const RolloutCheckSettings& settings_;
  Vector3d origin_;  ///< m
  Matrix3d tilt_;    ///< of the ground
  std::shared_ptr<const dynamics::MultibodyModel> planned_;
  std::shared_ptr<const dynamics::MultibodyModel> model_;  ///< perturbed
  Track track_;
  std::vector<int> patches_;  ///< by contact
  dynamics::RobotSimulator simulator_;
};

}  // namespace

bool RolloutDrift::follows() const {
  return failure.empty() && end_position <= kRolloutPosition &&
         end_orientation <= kRolloutOrientation && (!ends_at_rest || end_speed <= kRolloutSpeed);
}

RolloutDrift RollOutSegment(const Segment& segment, const models::RobotModel& robot,
                            const models::GroundMap& ground, const RolloutCheckSettings& settings) {
  RolloutDrift drift;
  drift.start = segment.phases.front().knots.front().t;
  drift.end = segment.phases.back().knots.back().t;
  try {
    Rollout(segment, robot, ground, settings).Run(&drift);
  } catch (const std::exception& error) {
    drift.failure = error.what();
  }
  return drift;
}

}  // namespace possibility::actions
