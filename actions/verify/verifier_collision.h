#pragma once

#include <vector>

#include "actions/verify/derivative_bounds.h"
#include "actions/verify/verifier_log.h"
#include "actions/verify/verifier_state.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Which pairs are close at one instant, and how far every other pair is at least.
struct CollisionSnapshot {
  std::vector<models::Proximity> environment;
  std::vector<models::Proximity> self;
  double environment_threshold = 0;  ///< m; pairs not listed are no closer
  double self_threshold = 0;
};

/// Exact collision queries at samples, and the proof that nothing touches between them. One per
/// thread.
class CollisionVerifier {
 public:
  /// `link_radii`: StateEvaluator's. All must outlive the verifier.
  CollisionVerifier(const models::RobotModel& robot, const models::Environment& environment,
                    const std::vector<double>& link_radii);

  /// Reports what overlaps at `state`; looks as far around as the links may travel in `interval`
  /// (s), the time to the next sample.
  CollisionSnapshot Check(const VerifierState& state, double interval, const Instant& at,
                          ViolationLog* log);

  /// Whether some pair might overlap between two instants at neither of which it does: its
  /// distances there are not large enough for how fast it moves. `bounds`: of a time that holds
  /// both.
  bool NeedsSubdivision(const VerifierState& s0, const CollisionSnapshot& c0,
                        const VerifierState& s1, const CollisionSnapshot& c1,
                        const DerivativeBounds& bounds) const;

 private:
  /// Penetration that is let pass between a link and an obstacle, m.
  double EnvironmentTolerance(int link, int obstacle) const;
  struct Between;
  double LinkSpeed(const Between& between, int link) const;
  double SelfSpeed(const Between& between, int link, int other) const;
  double SeenFrom(const Between& between, int link, int other) const;
  bool UnlistedMayOverlap(const Between& between, const CollisionSnapshot& c0,
                          const CollisionSnapshot& c1) const;

  const models::RobotModel* robot_;
  const models::Environment* environment_;
  const std::vector<double>* link_radii_;
  std::vector<bool> carries_patch_;  ///< by link
  models::CollisionChecker checker_;
};

}  // namespace possibility::actions
