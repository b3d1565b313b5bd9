#include "actions/spatial/spatial_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "dynamics/tree/floating_motion.h"

namespace possibility::actions {
namespace {

using collocation::PhaseTrajectory;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using models::ContactSchedule;

/// Rows and columns of q, v and a that belong to the root's place.
constexpr int kPosition = 4;
constexpr int kVelocity = 3;

const models::GaitLimb& LimbOf(const models::RobotModel& robot, const models::Gait& gait,
                               const std::string& contact) {
  for (const models::GaitLimb& limb : gait.limbs) {
    if (robot.contacts[limb.contact].name == contact) return limb;
  }
  throw std::invalid_argument(
      fmt::format("spatial motion: gait '{}' has no limb for contact '{}'", gait.name, contact));
}

/// Converts a signal of the remaining time into a signal of time.
Signal<VectorXd> Reversed(const Signal<VectorXd>& signal) {
  return {signal.value, -signal.rate, signal.acceleration};
}

/// The distance of the joints of limbs in place from the plan, where an interval begins or ends.
struct Offset {
  VectorXd value, rate;
};

class Tracker {
 public:
  Tracker(const models::RobotModel& robot, const models::Gait& gait,
          const ContactSchedule& schedule, collocation::RobotSystem model,
          const collocation::Trajectory& trajectory)
      : robot_(robot),
        schedule_(schedule),
        model_(std::move(model)),
        trajectory_(trajectory),
        solver_(robot) {
    if (trajectory.phases.size() != schedule.intervals.size()) {
      throw std::invalid_argument(fmt::format("spatial motion: {} phases for {} intervals",
                                              trajectory.phases.size(), schedule.intervals.size()));
    }
    for (const std::string& contact : schedule.contacts) {
      limbs_.push_back(&LimbOf(robot, gait, contact));
    }
  }

  std::vector<MotionPhase> Phases() {
    std::vector<MotionPhase> phases;
    for (std::size_t k = 0; k < schedule_.intervals.size(); ++k) {
      phases.push_back(PhaseOf(static_cast<int>(k)));
    }
    return phases;
  }

 private:
  int num_intervals() const { return static_cast<int>(schedule_.intervals.size()); }

  static dynamics::FloatingMotion Planned(const dynamics::MultibodyModel& model,
                                          const PhaseTrajectory& plan, double share) {
    const double s = std::clamp(share, 0.0, 1.0);
    return dynamics::ToFloating(model, plan.Coordinates(s, 0), plan.Coordinates(s, 1),
                                plan.Coordinates(s, 2));
  }

  /// As planned, without limbs.
  static WholeBodyTask TaskOf(const dynamics::FloatingMotion& motion) {
    const Eigen::Index n = motion.q.size() - 7;
    WholeBodyTask task;
    LinkTurn& turn = task.root_turn.emplace();
    turn.orientation =
        Eigen::Quaterniond(motion.q[0], motion.q[1], motion.q[2], motion.q[3]).matrix();
    turn.angular_velocity = motion.v.head<3>();
    turn.angular_acceleration = motion.a.head<3>();
    task.root_position = {Vector2d(motion.q.segment<2>(kPosition)),
                          Vector2d(motion.v.segment<2>(kVelocity)),
                          Vector2d(motion.a.segment<2>(kVelocity))};
    task.root_height = {motion.q[kPosition + 2], motion.v[kVelocity + 2], motion.a[kVelocity + 2]};
    task.joints = {motion.q.tail(n), motion.v.tail(n), motion.a.tail(n)};
    return task;
  }

  LimbTask InPlace(int interval, int contact) const {
    const models::ContactPatch& patch = robot_.contacts[limbs_[contact]->contact];
    const Eigen::Isometry3d& X_WF = *schedule_.intervals[interval].bearing[contact];
    LimbTask task;
    task.limb = limbs_[contact];
    task.position = ConstantVector<Vector3d>(X_WF.translation());
    task.yaw = Constant(0);
    task.orientation = X_WF.linear() * patch.Frame().linear().transpose();
    return task;
  }

  /// Tasks of the limbs that bear in either of two intervals; -1: none.
  std::vector<LimbTask> InPlace(std::array<int, 2> intervals) const {
    std::vector<LimbTask> tasks;
    for (std::size_t contact = 0; contact < limbs_.size(); ++contact) {
      for (const int k : intervals) {
        if (k < 0 || k >= num_intervals() || !schedule_.intervals[k].bearing[contact]) continue;
        tasks.push_back(InPlace(k, static_cast<int>(contact)));
        break;
      }
    }
    return tasks;
  }

  /// At the start or the end of interval `k`, if the limbs of its neighbour there are in place too.
  Offset OffsetAt(int k, bool at_end) {
    const dynamics::FloatingMotion planned =
        Planned(*model_, trajectory_.phases[k], at_end ? 1 : 0);
    WholeBodyTask task = TaskOf(planned);
    task.limbs = InPlace({k, at_end ? k + 1 : k - 1});
    const WholeBodyState placed = solver_.Solve(task, planned.q);
    const Eigen::Index n = robot_.num_joints();
    return {placed.q.tail(n) - planned.q.tail(n), placed.v.tail(n) - planned.v.tail(n)};
  }

  MotionPhase PhaseOf(int k) {
    const PhaseTrajectory& plan = trajectory_.phases[k];
    MotionPhase phase;
    phase.duration = plan.duration;
    for (std::size_t contact = 0; contact < limbs_.size(); ++contact) {
      if (!schedule_.intervals[k].bearing[contact]) continue;
      phase.contacts.push_back(limbs_[contact]->contact);
      if (k > 0 && !schedule_.intervals[k - 1].bearing[contact]) {
        phase.coming_down.push_back(limbs_[contact]->contact);
      }
    }
    phase.task = [&plan, model = model_, start = OffsetAt(k, false), end = OffsetAt(k, true),
                  limbs = InPlace({k, -1})](double t) {
      const double duration = plan.duration;
      WholeBodyTask task = TaskOf(Planned(*model, plan, t / duration));
      task.joints = task.joints + DyingOut<VectorXd>(start.value, start.rate, t, duration) +
                    Reversed(DyingOut<VectorXd>(end.value, -end.rate, duration - t, duration));
      task.limbs = limbs;
      return task;
    };
    return phase;
  }

  const models::RobotModel& robot_;
  const ContactSchedule& schedule_;
  collocation::RobotSystem model_;
  const collocation::Trajectory& trajectory_;
  WholeBodySolver solver_;
  std::vector<const models::GaitLimb*> limbs_;  ///< by contact of the schedule
};

}  // namespace

std::vector<MotionPhase> SpatialMotion(const models::RobotModel& robot, const models::Gait& gait,
                                       const models::ContactSchedule& schedule,
                                       const collocation::RobotSystem& model,
                                       const collocation::Trajectory& trajectory) {
  return Tracker(robot, gait, schedule, model, trajectory).Phases();
}

}  // namespace possibility::actions
