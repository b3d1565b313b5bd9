#include "actions/conditions/locomotion_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "actions/gait/dynamic_gait.h"
#include "actions/gait/pace_library.h"
#include "actions/gait/quasi_static_gait.h"
#include "actions/transition/transition_motion.h"
#include "actions/transition/transition_volume.h"
#include "actions/wholebody/motion_builder.h"
#include "models/input/input_error.h"
#include "models/world/scenario.h"

namespace possibility::actions {
namespace {

bool IsJump(const models::RobotModel& robot, const std::string& action) {
  return std::any_of(robot.jumps.begin(), robot.jumps.end(),
                     [&](const models::Jump& jump) { return jump.name == action; });
}

/// Duration of a change between gaits of one stance, s.
constexpr double kChangeTime = 0.2;

using GaitEntry = LocomotionModel::GaitEntry;
using TransitionEntry = LocomotionModel::TransitionEntry;

std::unique_ptr<GaitEntry> EntryOfRobot(const models::RobotModel& robot, const std::string& name,
                                        const PaceLibrary& paces) {
  auto entry = std::make_unique<GaitEntry>();
  entry->gait = robot.GaitNamed(name);
  entry->stance = SolveNominalStance(robot, entry->gait);
  std::optional<std::vector<Pace>> fitted = paces.Find(entry->gait);
  entry->motion = fitted ? std::make_unique<DynamicGait>(robot, entry->stance, std::move(*fitted))
                         : std::make_unique<DynamicGait>(robot, entry->stance);
  return entry;
}

std::unique_ptr<GaitEntry> EntryOfFactory(const models::RobotModel& robot,
                                          const GaitFactory& factory) {
  const auto found =
      std::find_if(robot.gaits.begin(), robot.gaits.end(),
                   [&](const models::Gait& gait) { return gait.name == factory.stance_of; });
  if (found == robot.gaits.end()) {
    throw InputError(
        fmt::format("{}: gait '{}' has the stance of '{}', expected a gait of robot '{}'",
                    robot.file.string(), factory.name, factory.stance_of, robot.name));
  }
  auto entry = std::make_unique<GaitEntry>();
  entry->gait = *found;
  entry->gait.name = factory.name;
  entry->gait.parameters = factory.parameters;
  entry->stance = SolveNominalStance(robot, entry->gait);
  entry->motion = factory.make ? factory.make(robot, entry->stance) : nullptr;
  if (!entry->motion) {
    throw InputError(fmt::format("{}: the factory of gait '{}' {}, expected a motion",
                                 robot.file.string(), factory.name,
                                 factory.make ? "made nothing" : "is empty"));
  }
  return entry;
}

std::unique_ptr<GaitEntry> MakeEntry(const models::RobotModel& robot, const std::string& name,
                                     const PaceLibrary& paces,
                                     const std::vector<GaitFactory>& further) {
  for (const GaitFactory& factory : further) {
    if (factory.name == name) return EntryOfFactory(robot, factory);
  }
  return EntryOfRobot(robot, name, paces);
}

/// The robot stands still while it changes between gaits of one stance.
TransitionEntry Change(const models::RobotModel& robot, const LocomotionModel& model, int from,
                       int to) {
  const GaitEntry& gait = *model.gaits[from];
  TransitionEntry entry;
  entry.from = from;
  entry.to = to;
  entry.phases = MotionBuilder(robot).Build(
      {QuasiStaticGait(robot, gait.stance).Standing(PlanarPose(), 0, kChangeTime)}, gait.stance.q);
  entry.sweep = gait.volumes.standing;
  entry.rest_time = gait.motion->RestTime() + model.gaits[to]->motion->RestTime();
  return entry;
}

/// The gait of the robot's file whose stance `name` has.
std::string StanceOf(const std::string& name, const std::vector<GaitFactory>& further) {
  for (const GaitFactory& factory : further) {
    if (factory.name == name) return factory.stance_of;
  }
  return name;
}

/// Regions of contact patches; gaits share limbs.
class KnownRegions {
 public:
  explicit KnownRegions(const models::RobotModel& robot) : robot_(robot) {}
  const ReachableRegion& Of(int contact) {
    const auto known = regions_.find(contact);
    if (known != regions_.end()) return known->second;
    return regions_.emplace(contact, ReachableRegion(robot_, robot_.contacts[contact]))
        .first->second;
  }

 private:
  const models::RobotModel& robot_;
  std::map<int, ReachableRegion> regions_;
};

}  // namespace

int LocomotionModel::GaitIndex(const std::string& name) const {
  for (size_t i = 0; i < gaits.size(); ++i) {
    if (gaits[i]->stance.gait->name == name) return static_cast<int>(i);
  }
  return -1;
}

LocomotionModel BuildLocomotionModel(const models::RobotModel& robot,
                                     const std::vector<std::string>& actions,
                                     const CancellationToken& cancellation,
                                     const std::filesystem::path& library,
                                     const std::vector<GaitFactory>& further, int threads) {
  std::vector<std::string> names;
  for (const GaitFactory& factory : further) names.push_back(factory.name);
  models::CheckActionsOfRobot(actions, robot, robot.file.string(), names);
  const PaceLibrary paces(robot, library);
  LocomotionModel model;
  model.robot = &robot;
  KnownRegions regions(robot);
  for (const std::string& action : actions) {
    if (IsJump(robot, action)) continue;
    std::unique_ptr<GaitEntry> entry = MakeEntry(robot, action, paces, further);
    entry->volumes = SweepGait(robot, entry->stance, *entry->motion, cancellation, threads);
    for (const models::GaitLimb& limb : entry->stance.gait->limbs) {
      entry->regions.push_back(regions.Of(limb.contact));
    }
    model.gaits.push_back(std::move(entry));
  }
  for (const models::Transition& transition : robot.transitions) {
    TransitionEntry entry;
    entry.from = model.GaitIndex(transition.from);
    entry.to = model.GaitIndex(transition.to);
    if (entry.from < 0 || entry.to < 0) continue;
    const TransitionMotion motion(robot, model.gaits[entry.from]->stance,
                                  model.gaits[entry.to]->stance, library, cancellation);
    entry.displacement = motion.displacement();
    entry.phases = motion.phases();
    entry.sweep = SweepTransition(robot, motion).Boxes();
    for (const int gait : {entry.from, entry.to}) {
      entry.rest_time += model.gaits[gait]->motion->RestTime();
    }
    model.transitions.push_back(std::move(entry));
  }
  for (int from = 0; from < static_cast<int>(model.gaits.size()); ++from) {
    for (int to = from + 1; to < static_cast<int>(model.gaits.size()); ++to) {
      if (StanceOf(model.gaits[from]->gait.name, further) ==
          StanceOf(model.gaits[to]->gait.name, further)) {
        model.transitions.push_back(Change(robot, model, from, to));
      }
    }
  }
  return model;
}

double ChainLength(const models::RobotModel& robot, const models::ContactPatch& patch) {
  double length = 0;
  for (const Eigen::Vector3d& p : patch.points) length = std::max(length, p.norm());
  for (int link = patch.link; link != 0; link = robot.joints[link - 1].parent) {
    const models::Joint& joint = robot.joints[link - 1];
    length += joint.X_PJ.translation().norm();
    if (joint.type == models::JointType::kPrismatic) {
      length += std::max(std::abs(joint.lower), std::abs(joint.upper));
    }
  }
  return length;
}

double BearingReach(const models::RobotModel& robot, const models::Gait& gait) {
  double reach = 0;
  for (const models::GaitLimb& limb : gait.limbs) {
    reach = std::max(reach, ChainLength(robot, robot.contacts[limb.contact]));
  }
  return reach;
}

std::optional<GroundedStance> AsStance(const LocomotionModel& model, int gait,
                                       const Eigen::Isometry3d& X_WR) {
  constexpr double kTiltTolerance = 1e-6;
  const Eigen::Isometry3d& X_SR = model.gaits[gait]->stance.X_SR;
  const Eigen::Matrix3d R_WS = X_WR.linear() * X_SR.linear().transpose();
  if ((R_WS.col(2) - Eigen::Vector3d::UnitZ()).norm() > kTiltTolerance) return std::nullopt;
  GroundedStance stance;
  stance.gait = gait;
  const double yaw = std::atan2(R_WS(1, 0), R_WS(0, 0));
  const Eigen::Vector3d origin = X_WR.translation() - R_WS * X_SR.translation();
  stance.pose = {origin.x(), origin.y(), yaw};
  stance.z = origin.z();
  return stance;
}

}  // namespace possibility::actions
