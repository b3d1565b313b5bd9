#include "actions/quasi_static_action.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "actions/blockers.h"
#include "actions/exploration_pose.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Heights and positions of points in E agree when closer than this, m.
constexpr double kSamePlace = 1e-6;

/// Spacing at which C_N looks at an edge, m.
constexpr double kNecessarySpacing = 0.05;

bool SamePoint(const graph::Point& a, const graph::Point& b) {
  return (a - b).lpNorm<Eigen::Infinity>() < kSamePlace;
}

}  // namespace

QuasiStaticAction::QuasiStaticAction(const LocomotionModel& model, int gait, const World& world,
                                     std::shared_ptr<const graph::ExplorationSpace> space,
                                     double step)
    : model_(&model),
      gait_(gait),
      world_(world),
      space_(std::move(space)),
      step_(step),
      checker_(*world.environment),
      pelvis_(*model.robot, checker_),
      sweep_(Prepare(model.gaits[gait]->sweep, 0)),
      inflated_sweep_(Prepare(model.gaits[gait]->sweep, kEdgeInflation)) {
  for (const LocomotionModel::TransitionEntry& transition : model.transitions) {
    transition_sweeps_.push_back(Prepare(transition.sweep, 0));
  }
  const models::RobotModel& robot = *model.robot;
  for (const auto& entry : model.gaits) {
    double radius = 0;
    for (const std::vector<Vector2d>& points : entry->stance.bearing_points) {
      for (const Vector2d& p_S : points) radius = std::max(radius, p_S.norm());
    }
    bearing_radii_.push_back(radius);
  }
  for (const Eigen::AlignedBox3d& box : model.gaits[gait]->sweep) {
    const Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
    sweep_radius_ = std::max(sweep_radius_, far.norm());
  }
  for (const models::GaitLimb& limb : model.gaits[gait]->stance.gait->limbs) {
    if (!limb.hold_orientation) continue;
    leg_reach_ = std::max(leg_reach_, ChainLength(robot, robot.contacts[limb.contact]));
  }
}

QuasiStaticAction::PreparedSweep QuasiStaticAction::Prepare(
    const std::vector<Eigen::AlignedBox3d>& boxes, double inflation) const {
  PreparedSweep sweep;
  for (const Eigen::AlignedBox3d& box : boxes) {
    const Vector3d size = box.sizes() + Vector3d(2 * inflation, 2 * inflation, 0);
    sweep.boxes.emplace_back(models::Shape::Box(size));
    Isometry3d X_SB = Isometry3d::Identity();
    X_SB.translation() = box.center();
    sweep.X_SB.push_back(X_SB);
  }
  return sweep;
}

std::string QuasiStaticAction::name() const { return model_->gaits[gait_]->stance.gait->name; }

graph::Point QuasiStaticAction::ExtendTowards(const graph::Point& v0,
                                              const graph::Point& v1) const {
  const double distance = space_->Distance(v0, v1);
  if (distance <= step_) return v1;
  return ToPoint(Interpolate(ToPose(v0), ToPose(v1), step_ / distance));
}

graph::Point QuasiStaticAction::Project(const graph::Point& v) const {
  const Isometry3d X_WR = ToPose(v);
  const NominalStance& nominal = model_->gaits[gait_]->stance;
  const double heading = Heading(X_WR.linear()) - Heading(nominal.X_SR.linear());
  const PlanarPose stance{X_WR.translation().x(), X_WR.translation().y(), heading};
  const std::optional<int> level =
      world_.ground->LevelBelow(stance.position(), X_WR.translation().z());
  if (!level) return v;
  return ToPoint(nominal.RootPose(stance, world_.ground->levels()[*level]));
}

bool QuasiStaticAction::CN(const graph::Point& vertex) const {
  const Isometry3d X_WR = ToPose(vertex);
  return pelvis_.IsFree(X_WR) && SomeFootReachesGround(X_WR);
}

bool QuasiStaticAction::CN(const graph::PointPair& edge) const {
  const Isometry3d from = ToPose(edge.from);
  const Isometry3d to = ToPose(edge.to);
  const double length = (to.translation() - from.translation()).norm();
  const int samples = 1 + static_cast<int>(length / kNecessarySpacing);
  for (int i = 0; i <= samples; ++i) {
    const Isometry3d X_WR = Interpolate(from, to, static_cast<double>(i) / samples);
    if (!pelvis_.IsFree(X_WR) || !SomeFootReachesGround(X_WR)) return false;
  }
  return true;
}

bool QuasiStaticAction::SomeFootReachesGround(const Isometry3d& X_WR) const {
  const std::vector<double>& levels = world_.ground->levels();
  for (size_t level = 0; level < levels.size(); ++level) {
    const double height = X_WR.translation().z() - levels[level];
    if (std::abs(height) > leg_reach_) continue;
    const double reach = std::sqrt(leg_reach_ * leg_reach_ - height * height);
    if (world_.ground->Clearance(static_cast<int>(level), X_WR.translation().head<2>()) >= -reach) {
      return true;
    }
  }
  return false;
}

bool QuasiStaticAction::GroundHolds(const GroundedStance& stance, double clearance) const {
  const Vector2d centre = stance.pose.position();
  const std::optional<int> level = world_.ground->LevelAt(centre, stance.z, kSamePlace);
  const double all_round = bearing_radii_[stance.gait] + clearance + kSamePlace;
  if (level && world_.ground->Clearance(*level, centre) >= all_round) return true;
  const NominalStance& nominal = model_->gaits[stance.gait]->stance;
  for (const std::vector<Vector2d>& points : nominal.bearing_points) {
    for (const Vector2d& p_S : points) {
      const Vector2d p = stance.pose * p_S;
      const std::optional<int> below = world_.ground->LevelAt(p, stance.z, kSamePlace);
      if (!below || world_.ground->Clearance(*below, p) < clearance) return false;
    }
  }
  return true;
}

bool QuasiStaticAction::BoxesFree(const std::vector<models::PreparedShape>& boxes,
                                  const std::vector<Isometry3d>& X_SB,
                                  const GroundedStance& stance) const {
  const Isometry3d X_WS = stance.pose.At(stance.z);
  for (size_t i = 0; i < boxes.size(); ++i) {
    if (!checker_.IsFree(boxes[i], X_WS * X_SB[i], 0)) return false;
  }
  return true;
}

StanceFault QuasiStaticAction::Examine(const GroundedStance& stance) const {
  if (!GroundHolds(stance, 0)) return StanceFault::kOffGround;
  if (!BoxesFree(sweep_.boxes, sweep_.X_SB, stance)) return StanceFault::kCollision;
  return StanceFault::kNone;
}

std::string QuasiStaticAction::FirstBlocker(const GroundedStance& stance) const {
  std::vector<models::PosedShape> boxes;
  for (const Eigen::AlignedBox3d& box : model_->gaits[gait_]->sweep) {
    Isometry3d X_SB = Isometry3d::Identity();
    X_SB.translation() = box.center();
    boxes.push_back({models::Shape::Box(box.sizes()), stance.pose.At(stance.z) * X_SB});
  }
  const std::vector<std::string> blockers = Blockers(*world_.environment, boxes);
  return blockers.empty() ? std::string() : blockers.front();
}

bool QuasiStaticAction::CS(const graph::Point& vertex) const {
  const std::optional<GroundedStance> stance = AsStance(*model_, gait_, ToPose(vertex));
  return stance && Examine(*stance) == StanceFault::kNone;
}

bool QuasiStaticAction::IsClear(const GroundedStance& from, const GroundedStance& to) const {
  const double turn = std::abs(WrapAngle(to.pose.yaw - from.pose.yaw));
  const double travel = (to.pose.position() - from.pose.position()).norm() + sweep_radius_ * turn;
  const int samples = std::max(1, static_cast<int>(std::ceil(travel / (2 * kEdgeInflation))));
  for (int i = 0; i < samples; ++i) {
    GroundedStance sample = from;
    sample.pose = Interpolate(from.pose, to.pose, (i + 0.5) / samples);
    if (!GroundHolds(sample, travel / (2 * samples)) ||
        !BoxesFree(inflated_sweep_.boxes, inflated_sweep_.X_SB, sample)) {
      return false;
    }
  }
  return true;
}

bool QuasiStaticAction::CS(const graph::PointPair& edge) const {
  if (IsForbidden(edge)) return false;
  GroundedStance start;
  if (const LocomotionModel::TransitionEntry* transition = FindTransition(edge, &start)) {
    return TransitionIsClear(*transition, start);
  }
  const std::optional<GroundedStance> from = AsStance(*model_, gait_, ToPose(edge.from));
  const std::optional<GroundedStance> to = AsStance(*model_, gait_, ToPose(edge.to));
  if (!from || !to || std::abs(from->z - to->z) > kSamePlace) return false;
  return Examine(*from) == StanceFault::kNone && Examine(*to) == StanceFault::kNone &&
         IsClear(*from, *to);
}

const LocomotionModel::TransitionEntry* QuasiStaticAction::FindTransition(
    const graph::PointPair& edge, GroundedStance* start) const {
  const Isometry3d ends[2] = {ToPose(edge.from), ToPose(edge.to)};
  for (const LocomotionModel::TransitionEntry& transition : model_->transitions) {
    if (transition.from != gait_ && transition.to != gait_) continue;
    for (int first = 0; first < 2; ++first) {
      const std::optional<GroundedStance> a = AsStance(*model_, transition.from, ends[first]);
      if (!a) continue;
      const Isometry3d target = model_->gaits[transition.to]->stance.RootPose(
          a->pose * transition.motion->displacement(), a->z);
      if (target.isApprox(ends[1 - first], kSamePlace)) {
        *start = *a;
        return &transition;
      }
    }
  }
  return nullptr;
}

bool QuasiStaticAction::TransitionIsClear(const LocomotionModel::TransitionEntry& transition,
                                          const GroundedStance& start) const {
  GroundedStance end{transition.to, start.pose * transition.motion->displacement(), start.z};
  const size_t index = &transition - model_->transitions.data();
  const PreparedSweep& sweep = transition_sweeps_[index];
  return GroundHolds(start, 0) && GroundHolds(end, 0) && BoxesFree(sweep.boxes, sweep.X_SB, start);
}

std::vector<graph::Point> QuasiStaticAction::TransitionFrom(const graph::Point& v) const {
  const Isometry3d X_WR = ToPose(v);
  for (const LocomotionModel::TransitionEntry& transition : model_->transitions) {
    const bool forward = transition.to == gait_;
    if (!forward && transition.from != gait_) continue;
    const std::optional<GroundedStance> stance =
        AsStance(*model_, forward ? transition.from : transition.to, X_WR);
    if (!stance) continue;
    const PlanarPose displacement =
        forward ? transition.motion->displacement() : transition.motion->displacement().Inverse();
    const graph::Point target =
        ToPoint(model_->gaits[gait_]->stance.RootPose(stance->pose * displacement, stance->z));
    if (CS(graph::PointPair{v, target}) && CS(target)) return {target};
  }
  return {};
}

double QuasiStaticAction::ExpectedDuration(const PlanarPose& from, const PlanarPose& to) const {
  const LocomotionModel::GaitEntry& gait = *model_->gaits[gait_];
  const std::vector<PlanarPose> strides = PlanStrides(gait.stance.gait->parameters, from, to);
  return gait.motion->ExpectedDuration(static_cast<int>(strides.size()) - 1);
}

double QuasiStaticAction::ExpectedDuration(const graph::PointPair& edge) const {
  GroundedStance start;
  if (const LocomotionModel::TransitionEntry* transition = FindTransition(edge, &start)) {
    return transition->motion->ExpectedDuration();
  }
  const Isometry3d from = ToPose(edge.from);
  const Isometry3d to = ToPose(edge.to);
  return ExpectedDuration(
      PlanarPose{from.translation().x(), from.translation().y(), Heading(from.linear())},
      PlanarPose{to.translation().x(), to.translation().y(), Heading(to.linear())});
}

std::unique_ptr<graph::ConfirmationJob> QuasiStaticAction::SpawnConfirmationJob(
    const graph::PointPair&) const {
  return nullptr;
}

void QuasiStaticAction::Forbid(const graph::PointPair& edge) { forbidden_.push_back(edge); }

bool QuasiStaticAction::IsForbidden(const graph::PointPair& edge) const {
  return std::any_of(forbidden_.begin(), forbidden_.end(), [&](const graph::PointPair& other) {
    return (SamePoint(edge.from, other.from) && SamePoint(edge.to, other.to)) ||
           (SamePoint(edge.from, other.to) && SamePoint(edge.to, other.from));
  });
}

}  // namespace possibility::actions
