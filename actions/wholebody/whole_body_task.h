#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <optional>
#include <vector>

#include "actions/wholebody/signal.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Required pose of one limb's contact patch.
struct LimbTask {
  const models::GaitLimb* limb = nullptr;
  /// Patch centre, world, m.
  Signal<Eigen::Vector3d> position = ConstantVector<Eigen::Vector3d>(Eigen::Vector3d::Zero());
  /// Rz(yaw) Ry(pitch) Rx(roll) turns `orientation`; limbs that do not hold it ignore all four.
  ScalarSignal yaw;
  ScalarSignal pitch;
  ScalarSignal roll;
  Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();  ///< of the link if nothing turns it
};

/// Orientation of a link, in world axes.
struct LinkTurn {
  Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();
};

/// Rz(yaw) Ry(pitch) Rx(roll) over time.
LinkTurn TurnedBy(const ScalarSignal& yaw, const ScalarSignal& pitch,
                  const ScalarSignal& roll = Constant(0));

/// Task of the whole body at one instant. The unknowns are the joints of the limbs and, if there is
/// a task for the centre of mass, x and y of the root: as many as rows. The motion is therefore a
/// smooth function of the task, without memory.
struct WholeBodyTask {
  ScalarSignal root_yaw;
  ScalarSignal root_pitch;
  std::optional<LinkTurn> root_turn;  ///< in place of yaw and pitch
  ScalarSignal root_height;
  /// Used if there is no task for the centre of mass.
  Signal<Eigen::Vector2d> root_position = ConstantVector<Eigen::Vector2d>(Eigen::Vector2d::Zero());
  std::optional<Signal<Eigen::Vector2d>> centre_of_mass;  ///< x and y, world, m
  std::vector<LimbTask> limbs;
  Signal<Eigen::VectorXd> joints;  ///< all joints; the tasks of limbs override theirs
};

struct WholeBodyState {
  Eigen::VectorXd q;
  Eigen::VectorXd v;
  Eigen::VectorXd a;
};

/// A guess of q `time` (s) later, of second order. The root's orientation stays: tasks give it.
Eigen::VectorXd GuessAfter(const WholeBodyState& state, double time);

/// Solves tasks by Newton's method and differentiates the solution exactly in time. One instance
/// per thread.
class WholeBodySolver {
 public:
  explicit WholeBodySolver(const models::RobotModel& robot);

  /// `guess`: initial q (nq). Leaves the kinematics at the solution.
  /// @throws MotionError if Newton's method does not converge.
  WholeBodyState Solve(const WholeBodyTask& task, const Eigen::VectorXd& guess);

  dynamics::TreeKinematics& kinematics() { return kinematics_; }

 private:
  void SetKnownCoordinates(const WholeBodyTask& task, Eigen::VectorXd* q) const;
  void SelectUnknowns(const WholeBodyTask& task);
  void Residual(const WholeBodyTask& task);
  void Jacobian(const WholeBodyTask& task);
  static LinkTurn Turn(const WholeBodyTask& task);
  void KnownRates(const WholeBodyTask& task, WholeBodyState* state) const;
  void SolveRates(const WholeBodyTask& task, WholeBodyState* state);

  dynamics::TreeKinematics kinematics_;
  std::vector<int> unknowns_;  ///< indices into v
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;                     ///< rows x nv
  Eigen::MatrixXd reduced_;                      ///< rows x unknowns
  Eigen::PartialPivLU<Eigen::MatrixXd> factor_;  ///< of reduced_
  Eigen::MatrixXd frame_;                        ///< scratch, 6 x nv
};

}  // namespace possibility::actions
