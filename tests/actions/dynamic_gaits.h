#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "actions/gait/dynamic_gait.h"
#include "actions/gait/pace_library.h"
#include "actions/gait/stride.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {

/// A gait of a robot that flows, with its stance.
class FlowingGait {
 public:
  /// With the paces that are shipped with the robot, or fitted if there are none.
  FlowingGait(const models::RobotModel& robot, const std::string& name)
      : stance_(SolveNominalStance(robot, robot.GaitNamed(name))),
        motion_(robot, stance_, Paces(robot)) {}
  FlowingGait(const FlowingGait&) = delete;

  const NominalStance& stance() const { return stance_; }
  const models::GaitParameters& parameters() const { return stance_.gait->parameters; }
  const DynamicGait& motion() const { return motion_; }

 private:
  std::vector<Pace> Paces(const models::RobotModel& robot) const {
    const auto shipped = PaceLibrary(robot, DrcHubo1Library()).Find(*stance_.gait);
    return shipped ? *shipped : DynamicGait(robot, stance_).paces();
  }

  NominalStance stance_;
  DynamicGait motion_;
};

/// Made once per test program.
inline const FlowingGait& DrcHubo1Flowing(const std::string& name) {
  static std::map<std::string, std::unique_ptr<FlowingGait>> gaits;
  std::unique_ptr<FlowingGait>& gait = gaits[name];
  if (!gait) gait = std::make_unique<FlowingGait>(DrcHubo1(), name);
  return *gait;
}

/// The stances of a gait's strides through `stances`.
inline std::vector<PlanarPose> StridesThrough(const models::GaitParameters& parameters,
                                              const std::vector<PlanarPose>& stances) {
  std::vector<PlanarPose> strides = {stances.front()};
  for (const PlanarPose& stance : stances) {
    const std::vector<PlanarPose> line = PlanStrides(parameters, strides.back(), stance);
    strides.insert(strides.end(), line.begin() + 1, line.end());
  }
  return strides;
}

/// DRC-HUBO1's walk along one straight way from the stance at the origin.
inline Plan WalkTo(const PlanarPose& end, const models::Scenario& scenario) {
  const FlowingGait& gait = DrcHubo1Flowing("walk");
  Plan plan;
  plan.robot_hash = DrcHubo1().content_hash;
  plan.scenario_hash = scenario.content_hash;
  for (const models::Joint& joint : DrcHubo1().joints) plan.joints.push_back(joint.name);
  constexpr double kKnotSpacing = 0.1;  // s
  plan.segments.push_back(
      {"walk",
       gait.motion().Motion(StridesThrough(gait.parameters(), {{}, end}), kKnotSpacing, {})});
  return plan;
}

}  // namespace possibility::actions
