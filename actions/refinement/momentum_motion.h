#pragma once

#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/plan/plan.h"
#include "actions/refinement/root_offset.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Moves the root of a phase so that what its contacts cannot supply is not needed: in flight all
/// of momentum is conserved but for gravity, on a line of points the angular momentum about that
/// line changes as gravity has it. The joints move as planned. One per thread.
class MomentumMotion {
 public:
  /// `robot` must outlive it.
  explicit MomentumMotion(const models::RobotModel& robot);

  /// Whether a phase needs it: its contacts cannot supply every wrench at its first knot.
  bool IsNeeded(const Phase& phase);

  /// Replaces the phase's knots, beginning with `offset`; inserts knots where the quintics between
  /// them would leave more than 2e-7 of the weight (N; N m over 1 m). Their forces are interpolated
  /// linearly, tau is not set.
  void Follow(const RootOffset& offset, Phase* phase);

 private:
  struct Course;

  Vector6d Acceleration(const Knot& plan, const RootOffset& offset);
  void Integrate(const Course& course, const RootOffset& begin, std::vector<RootOffset>* offsets);
  bool IsExact(const Knot& k0, const Knot& k1);
  bool AddKnots(const Course& course, const std::vector<RootOffset>& offsets,
                std::vector<Knot>* knots);
  RootOffset FollowCourse(const Course& course, const RootOffset& begin, int halvings,
                          std::vector<Knot>* knots);

  const models::RobotModel& robot_;
  StateEvaluator evaluator_;
  std::vector<BearingPoint> points_;  ///< of the current phase
  bool is_hopeless_ = false;          ///< some of the phase cannot be made exact
};

}  // namespace possibility::actions
