#include "actions/verifier_collision.h"

#include <fmt/format.h>

#include <algorithm>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using models::Proximity;

constexpr double kTolerance = 1e-4;        // m, the checker's accuracy
constexpr double kGroundTolerance = 1e-3;  // m, of links that bear, against ground
/// m/s: how much faster than at both ends of an interval a link may be inside it. Holds while
/// jerks stay below 8 kSpeedAllowance / interval^2, 3200 m/s^3 at 5 ms.
constexpr double kSpeedAllowance = 0.01;

double DistanceIn(const std::vector<Proximity>& proximities, const Proximity& pair,
                  double threshold) {
  double distance = threshold;
  for (const Proximity& p : proximities) {
    if (p.link == pair.link && p.other == pair.other) distance = std::min(distance, p.distance);
  }
  return distance;
}

/// Whether a pair at distances d0 and d1 at the ends of an interval, in which it approaches or
/// parts by at most `travel`, may come closer than -tolerance. Below half the tolerance of travel
/// there is nothing left to find, and a pair that overlaps at an end is reported already.
bool MayOverlap(double d0, double d1, double travel, double tolerance) {
  if (std::min(d0, d1) < -tolerance || travel < tolerance / 2) return false;
  return (d0 + d1 - travel) / 2 < -tolerance;
}

/// Whether pairs that are listed at neither end, for being farther apart than what the state there
/// suggested, may overlap after all: only if the robot speeds up much within the interval.
bool UnlistedMayOverlap(const VerifierState& s0, const CollisionSnapshot& c0,
                        const VerifierState& s1, const CollisionSnapshot& c1) {
  const double interval = s1.knot.t - s0.knot.t;
  const double speed = std::max(s0.max_speed, s1.max_speed);
  return MayOverlap(c0.environment_threshold, c1.environment_threshold,
                    (speed + kSpeedAllowance) * interval, kTolerance) ||
         MayOverlap(c0.self_threshold, c1.self_threshold, (2 * speed + kSpeedAllowance) * interval,
                    kTolerance);
}

}  // namespace

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
  const double travel = (1.1 * state.max_speed + 5 * kSpeedAllowance) * interval;
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
                                         const VerifierState& s1,
                                         const CollisionSnapshot& c1) const {
  const double interval = s1.knot.t - s0.knot.t;
  const auto environment_needs = [&](const Proximity& pair) {
    const double speed = std::max(EnvironmentSpeed(s0, pair.link), EnvironmentSpeed(s1, pair.link));
    return MayOverlap(DistanceIn(c0.environment, pair, c0.environment_threshold),
                      DistanceIn(c1.environment, pair, c1.environment_threshold),
                      (speed + kSpeedAllowance) * interval,
                      EnvironmentTolerance(pair.link, pair.other));
  };
  const auto self_needs = [&](const Proximity& pair) {
    const double speed =
        std::max(SelfSpeed(s0, pair.link, pair.other), SelfSpeed(s1, pair.link, pair.other));
    return MayOverlap(DistanceIn(c0.self, pair, c0.self_threshold),
                      DistanceIn(c1.self, pair, c1.self_threshold),
                      (speed + kSpeedAllowance) * interval, kTolerance);
  };
  const auto any = [](const auto& pairs, const auto& needs) {
    return std::any_of(pairs.begin(), pairs.end(), needs);
  };
  return UnlistedMayOverlap(s0, c0, s1, c1) || any(c0.environment, environment_needs) ||
         any(c1.environment, environment_needs) || any(c0.self, self_needs) ||
         any(c1.self, self_needs);
}

double CollisionVerifier::EnvironmentTolerance(int link, int obstacle) const {
  return carries_patch_[link] && environment_->obstacles[obstacle].is_ground ? kGroundTolerance
                                                                             : kTolerance;
}

double CollisionVerifier::EnvironmentSpeed(const VerifierState& state, int link) const {
  return state.v_WL[link].norm() + state.w_WL[link].norm() * (*link_radii_)[link];
}

/// Bound on the speed of any point of one link as seen from the other: the best of three.
double CollisionVerifier::SelfSpeed(const VerifierState& state, int link, int other) const {
  const auto seen_from = [&](int a, int b) {
    const Vector3d arm = state.X_WL[b].translation() - state.X_WL[a].translation();
    return (state.v_WL[b] - state.v_WL[a] - state.w_WL[a].cross(arm)).norm() +
           (state.w_WL[b] - state.w_WL[a]).norm() * (*link_radii_)[b];
  };
  return std::min({seen_from(link, other), seen_from(other, link),
                   EnvironmentSpeed(state, link) + EnvironmentSpeed(state, other)});
}

}  // namespace possibility::actions
