#include "experiments/examples/step_up.h"

#include <cmath>
#include <numbers>

#include "actions/conditions/exploration_pose.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

constexpr double kSamePlace = 1e-6;      // m and rad
constexpr double kSpacing = 0.01;        // m, between stances tried on the way to an edge
constexpr double kFarthest = 3;          // m, of that way
constexpr double kPelvisSpacing = 0.05;  // m

Vector2d Ahead(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

}  // namespace

StepUp::StepUp(const PlanningContext& context)
    : Manoeuvre(context, "step_up", context.model->GaitIndex("walk"),
                context.model->GaitIndex("walk")),
      motion_(*context.model->robot, *context.model->gaits[from()]),
      checker_(*context.world.environment),
      pelvis_(*context.model->robot, checker_) {
  for (const models::Obstacle& obstacle : context.world.environment->obstacles) {
    if (!obstacle.is_ground) continue;
    for (int side = 0; side < 4; ++side) {
      headings_.push_back(Heading(obstacle.X_WO.linear()) + side * std::numbers::pi / 2);
    }
  }
}

std::optional<StepUp::Step> StepUp::AsStep(const graph::Edge& edge) const {
  const std::optional<GroundedStance> from = LaunchStance(edge.from);
  const std::optional<GroundedStance> to = LandingStance(edge.to);
  if (!from || !to) return std::nullopt;
  const bool up = to->z > from->z;
  const Step step = up ? Step{*from, *to, up} : Step{*to, *from, up};
  const PlanarPose ahead = step.low.pose.Inverse() * step.high.pose;
  const double rise = step.high.z - step.low.z;
  if (rise < kLowest - kSamePlace || rise > kHighest + kSamePlace) return std::nullopt;
  if (std::abs(ahead.x - motion_.distance()) > kSamePlace || std::abs(ahead.y) > kSamePlace ||
      std::abs(WrapAngle(ahead.yaw)) > kSamePlace) {
    return std::nullopt;
  }
  return step;
}

bool StepUp::CN(const graph::Edge& edge) const {
  if (!AsStep(edge) || !launch_gait().CS(edge.from) || !landing_gait().CS(edge.to)) return false;
  const Eigen::Isometry3d from = ToPose(edge.from);
  const Eigen::Isometry3d to = ToPose(edge.to);
  const int samples = static_cast<int>(motion_.distance() / kPelvisSpacing);
  for (int i = 1; i < samples; ++i) {
    if (!pelvis_.IsFree(Interpolate(from, to, static_cast<double>(i) / samples))) return false;
  }
  return true;
}

std::optional<GroundedStance> StepUp::OtherEnd(const GroundedStance& stance,
                                               const Vector2d& towards) const {
  const bool up = Ahead(stance.pose.yaw).dot(towards) > 0;
  for (const double level : world().ground->levels()) {
    const double rise = up ? level - stance.z : stance.z - level;
    if (rise < kLowest - kSamePlace || rise > kHighest + kSamePlace) continue;
    GroundedStance end = stance;
    end.pose = stance.pose * PlanarPose{up ? motion_.distance() : -motion_.distance(), 0, 0};
    end.z = level;
    if (launch_gait().Examine(end) == StanceFault::kNone &&
        launch_gait().Examine(stance) == StanceFault::kNone) {
      return end;
    }
  }
  return std::nullopt;
}

graph::Point StepUp::ExtendTowards(const graph::Point& v0, const graph::Point& v1) const {
  const std::optional<GroundedStance> stance = LaunchStance(v0);
  if (!stance) return v0;
  const std::optional<GroundedStance> end = OtherEnd(*stance, (v1 - v0).head<2>());
  return end ? PointOf(*end) : v0;
}

graph::Point StepUp::ReverseExtend(const graph::Point& v0, const graph::Point& v1) const {
  return ExtendTowards(v0, v1);  // a step joins the same two stances in both directions
}

std::optional<graph::Point> StepUp::StanceAtAnEdge(const graph::Point& v,
                                                   const graph::Point& v1) const {
  const std::optional<GroundedStance> stance = LaunchStance(v);
  const Vector2d towards = (v1 - v).head<2>();
  if (!stance) return std::nullopt;
  if (OtherEnd(*stance, towards)) return v;
  for (const double heading : headings_) {
    const double along = Ahead(heading).dot(towards);
    if (std::abs(along) < towards.norm() * std::numbers::sqrt2 / 2) continue;
    const Vector2d direction = Ahead(heading) * (along > 0 ? 1 : -1);
    for (double s = 0; s < kFarthest; s += kSpacing) {
      GroundedStance there = *stance;
      there.pose = {stance->pose.x + s * direction.x(), stance->pose.y + s * direction.y(),
                    heading};
      if (OtherEnd(there, direction)) return PointOf(there);
    }
  }
  return std::nullopt;
}

std::optional<graph::Point> StepUp::FindLaunchPoint(const graph::Point& v,
                                                    const graph::Point& v1) const {
  return StanceAtAnEdge(v, v1);
}
std::optional<graph::Point> StepUp::FindLandingPoint(const graph::Point& v,
                                                     const graph::Point& v1) const {
  return StanceAtAnEdge(v, v1);
}

double StepUp::ExpectedDuration(const graph::Edge& edge) const {
  const std::optional<Step> step = AsStep(edge);
  return motion_.ExpectedDuration(step ? step->low.pose : PlanarPose());
}

std::vector<Phase> StepUp::Motion(const graph::Edge& edge,
                                  const CancellationToken& cancellation) const {
  const std::optional<Step> step = AsStep(edge);
  if (!step) throw MotionError("not a step between walking stances");
  const std::vector<Phase> up =
      motion_.Generate(step->low.pose, step->low.z, step->high.z - step->low.z, cancellation);
  return step->up ? up : Reversed(up);
}

ManoeuvreBounds StepUp::Bounds() const {
  ManoeuvreBounds bounds;
  bounds.landings = [distance = motion_.distance()](double rise) -> std::optional<LandingRange> {
    const double height = std::abs(rise);
    if (height < kLowest - kSamePlace || height > kHighest + kSamePlace) return std::nullopt;
    const Vector2d landing(rise > 0 ? distance : -distance, 0);
    return LandingRange{{landing, landing}};
  };
  bounds.flight = FlightBounds{};  // a foot bears at all times
  return bounds;
}

ManoeuvreFactory StepUpFactory() {
  return {"step_up",
          [](const PlanningContext& context) { return std::make_shared<StepUp>(context); }};
}

}  // namespace possibility::actions
