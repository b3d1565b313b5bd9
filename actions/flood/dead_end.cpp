#include "actions/flood/dead_end.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "actions/conditions/blockers.h"
#include "actions/conditions/exploration_pose.h"
#include "actions/flood/checker_error.h"
#include "models/shapes/upright_boxes.h"
#include "models/world/collision.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Boxes = std::vector<Eigen::AlignedBox3d>;

/// Largest distance of the first stride's frame from the stance, along the axes of both. C_S of a
/// straight way tests the swept volume in that frame.
Vector3d HalfStride(StrideClass strides, const models::GaitParameters& parameters) {
  const bool ahead = strides == StrideClass::kStraight || strides == StrideClass::kOblique;
  const bool aside = strides == StrideClass::kSideways || strides == StrideClass::kOblique;
  return {ahead ? parameters.forward / 2 : 0, aside ? parameters.lateral / 2 : 0, 0};
}

class DeadEnds {
 public:
  DeadEnds(const LocomotionModel& model, const World& world,
           const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres)
      : model_(model), world_(world), manoeuvres_(manoeuvres), checker_(*world.environment) {}

  /// Whether no way begins (or, if not `begins`, ends) at a stance.
  bool IsDeadEnd(const GroundedStance& stance, bool begins) const {
    const bool may_leap =
        std::any_of(manoeuvres_.begin(), manoeuvres_.end(), [&](const auto& manoeuvre) {
          return (begins ? manoeuvre->from() : manoeuvre->to()) == stance.gait;
        });
    return !may_leap && !MayChange(stance) &&
           std::none_of(kStrideClasses.begin(), kStrideClasses.end(), [&](StrideClass strides) {
             return IsFree(LeastRoom(strides, stance.gait), stance.pose, stance.z);
           });
  }

  std::vector<std::string> ClosedBy(const GroundedStance& stance) const {
    std::vector<models::PosedShape> posed;
    for (const Eigen::AlignedBox3d& box : LeastRoom(StrideClass::kStraight, stance.gait)) {
      Eigen::Isometry3d X_SB = Eigen::Isometry3d::Identity();
      X_SB.translation() = box.center();
      posed.push_back({models::Shape::Box(box.sizes()), stance.pose.At(stance.z) * X_SB});
    }
    return Blockers(*world_.environment, posed);
  }

 private:
  /// Volume that every way of the class that begins or ends at a stance needs there.
  Boxes LeastRoom(StrideClass strides, int gait) const {
    const LocomotionModel::GaitEntry& entry = *model_.gaits[gait];
    const Vector3d less = HalfStride(strides, entry.stance.gait->parameters);
    return Shrunk(entry.volumes.sweep(strides), less);
  }

  static Boxes Shrunk(const Boxes& boxes, const Vector3d& less) {
    const Vector3d margin = less + Vector3d::Constant(kCheckerError);
    Boxes shrunk;
    for (const Eigen::AlignedBox3d& box : boxes) {
      if ((box.sizes() - 2 * margin).minCoeff() <= 0) continue;
      shrunk.emplace_back(box.min() + margin, box.max() - margin);
    }
    return shrunk;
  }

  bool IsFree(const Boxes& boxes, const PlanarPose& pose, double z) const {
    return checker_.AreFree(models::UprightBoxes(boxes), pose.At(z));
  }

  /// Whether a transition into or out of another gait has room; the room is the same in both
  /// directions.
  bool MayChange(const GroundedStance& stance) const {
    return std::any_of(
        model_.transitions.begin(), model_.transitions.end(), [&](const auto& transition) {
          if (transition.from != stance.gait && transition.to != stance.gait) return false;
          const PlanarPose begin = transition.from == stance.gait
                                       ? stance.pose
                                       : stance.pose * transition.displacement.Inverse();
          return IsFree(Shrunk(transition.sweep, Vector3d::Zero()), begin, stance.z);
        });
  }

  const LocomotionModel& model_;
  const World& world_;
  const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres_;
  models::CollisionChecker checker_;
};

bool IsSame(const GroundedStance& a, const GroundedStance& b) {
  return a.gait == b.gait && (a.pose.position() - b.pose.position()).norm() < kSamePose &&
         std::abs(WrapAngle(a.pose.yaw - b.pose.yaw)) < kSamePose &&
         std::abs(a.z - b.z) < kSamePose;
}

}  // namespace

std::optional<FloodResult> FindDeadEnd(const LocomotionModel& model, const World& world,
                                       const std::vector<std::shared_ptr<Manoeuvre>>& manoeuvres,
                                       const GroundedStance& start,
                                       const std::vector<GroundedStance>& goals) {
  const DeadEnds dead_ends(model, world, manoeuvres);
  const auto is_start = [&](const GroundedStance& goal) { return IsSame(start, goal); };
  if (goals.empty() || std::any_of(goals.begin(), goals.end(), is_start)) return std::nullopt;
  const auto ends = [&](const GroundedStance& goal) { return dead_ends.IsDeadEnd(goal, false); };
  const bool stays = dead_ends.IsDeadEnd(start, true);
  if (!stays && !std::all_of(goals.begin(), goals.end(), ends)) return std::nullopt;

  std::set<std::string> names;
  const auto add = [&](const GroundedStance& stance) {
    for (std::string& name : dead_ends.ClosedBy(stance)) names.insert(std::move(name));
  };
  if (stays) {
    add(start);
  } else {
    std::for_each(goals.begin(), goals.end(), add);
  }
  const auto from_start = [&](const GroundedStance& goal) {
    return (goal.pose.position() - start.pose.position()).norm();
  };
  const auto nearest =
      std::min_element(goals.begin(), goals.end(),
                       [&](const auto& a, const auto& b) { return from_start(a) < from_start(b); });
  FloodResult result;
  result.route_may_exist = false;
  result.barrier = {stays ? start.pose.position() : nearest->pose.position(),
                    stays ? from_start(*nearest) : 0,
                    {names.begin(), names.end()},
                    {}};
  return result;
}

}  // namespace possibility::actions
