#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/route/route.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"
#include "common/cancellation_token.h"
#include "models/world/environment.h"

namespace possibility::actions {

/// Thrown by GenerateMotion: `leg` of the route cannot be turned into motion.
class LegError : public MotionError {
 public:
  LegError(int leg, const std::string& message) : MotionError(message), leg_(leg) {}
  int leg() const { return leg_; }

 private:
  int leg_;
};

/// Motion of one leg, from rest to rest; times start at 0. A motion that is too fast for the limits
/// is stretched. A manoeuvre provides its own motion; it must have knots of the robot's sizes and
/// begin and end at rest in the leg's stances.
/// @throws MotionError if stretching does not help, or if a manoeuvre throws or returns a motion
/// that does not fit; Cancelled.
std::vector<Phase> GenerateLeg(const LocomotionModel& model, const RouteLeg& leg,
                               const CancellationToken& cancellation = {});

/// Motion of a whole route, with its legs distributed over `threads`; the result does not depend on
/// their number. A motion that flows through several legs is taken only if it hits nothing in
/// `environment`: the swept volumes of C_S are those of single legs. `cancellation`: asked
/// regularly, from any thread. `progress` (may be empty): called as often, from any thread, with
/// the fraction done.
/// @throws LegError for the first leg that fails; Cancelled.
std::vector<Segment> GenerateMotion(const LocomotionModel& model,
                                    const models::Environment& environment, const Route& route,
                                    int threads, const CancellationToken& cancellation = {},
                                    const std::function<void(double)>& progress = {});

}  // namespace possibility::actions
