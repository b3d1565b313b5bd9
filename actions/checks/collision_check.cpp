#include "actions/checks/collision_check.h"

#include <fmt/format.h>

#include <algorithm>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using models::Proximity;

constexpr double kTolerance = 1e-4;        // m, the checker's accuracy
constexpr double kGroundTolerance = 1e-3;  // m, bearing links against ground
/// m/s: allowance for the increase of a link's speed until the next sample. Larger increases are
/// found by subdivision.
constexpr double kSpeedAllowance = 0.05;

double DistanceIn(const std::vector<Proximity>& proximities, const Proximity& pair,
                  double threshold) {
  double distance = threshold;
  for (const Proximity& p : proximities) {
    if (p.link == pair.link && p.other == pair.other) distance = std::min(distance, p.distance);
  }
  return distance;
}

/// Whether a pair at distances d0 and d1 at the ends of an interval, in which its distance changes
/// by at most `travel`, may come closer than -tolerance. False if travel is below half the
/// tolerance (negligible), or if the pair overlaps at an end (already reported).
bool MayOverlap(double d0, double d1, double travel, double tolerance) {
  if (std::min(d0, d1) < -tolerance || travel < tolerance / 2) return false;
  return (d0 + d1 - travel) / 2 < -tolerance;
}

}  // namespace

/// Two instants and bounds for the time between. A vector deviates from the line between its values
/// at the ends by at most h^2 / 8 times its second derivative, so its length is at most that plus
/// the larger length at the ends.
struct CollisionVerifier::Between {
  const VerifierState& s0;
  const VerifierState& s1;
  const DerivativeBounds& bounds;
  double interval = s1.knot.t - s0.knot.t;

  double Bulge(double second_derivative) const {
    return interval * interval / 8 * second_derivative;
  }
};

CollisionVerifier::CollisionVerifier(const models::RobotModel& robot,
                                     const models::Environment& environment,
                                     const std::vector<double>& link_radii)
    : robot_(&robot),
      environment_(&environment),
      link_radii_(&link_radii),
      carries_patch_(robot.links.size(), false),
      checker_(robot, environment) {
  for (const models::ContactPatch& patch : robot.contacts) carries_patch_[patch.link] = true;
}

CollisionSnapshot CollisionVerifier::Check(const VerifierState& state, double interval,
                                           const Instant& at, ViolationLog* log) {
  const double travel = (1.1 * state.max_speed + kSpeedAllowance) * interval;
  CollisionSnapshot snapshot;
  snapshot.environment_threshold = travel / 2;
  snapshot.self_threshold = travel;
  snapshot.environment =
      checker_.EnvironmentProximities(state.X_WL, snapshot.environment_threshold);
  snapshot.self = checker_.SelfProximities(state.X_WL, snapshot.self_threshold);
  for (const Proximity& pair : snapshot.environment) {
    log->RequireAtLeast(ViolationKind::kPenetration, at, pair.distance, 0,
                        EnvironmentTolerance(pair.link, pair.other), "m", [&] {
                          return fmt::format("{} against {}", robot_->links[pair.link].name,
                                             environment_->obstacles[pair.other].name);
                        });
  }
  for (const Proximity& pair : snapshot.self) {
    log->RequireAtLeast(ViolationKind::kSelfCollision, at, pair.distance, 0, kTolerance, "m", [&] {
      return fmt::format("{} against {}", robot_->links[pair.link].name,
                         robot_->links[pair.other].name);
    });
  }
  return snapshot;
}

bool CollisionVerifier::NeedsSubdivision(const VerifierState& s0, const CollisionSnapshot& c0,
                                         const VerifierState& s1, const CollisionSnapshot& c1,
                                         const DerivativeBounds& bounds) const {
  const Between between{s0, s1, bounds};
  const auto environment_needs = [&](const Proximity& pair) {
    return MayOverlap(DistanceIn(c0.environment, pair, c0.environment_threshold),
                      DistanceIn(c1.environment, pair, c1.environment_threshold),
                      LinkSpeed(between, pair.link) * between.interval,
                      EnvironmentTolerance(pair.link, pair.other));
  };
  const auto self_needs = [&](const Proximity& pair) {
    return MayOverlap(DistanceIn(c0.self, pair, c0.self_threshold),
                      DistanceIn(c1.self, pair, c1.self_threshold),
                      SelfSpeed(between, pair.link, pair.other) * between.interval, kTolerance);
  };
  const auto any = [](const auto& pairs, const auto& needs) {
    return std::any_of(pairs.begin(), pairs.end(), needs);
  };
  return UnlistedMayOverlap(between, c0, c1) || any(c0.environment, environment_needs) ||
         any(c1.environment, environment_needs) || any(c0.self, self_needs) ||
         any(c1.self, self_needs);
}

/// Whether pairs listed at neither end, because they were too far apart there, may overlap after
/// all: only if the robot accelerates strongly within the interval.
bool CollisionVerifier::UnlistedMayOverlap(const Between& between, const CollisionSnapshot& c0,
                                           const CollisionSnapshot& c1) const {
  double bulge = 0;
  for (int link = 0; link < robot_->num_links(); ++link) {
    bulge = std::max(bulge, between.bounds.Point(link, (*link_radii_)[link], 3));
  }
  const double speed = std::max(between.s0.max_speed, between.s1.max_speed) + between.Bulge(bulge);
  return MayOverlap(c0.environment_threshold, c1.environment_threshold, speed * between.interval,
                    kTolerance) ||
         MayOverlap(c0.self_threshold, c1.self_threshold, 2 * speed * between.interval, kTolerance);
}

double CollisionVerifier::EnvironmentTolerance(int link, int obstacle) const {
  return carries_patch_[link] && environment_->obstacles[obstacle].is_ground ? kGroundTolerance
                                                                             : kTolerance;
}

/// Bound on the speed of any point of a link.
double CollisionVerifier::LinkSpeed(const Between& between, int link) const {
  const double radius = (*link_radii_)[link];
  const auto speed = [&](const VerifierState& state) {
    return state.v_WL[link].norm() + state.w_WL[link].norm() * radius;
  };
  const double from_ends = std::max(speed(between.s0), speed(between.s1)) +
                           between.Bulge(between.bounds.Point(link, radius, 3));
  return std::min(from_ends, between.bounds.Point(link, radius, 1));
}

/// Bound on the speed of any point of one link relative to the other: the best of three bounds.
double CollisionVerifier::SelfSpeed(const Between& between, int link, int other) const {
  return std::min({SeenFrom(between, link, other), SeenFrom(between, other, link),
                   LinkSpeed(between, link) + LinkSpeed(between, other)});
}

double CollisionVerifier::SeenFrom(const Between& between, int link, int other) const {
  const double radius = (*link_radii_)[other];
  const auto arm = [&](const VerifierState& state) -> Vector3d {
    return state.X_WL[other].translation() - state.X_WL[link].translation();
  };
  const auto speed = [&](const VerifierState& state) {
    return (state.v_WL[other] - state.v_WL[link] - state.w_WL[link].cross(arm(state))).norm() +
           (state.w_WL[other] - state.w_WL[link]).norm() * radius;
  };
  const DerivativeBounds& bounds = between.bounds;
  const Derivatives& turning = bounds.Rotation(link);
  const auto apart = [&](int k) { return bounds.Origin(link)[k] + bounds.Origin(other)[k]; };
  const double farthest =
      std::max(arm(between.s0).norm(), arm(between.s1).norm()) + between.interval * apart(1);
  const double second_derivative = apart(3) + turning[3] * farthest + 2 * turning[2] * apart(1) +
                                   turning[1] * apart(2) +
                                   (turning[3] + bounds.Rotation(other)[3]) * radius;
  return std::max(speed(between.s0), speed(between.s1)) + between.Bulge(second_derivative);
}

}  // namespace possibility::actions
