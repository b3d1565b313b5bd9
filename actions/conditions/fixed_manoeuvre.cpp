#include "actions/conditions/fixed_manoeuvre.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "actions/motion/phase_sequence.h"
#include "actions/wholebody/motion_error.h"
#include "models/shapes/shape.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kSamePlace = 1e-6;  // m and rad
constexpr double kSameRise = 1e-9;   // m
constexpr double kSpacing = 0.01;    // m, between stances tried on the way to an edge
constexpr double kFarthest = 3;      // m, of that way
constexpr double kTurnAsWay = 1;     // m: a radian of turning counts like this way
constexpr int kSides = 4;            // of a box

std::int64_t KeyOf(double rise) { return std::llround(rise / kSameRise); }

/// Headings square to the sides of the ground, each once.
std::vector<double> SquareHeadings(const models::Environment& environment) {
  std::vector<double> headings;
  const auto add = [&headings](double one_side) {
    for (int side = 0; side < kSides; ++side) {
      const double heading = one_side + side * std::numbers::pi / 2;
      const bool is_known = std::any_of(headings.begin(), headings.end(), [&](double known) {
        return std::abs(WrapAngle(known - heading)) < kSamePlace;
      });
      if (!is_known) headings.push_back(heading);
    }
  };
  for (const models::Obstacle& obstacle : environment.obstacles) {
    if (obstacle.is_ground && obstacle.surface < 0) add(Heading(obstacle.X_WO.linear()));
  }
  for (const models::Surface& surface : environment.surfaces) {
    for (const double heading : surface.headings) add(heading);
  }
  return headings;
}

bool Rises(const FixedManoeuvreShape& shape, double height) {
  return height >= shape.lowest - kSamePlace && height <= shape.highest + kSamePlace;
}

/// Turns the world by -`heading`, so that the heading is along x.
Eigen::Isometry3d TurnedBack(double heading) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(-heading, Eigen::Vector3d::UnitZ()));
}

/// Whether a way leads roughly towards a target.
bool LeadsTo(const Vector2d& way, const Vector2d& towards) {
  return way.normalized().dot(towards) >= towards.norm() * std::numbers::sqrt2 / 2;
}

}  // namespace

FixedManoeuvre::FixedManoeuvre(const PlanningContext& context, FixedManoeuvreShape shape,
                               MotionAtOrigin motion)
    : Manoeuvre(context, shape.name, shape.from, shape.to),
      shape_(std::move(shape)),
      motion_(std::move(motion)),
      headings_(SquareHeadings(*context.world.environment)),
      crossables_(FindCrossables()) {
  if (shape_.is_reversible && shape_.from != shape_.to) {
    throw std::invalid_argument("manoeuvre '" + shape_.name +
                                "' is reversible but ends in another gait than it starts from");
  }
}

std::optional<FixedManoeuvre::Execution> FixedManoeuvre::Forwards(
    const GroundedStance& launch, const GroundedStance& landing) const {
  const PlanarPose moved = launch.pose.Inverse() * landing.pose;
  const double off = (moved.position() - shape_.displacement.position()).lpNorm<Eigen::Infinity>();
  const double turned = std::abs(WrapAngle(moved.yaw - shape_.displacement.yaw));
  const double rise = landing.z - launch.z;
  if (off > kSamePlace || turned > kSamePlace || !Rises(shape_, rise)) return std::nullopt;
  return Execution{launch, rise, false};
}

std::optional<FixedManoeuvre::Execution> FixedManoeuvre::AsExecution(
    const graph::Edge& edge) const {
  const std::optional<GroundedStance> from = LaunchStance(edge.from);
  const std::optional<GroundedStance> to = LandingStance(edge.to);
  if (!from || !to) return std::nullopt;
  std::optional<Execution> execution = Forwards(*from, *to);
  if (!execution && shape_.is_reversible) {
    execution = Forwards(*to, *from);
    if (execution) execution->is_reversed = true;
  }
  return execution;
}

double FixedManoeuvre::GreatestSpeed() const {
  return shape_.displacement.position().norm() / shape_.duration;
}

bool FixedManoeuvre::CN(const graph::Edge& edge) const {
  const std::optional<Execution> execution = AsExecution(edge);
  if (!execution || !launch_gait().CS(edge.from) || !landing_gait().CS(edge.to)) return false;
  if (!Crosses(execution->launch)) return false;
  const std::lock_guard lock(mutex_);
  return !refuted_.contains(KeyOf(execution->rise));
}

std::vector<FixedManoeuvre::Crossable> FixedManoeuvre::FindCrossables() const {
  std::vector<Crossable> crossables;
  if (!shape_.over) return crossables;
  for (const models::Obstacle& obstacle : world().environment->obstacles) {
    // A piece of a surface says nothing of what lies beside it.
    if (obstacle.is_ground || obstacle.surface >= 0) continue;
    for (int side = 0; side < kSides; ++side) {
      const double heading = Heading(obstacle.X_WO.linear()) + side * std::numbers::pi / 2;
      const Eigen::AlignedBox3d bounds = obstacle.shape.Bounds(TurnedBack(heading) * obstacle.X_WO);
      const bool is_thin = bounds.sizes().x() <= shape_.over->end - shape_.over->begin + kSamePlace;
      const bool is_low = std::any_of(
          world().ground->levels().begin(), world().ground->levels().end(), [&](double level) {
            return bounds.max().z() > level + kSamePlace &&
                   bounds.max().z() <= level + shape_.over->height + kSamePlace;
          });
      if (is_thin && is_low) crossables.push_back({heading, bounds});
    }
  }
  return crossables;
}

bool FixedManoeuvre::Crosses(const GroundedStance& launch) const {
  if (!shape_.over) return true;
  const Eigen::Isometry3d X_SW = launch.pose.At(launch.z).inverse();
  return std::any_of(crossables_.begin(), crossables_.end(), [&](const Crossable& crossable) {
    const Eigen::Isometry3d X_SC = X_SW * TurnedBack(crossable.heading).inverse();
    const Eigen::AlignedBox3d bounds =
        models::Shape::Box(crossable.bounds.sizes())
            .Bounds(X_SC * Eigen::Translation3d(crossable.bounds.center()));
    return bounds.min().x() >= shape_.over->begin - kSamePlace &&
           bounds.max().x() <= shape_.over->end + kSamePlace && bounds.min().y() <= 0 &&
           bounds.max().y() >= 0 && bounds.max().z() > kSamePlace &&
           bounds.max().z() <= shape_.over->height + kSamePlace;
  });
}

bool FixedManoeuvre::Holds(const GroundedStance& stance) const {
  const QuasiStaticAction& gait = stance.gait == shape_.from ? launch_gait() : landing_gait();
  return gait.Examine(stance) == StanceFault::kNone;
}

std::vector<bool> FixedManoeuvre::Directions(End end) const {
  const bool forwards = end == End::kLaunch;
  if (shape_.is_reversible) return {forwards, !forwards};
  return {forwards};
}

std::optional<GroundedStance> FixedManoeuvre::StanceAt(End end, const graph::Point& v) const {
  return end == End::kLaunch ? LaunchStance(v) : LandingStance(v);
}

std::optional<GroundedStance> FixedManoeuvre::Displaced(const GroundedStance& stance,
                                                        bool forwards) const {
  GroundedStance other;
  other.gait = forwards ? shape_.to : shape_.from;
  other.pose = stance.pose * (forwards ? shape_.displacement : shape_.displacement.Inverse());
  for (const double level : world().ground->levels()) {
    if (!Rises(shape_, forwards ? level - stance.z : stance.z - level)) continue;
    other.z = level;
    const GroundedStance& launch = forwards ? stance : other;
    if (Crosses(launch) && Holds(other) && Holds(stance)) return other;
  }
  return std::nullopt;
}

std::optional<GroundedStance> FixedManoeuvre::OtherEnd(const GroundedStance& stance, End end,
                                                       const Vector2d& towards) const {
  for (const bool forwards : Directions(end)) {
    const std::optional<GroundedStance> other = Displaced(stance, forwards);
    if (!other) continue;
    if ((other->pose.position() - stance.pose.position()).dot(towards) > 0) return other;
  }
  return std::nullopt;
}

graph::Point FixedManoeuvre::Extended(End end, const graph::Point& v0,
                                      const graph::Point& v1) const {
  const std::optional<GroundedStance> stance = StanceAt(end, v0);
  if (!stance) return v0;
  const std::optional<GroundedStance> other = OtherEnd(*stance, end, (v1 - v0).head<2>());
  return other ? PointOf(*other) : v0;
}

graph::Point FixedManoeuvre::ExtendTowards(const graph::Point& v0, const graph::Point& v1) const {
  return Extended(End::kLaunch, v0, v1);
}

graph::Point FixedManoeuvre::ReverseExtend(const graph::Point& v0, const graph::Point& v1) const {
  return Extended(End::kLanding, v0, v1);
}

std::optional<graph::Point> FixedManoeuvre::StanceNear(End end, const graph::Point& v,
                                                       const graph::Point& v1) const {
  const std::optional<GroundedStance> stance = StanceAt(end, v);
  const Vector2d towards = (v1 - v).head<2>();
  if (!stance) return std::nullopt;
  if (OtherEnd(*stance, end, towards)) return v;
  const std::optional<GroundedStance> near =
      shape_.over ? AtAnObstacle(end, *stance, towards) : AtAnEdge(end, *stance, towards);
  if (!near) return std::nullopt;
  return PointOf(*near);
}

std::optional<GroundedStance> FixedManoeuvre::AtAnEdge(End end, const GroundedStance& stance,
                                                       const Vector2d& towards) const {
  for (const double heading : headings_) {
    for (const bool forwards : Directions(end)) {
      const PlanarPose way = forwards ? shape_.displacement : shape_.displacement.Inverse();
      const Vector2d ahead = (Eigen::Rotation2Dd(heading) * way.position()).normalized();
      if (!LeadsTo(ahead, towards)) continue;
      for (double s = 0; s < kFarthest; s += kSpacing) {
        GroundedStance there = stance;
        there.pose = {stance.pose.x + s * ahead.x(), stance.pose.y + s * ahead.y(), heading};
        if (Displaced(there, forwards)) return there;
      }
    }
  }
  return std::nullopt;
}

std::optional<GroundedStance> FixedManoeuvre::AtAnObstacle(End end, const GroundedStance& stance,
                                                           const Vector2d& towards) const {
  std::optional<GroundedStance> closest;
  double least = std::numeric_limits<double>::infinity();
  const double middle = (shape_.over->begin + shape_.over->end) / 2;
  for (const Crossable& crossable : crossables_) {
    const Eigen::Rotation2Dd turn(crossable.heading);
    const double beside = (turn.inverse() * stance.pose.position()).y();
    const Vector2d place = turn * Vector2d(crossable.bounds.center().x() - middle, beside);
    const PlanarPose launch{place.x(), place.y(), crossable.heading};
    for (const bool forwards : Directions(end)) {
      GroundedStance there = stance;
      there.pose = forwards ? launch : launch * shape_.displacement;
      const double distance = (there.pose.position() - stance.pose.position()).norm();
      const double turn_there = std::abs(WrapAngle(there.pose.yaw - stance.pose.yaw));
      const double way_there = distance + kTurnAsWay * turn_there;
      const PlanarPose way = forwards ? shape_.displacement : shape_.displacement.Inverse();
      const Vector2d ahead = Eigen::Rotation2Dd(there.pose.yaw) * way.position();
      if (distance > kFarthest || way_there >= least || !LeadsTo(ahead, towards)) continue;
      const Vector2d obstacle = turn * crossable.bounds.center().head<2>();
      const bool is_on_this_side = (stance.pose.position() - obstacle).dot(ahead) < 0;
      if (!is_on_this_side || !Displaced(there, forwards)) continue;
      closest = there;
      least = way_there;
    }
  }
  return closest;
}

std::optional<graph::Point> FixedManoeuvre::FindLaunchPoint(const graph::Point& v,
                                                            const graph::Point& v1) const {
  return StanceNear(End::kLaunch, v, v1);
}

std::optional<graph::Point> FixedManoeuvre::FindLandingPoint(const graph::Point& v,
                                                             const graph::Point& v1) const {
  return StanceNear(End::kLanding, v, v1);
}

std::optional<FixedManoeuvre::Outcome> FixedManoeuvre::KnownOutcome(std::int64_t rise) const {
  const std::lock_guard lock(mutex_);
  const auto known = outcomes_.find(rise);
  if (known == outcomes_.end()) return std::nullopt;
  return known->second;
}

FixedManoeuvre::Outcome FixedManoeuvre::OutcomeOf(std::int64_t rise,
                                                  const CancellationToken& cancellation) const {
  if (std::optional<Outcome> known = KnownOutcome(rise)) return *std::move(known);
  Outcome outcome;
  try {
    // The rounded rise, so that the motion does not depend on which edge asks first.
    outcome.motion = motion_(static_cast<double>(rise) * kSameRise, cancellation);
  } catch (const MotionError& error) {
    outcome.fault = error.what();
  }
  const std::lock_guard lock(mutex_);
  return outcomes_.emplace(rise, std::move(outcome)).first->second;
}

graph::SharedWork& FixedManoeuvre::WorkOf(std::int64_t rise) const {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<graph::SharedWork>& work = works_[rise];
  if (!work) {
    work = std::make_unique<graph::SharedWork>(
        [this, rise](graph::SharedWork* self) { OutcomeOf(rise, self->charging_token()); });
  }
  return *work;
}

bool FixedManoeuvre::Prepare(const graph::Edge& edge, graph::JobControl* job) const {
  const std::optional<Execution> execution = AsExecution(edge);
  if (!execution) throw MotionError("the edge is no '" + shape_.name + "'");
  return WorkOf(KeyOf(execution->rise)).Await(job);
}

std::vector<Phase> FixedManoeuvre::Motion(const graph::Edge& edge,
                                          const CancellationToken& cancellation) const {
  const std::optional<Execution> execution = AsExecution(edge);
  if (!execution) throw MotionError("the edge is no '" + shape_.name + "'");
  Outcome outcome = OutcomeOf(KeyOf(execution->rise), cancellation);
  if (!outcome.fault.empty()) throw MotionError(outcome.fault);
  std::vector<Phase> motion =
      Placed(std::move(outcome.motion), execution->launch.pose, execution->launch.z);
  return execution->is_reversed ? Reversed(*model().robot, motion) : motion;
}

ManoeuvreBounds FixedManoeuvre::Bounds() const {
  ManoeuvreBounds bounds;
  bounds.landings = [shape = shape_, leads_nowhere = shape_.over && crossables_.empty()](
                        double rise) -> std::optional<LandingRange> {
    if (leads_nowhere) return std::nullopt;
    LandingRange range;
    const auto extend = [&range](const PlanarPose& landing) {
      range.offset.extend(landing.position());
      range.turn = std::max(range.turn, std::abs(WrapAngle(landing.yaw)));
    };
    if (Rises(shape, rise)) extend(shape.displacement);
    if (shape.is_reversible && Rises(shape, -rise)) extend(shape.displacement.Inverse());
    if (range.offset.isEmpty()) return std::nullopt;
    return range;
  };
  bounds.flight = shape_.flight;
  return bounds;
}

void FixedManoeuvre::RefuteEverywhere(const graph::Edge& edge) {
  const std::optional<Execution> execution = AsExecution(edge);
  if (!execution) return;
  const std::lock_guard lock(mutex_);
  refuted_.insert(KeyOf(execution->rise));
}

}  // namespace possibility::actions
