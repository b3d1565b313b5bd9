#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "actions/plan.h"
#include "dynamics/tree_kinematics.h"
#include "experiments/viewer_packing.h"
#include "models/robot_model.h"

namespace possibility::experiments {

/// Knots of all phases behind one another, thinned out to what can be told from the whole motion by
/// eye (finer in segments in which the robot flies), with what there is to plot at each.
class MotionPacker {
 public:
  /// `robot` must outlive it.
  explicit MotionPacker(const models::RobotModel& robot) : robot_(robot), kinematics_(robot) {}

  /// What the page has to know of a segment besides its knots.
  /// @throws InputError if it names a contact that the robot does not have.
  nlohmann::ordered_json Add(const actions::Segment& segment);

  /// The tables of all knots added, members of the page's data.
  void WriteTo(nlohmann::ordered_json* data) const;

 private:
  nlohmann::ordered_json AddPhase(const actions::Phase& phase, bool is_dynamic);
  void AddKnot(const actions::Knot& knot);

  const models::RobotModel& robot_;
  dynamics::TreeKinematics kinematics_;
  int count_ = 0;
  std::vector<float> knots_;    ///< t, pose of the root
  QuantisedTable positions_;    ///< of the joints
  QuantisedTable forces_;       ///< a row for every point
  std::vector<float> centres_;  ///< of mass
  QuantisedTable momenta_;      ///< linear, angular about the centre of mass
  QuantisedTable rates_;        ///< of the joints
  QuantisedTable torques_;
};

}  // namespace possibility::experiments
