#pragma once

#include <vector>

#include "actions/plan/contact_name.h"
#include "actions/plan/plan.h"
#include "dynamics/tree/tree_kinematics.h"
#include "experiments/viewer/viewer_margins.h"
#include "experiments/viewer/viewer_packing.h"
#include "models/input/json_text.h"
#include "models/robot/robot_model.h"
#include "models/world/environment.h"

namespace possibility::experiments {

/// Knots of all phases in sequence, thinned out to video rate (finer in segments with flight), with
/// the plotted quantities at each.
class MotionPacker {
 public:
  /// Both must outlive it. @throws InputError as FrameMargins does.
  MotionPacker(const models::RobotModel& robot, const models::Environment& environment)
      : robot_(robot), kinematics_(robot), margins_(robot, environment) {}

  /// Adds a segment. Returns the page's data of it besides its knots.
  /// @throws InputError if it names a contact that the robot does not have.
  nlohmann::ordered_json Add(const actions::Segment& segment);

  /// Adds the tables of all knots to the page's data.
  void WriteTo(nlohmann::ordered_json* data) const;

 private:
  nlohmann::ordered_json AddPhase(const actions::Phase& phase, bool is_dynamic);
  void AddKnots(const actions::Phase& phase, const std::vector<std::size_t>& frames);
  /// t, q, centre of mass, linear and angular momentum about it, joint rates, torques, BalanceState
  /// to 0.01 mm so that strides repeat, margins, forces.
  std::vector<float> Drawn(const actions::Knot& knot, const FrameMargins::Numbers& margins);

  const models::RobotModel& robot_;
  dynamics::TreeKinematics kinematics_;
  FrameMargins margins_;
  std::vector<actions::BearingPatch> bearing_;  ///< of the present phase
  CourseTable courses_;
  std::vector<std::int32_t> indices_;  ///< of the phases' courses, in the order of Drawn
};

}  // namespace possibility::experiments
