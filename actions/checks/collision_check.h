#pragma once

#include <vector>

#include "actions/evidence/derivative_bounds.h"
#include "actions/evidence/verifier_state.h"
#include "actions/evidence/violation_log.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Close pairs at one instant, and the least distance of all other pairs.
struct CollisionSnapshot {
  std::vector<models::Proximity> environment;
  std::vector<models::Proximity> self;
  double environment_threshold = 0;  ///< m; unlisted pairs are at least this far apart
  double self_threshold = 0;
};

/// Exact collision queries at samples, and the proof that nothing touches between samples. One per
/// thread.
class CollisionVerifier {
 public:
  /// `link_radii`: StateEvaluator's. All must outlive the verifier.
  CollisionVerifier(const models::RobotModel& robot, const models::Environment& environment,
                    const std::vector<double>& link_radii);

  /// Reports overlaps at `state`. Searches as far around as the links may travel in `interval` (s),
  /// the time to the next sample.
  CollisionSnapshot Check(const VerifierState& state, double interval, const Instant& at,
                          ViolationLog* log);

  /// Whether some pair might overlap between two instants although it overlaps at neither: its
  /// distances are too small for its speed. `bounds`: over an interval that contains both instants.
  bool NeedsSubdivision(const VerifierState& s0, const CollisionSnapshot& c0,
                        const VerifierState& s1, const CollisionSnapshot& c1,
                        const DerivativeBounds& bounds) const;

 private:
  /// Tolerated penetration between a link and an obstacle, m.
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
