#pragma once

#include <functional>
#include <string>

#include "actions/plan/plan.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_model.h"

namespace possibility::experiments {

/// The robot's state at one instant, and its phase.
struct PlanSample {
  int segment = 0;
  const actions::Phase* phase = nullptr;  ///< of the sampled plan
  actions::Knot knot;
};

using VisitSample = std::function<void(const PlanSample&)>;

/// Visits every knot of every phase; two where phases meet, because tau and forces may jump.
void VisitKnots(const actions::Plan& plan, const VisitSample& visit);

/// Visits samples `step` s apart from the beginning, and the end. Where two phases meet: the later
/// one.
/// @throws InputError for more than 1e8 samples.
void VisitEvery(const actions::Plan& plan, double step, const VisitSample& visit);

/// One row per sample: t, segment, action, q, v, a, tau, each component in its own column
/// (docs/command_line.md). Numbers read back exactly.
class TrajectoryTable {
 public:
  /// Both must outlive the table.
  TrajectoryTable(const actions::Plan& plan, const models::RobotModel& robot)
      : plan_(plan), robot_(robot) {}

  std::string Header() const;
  std::string Rows(const PlanSample& sample) const;

 private:
  const actions::Plan& plan_;
  const models::RobotModel& robot_;
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

}  // namespace possibility::experiments
