#pragma once

#include <optional>
#include <string>

#include "actions/plan/plan.h"
#include "actions/planner/planner.h"
#include "actions/planner/planner_memory.h"
#include "models/robot/robot_model.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// What a replanning took over from the plans before it.
struct Reuse {
  bool plan = false;   ///< the last plan still verifies, and is the answer
  bool model = false;  ///< the robot's locomotion was there
};

/// Plans one scenario again and again while it changes. The last plan is tried first: if it
/// verifies in the new world, it is the answer, even where the change has opened a quicker way.
/// Otherwise planning starts anew, with the robot's locomotion at hand. Verdicts on parts of plans
/// are kept where the world about them is the same (VerdictStore). Robots of one content hash must
/// be equal.
class Replanner {
 public:
  /// PlanTraversal for this version. Timings are those of this call.
  /// @throws as PlanTraversal; what is kept stays.
  PlanResult Plan(const models::RobotModel& robot, const models::Scenario& scenario,
                  PlanRequest request);

  /// Of the last call.
  const Reuse& reuse() const { return reuse_; }

 private:
  std::optional<PlanResult> LastPlanIn(const models::RobotModel& robot,
                                       const models::Scenario& scenario,
                                       const PlanRequest& request);

  PlannerMemory memory_;
  std::optional<actions::Plan> last_;  ///< found and verified
  std::string last_robot_;             ///< content hash of the robot last planned for
  Reuse reuse_;
};

}  // namespace possibility::actions
