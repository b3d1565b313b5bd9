#pragma once

#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "actions/verify/plan_margins.h"
#include "dynamics/tree/tree_kinematics.h"
#include "experiments/samples/plan_samples.h"
#include "experiments/samples/quantities.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// A field of a CSV file, quoted if necessary (RFC 4180).
std::string CsvField(const std::string& text);

/// One row per sample: t, segment, action, q, v, a, tau, each component in its own column, then 1
/// or 0 for every contact point that bears or not (docs/exports.md). Numbers read back
/// exactly.
class TrajectoryTable {
 public:
  /// Both must outlive the table.
  TrajectoryTable(const actions::Plan& plan, const models::RobotModel& robot);

  std::string Header() const;
  /// @throws InputError if a contact is not the robot's.
  std::string Rows(const PlanSample& sample) const;

 private:
  const actions::Plan& plan_;
  const models::RobotModel& robot_;
  std::vector<actions::BearingPoint> points_;
};

/// One row per sample and bearing contact point: t, segment, patch, point, its position x, y, z
/// (m, world) and the force on the robot fx, fy, fz (N, world).
class ContactForceTable {
 public:
  /// Both must outlive the table.
  ContactForceTable(const actions::Plan& plan, const models::RobotModel& robot)
      : plan_(plan), robot_(robot), kinematics_(robot) {}

  std::string Header() const;
  /// @throws InputError if a contact is not the robot's.
  std::string Rows(const PlanSample& sample);

 private:
  const actions::Plan& plan_;
  const models::RobotModel& robot_;
  dynamics::TreeKinematics kinematics_;
};

/// One row per sample: t and the margins (PlanMargins). A field is empty where there is nothing to
/// measure.
class MarginTable {
 public:
  static std::string Header();
  static std::string Row(double t, const actions::PlanMargins& margins);
};

/// One row per column of the tables that carries a unit: table, column, unit.
std::string UnitTable(const models::RobotModel& robot);

/// One row per joint: joint, stiffness, damping, effort, speed and the units of the first two.
std::string GainTable(const models::RobotModel& robot);

}  // namespace possibility::experiments
