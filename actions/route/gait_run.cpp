#include "actions/route/gait_run.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

#include "actions/gait/stride.h"
#include "actions/motion/phase_sequence.h"
#include "actions/wholebody/motion_error.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

/// Radius that makes a length of a heading, m.
constexpr double kHeadingRadius = 0.3;

/// A phase only turns joints if the root and limbs move less, m and rad, and it ends at rest, in SI
/// units.
constexpr double kUnmoved = 1e-6;
constexpr double kAtRest = 1e-6;

/// Heights of one run differ by less, m.
constexpr double kSameHeight = 1e-9;

bool IsStraightWay(const LocomotionModel& model, const RouteLeg& leg) {
  if (leg.manoeuvre != nullptr || leg.transition >= 0) return false;
  return StrideCount(model.gaits[leg.gait]->gait.parameters, leg.from, leg.to) > 0;
}

/// How far the root is from its pose in a stance, m.
double Offset(const NominalStance& stance, const PlanarPose& pose, const Knot& knot) {
  const Eigen::Isometry3d X_WR = stance.RootPose(pose, 0);
  const Eigen::Quaterniond turn(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
  return (X_WR.translation() - knot.q.segment<3>(4)).head<2>().norm() +
         kHeadingRadius * turn.angularDistance(Eigen::Quaterniond(X_WR.linear()));
}

/// Index of the first phase of each leg after the first, and the number of phases. Every leg gets a
/// phase.
std::vector<int> Cuts(const LocomotionModel& model, const Route& route, int first, int count,
                      const std::vector<Phase>& motion) {
  const NominalStance& stance = model.gaits[route[first].gait]->stance;
  const int phases = static_cast<int>(motion.size());
  if (phases < count) throw MotionError("the motion has fewer phases than straight ways");
  std::vector<int> cuts;
  for (int leg = 0; leg + 1 < count; ++leg) {
    const PlanarPose end = SeenFrom(route[first].from, route[first + leg].to);
    const int least = (cuts.empty() ? 0 : cuts.back()) + 1;
    int best = least;
    double closest = std::numeric_limits<double>::infinity();
    for (int cut = least; cut <= phases - (count - 1 - leg); ++cut) {
      const double offset = Offset(stance, end, motion[cut - 1].knots.back());
      if (offset >= closest) continue;
      closest = offset;
      best = cut;
    }
    cuts.push_back(best);
  }
  cuts.push_back(phases);
  return cuts;
}

}  // namespace

int RunLength(const LocomotionModel& model, const Route& route, int first) {
  const RouteLeg& begin = route[first];
  if (!IsStraightWay(model, begin) || !model.gaits[begin.gait]->motion->Flows()) return 1;
  int count = 1;
  while (first + count < static_cast<int>(route.size())) {
    const RouteLeg& next = route[first + count];
    if (!IsStraightWay(model, next) || next.gait != begin.gait ||
        std::abs(next.z - begin.z) > kSameHeight) {
      break;
    }
    ++count;
  }
  return count;
}

PlanarPose SeenFrom(const PlanarPose& begin, const PlanarPose& pose) {
  return {pose.x - begin.x, pose.y - begin.y, pose.yaw};
}

std::vector<StanceLine> StraightLinesOf(const LocomotionModel& model, const Route& route, int first,
                                        int count) {
  const PlanarPose& origin = route[first].from;
  std::vector<PlanarPose> strides = {SeenFrom(origin, origin)};
  for (int i = first; i < first + count; ++i) {
    const std::vector<PlanarPose> more =
        PlanStrides(model.gaits[route[i].gait]->gait.parameters, SeenFrom(origin, route[i].from),
                    SeenFrom(origin, route[i].to));
    strides.insert(strides.end(), more.begin() + 1, more.end());
  }
  return StraightLines(strides);
}

std::vector<std::vector<Phase>> FlowAlong(const LocomotionModel& model, const Route& route,
                                          int first, int count,
                                          const std::vector<StanceLine>& lines, const FlowEnd& end,
                                          const CancellationToken& cancellation) {
  std::vector<Phase> motion = model.gaits[route[first].gait]->motion->Flow(
      lines, end, MotionSettings().knot_spacing, cancellation);
  const Vector3d place(route[first].from.x, route[first].from.y, route[first].z);
  std::vector<std::vector<Phase>> legs(count);
  int phase = 0;
  int leg = 0;
  for (const int cut : Cuts(model, route, first, count, motion)) {
    const double start = motion[phase].knots.front().t;
    for (; phase < cut; ++phase) {
      for (Knot& knot : motion[phase].knots) knot.q.segment<3>(4) += place;
      legs[leg].push_back(std::move(motion[phase]));
    }
    ShiftTime(-start, &legs[leg++]);
  }
  return legs;
}

std::optional<FlowEnd> EndReadyFor(const NominalStance& stance,
                                   const std::vector<Phase>& manoeuvre) {
  if (manoeuvre.size() < 2 || manoeuvre[1].impulses.cols() > 0) return std::nullopt;
  const Phase& phase = manoeuvre.front();
  const Knot& first = phase.knots.front();
  const Knot& last = phase.knots.back();
  const auto rests = [](const Knot& knot) {
    return knot.v.lpNorm<Eigen::Infinity>() < kAtRest && knot.a.lpNorm<Eigen::Infinity>() < kAtRest;
  };
  if (!rests(first) || !rests(last)) return std::nullopt;
  if ((last.q - first.q).head<7>().lpNorm<Eigen::Infinity>() > kUnmoved) return std::nullopt;
  const Eigen::Index joints = last.q.size() - 7;
  const Eigen::VectorXd turned = (last.q - first.q).tail(joints);
  if (turned.lpNorm<Eigen::Infinity>() < kUnmoved) return std::nullopt;  // A pause is meant.
  FlowEnd end{last.q.tail(joints), last.t - first.t};
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    for (const int joint : limb.joints) {
      double& position = end.joints[joint];
      if (std::abs(position - stance.q[7 + joint]) > kUnmoved) return std::nullopt;
      position = stance.q[7 + joint];
    }
  }
  return end;
}

}  // namespace possibility::actions
