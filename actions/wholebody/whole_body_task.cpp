#include "actions/wholebody/whole_body_task.h"

#include <cmath>

#include "actions/wholebody/motion_error.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kMaximumIterations = 30;
constexpr double kConverged = 1e-12;
constexpr double kLargestStep = 0.3;
/// While a step leaves less than this share of the residual, the next one uses the same Jacobian
/// (Shamanskii 1967).
constexpr double kGoodStep = 1e-3;

LinkTurn TurnOf(const LimbTask& limb) { return TurnedBy(limb.yaw, limb.pitch, limb.roll); }

int RowCount(const WholeBodyTask& task) {
  int rows = task.centre_of_mass ? 2 : 0;
  for (const LimbTask& limb : task.limbs) rows += limb.limb->hold_orientation ? 6 : 3;
  return rows;
}

}  // namespace

LinkTurn TurnedBy(const ScalarSignal& yaw, const ScalarSignal& pitch, const ScalarSignal& roll) {
  const Vector3d z = Vector3d::UnitZ();
  const Matrix3d turned = Eigen::AngleAxisd(yaw.value, z).toRotationMatrix();
  const Vector3d y = turned.col(1);
  LinkTurn turn;
  turn.orientation = turned * Eigen::AngleAxisd(pitch.value, Vector3d::UnitY()).toRotationMatrix();
  const Vector3d x = turn.orientation.col(0);
  turn.orientation *= Eigen::AngleAxisd(roll.value, Vector3d::UnitX()).toRotationMatrix();
  const Vector3d before_roll = yaw.rate * z + pitch.rate * y;
  turn.angular_velocity = before_roll + roll.rate * x;
  turn.angular_acceleration = yaw.acceleration * z + pitch.acceleration * y +
                              roll.acceleration * x + yaw.rate * pitch.rate * z.cross(y) +
                              roll.rate * before_roll.cross(x);
  return turn;
}

VectorXd GuessAfter(const WholeBodyState& state, double time) {
  VectorXd q = state.q;
  const Eigen::Index n = state.v.size() - 3;
  q.tail(n) += time * state.v.tail(n) + time * time / 2 * state.a.tail(n);
  return q;
}

WholeBodySolver::WholeBodySolver(const models::RobotModel& robot) : kinematics_(robot) {}

WholeBodyState WholeBodySolver::Solve(const WholeBodyTask& task, const VectorXd& guess) {
  WholeBodyState state;
  state.q = guess;
  SelectUnknowns(task);
  SetKnownCoordinates(task, &state.q);
  double error_before = 0;
  for (int iteration = 0;; ++iteration) {
    kinematics_.SetPosition(state.q);
    Residual(task);
    if (residual_.size() == 0) break;
    const double error = residual_.lpNorm<Eigen::Infinity>();
    if (error < kConverged) break;
    if (iteration == kMaximumIterations || !residual_.allFinite()) {
      throw MotionError("whole-body inverse kinematics does not converge (out of reach?)");
    }
    if (iteration == 0 || error > kGoodStep * error_before) Jacobian(task);
    error_before = error;
    VectorXd step = factor_.solve(residual_);
    const double largest = step.lpNorm<Eigen::Infinity>();
    if (largest > kLargestStep) step *= kLargestStep / largest;
    for (size_t i = 0; i < unknowns_.size(); ++i) {
      // q has one more entry than v (the quaternion), and the root's rotation is never unknown.
      state.q[unknowns_[i] + 1] += step[static_cast<int>(i)];
    }
  }
  Jacobian(task);
  SolveRates(task, &state);
  return state;
}

void WholeBodySolver::SetKnownCoordinates(const WholeBodyTask& task, VectorXd* q) const {
  const Eigen::Quaterniond orientation(Turn(task).orientation);
  q->head<4>() << orientation.w(), orientation.x(), orientation.y(), orientation.z();
  (*q)[6] = task.root_height.value;
  if (!task.centre_of_mass) q->segment<2>(4) = task.root_position.value;
  VectorXd joints = task.joints.value;
  for (const LimbTask& limb : task.limbs) {
    for (int joint : limb.limb->joints) joints[joint] = (*q)[7 + joint];
  }
  q->tail(joints.size()) = joints;
}

void WholeBodySolver::SelectUnknowns(const WholeBodyTask& task) {
  unknowns_.clear();
  if (task.centre_of_mass) unknowns_ = {3, 4};
  for (const LimbTask& limb : task.limbs) {
    for (int joint : limb.limb->joints) unknowns_.push_back(6 + joint);
  }
  const int rows = RowCount(task);
  if (rows != static_cast<int>(unknowns_.size())) {
    throw MotionError("a limb must have as many joints as rows (6 with orientation, else 3)");
  }
  residual_.resize(rows);
  jacobian_.resize(rows, kinematics_.model().nv());
  reduced_.resize(rows, rows);
}

void WholeBodySolver::Residual(const WholeBodyTask& task) {
  const models::RobotModel& robot = kinematics_.model();
  int row = 0;
  if (task.centre_of_mass) {
    residual_.head<2>() = task.centre_of_mass->value - kinematics_.CentreOfMass().head<2>();
    row = 2;
  }
  for (const LimbTask& limb : task.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.limb->contact];
    if (limb.limb->hold_orientation) {
      const Matrix3d target = TurnOf(limb).orientation * limb.orientation;
      residual_.segment<3>(row) =
          models::RotationVector(target * kinematics_.X_WL()[patch.link].linear().transpose());
      row += 3;
    }
    residual_.segment<3>(row) =
        limb.position.value - kinematics_.Position(patch.link, patch.Centre());
    row += 3;
  }
}

void WholeBodySolver::Jacobian(const WholeBodyTask& task) {
  const models::RobotModel& robot = kinematics_.model();
  int row = 0;
  if (task.centre_of_mass) {
    kinematics_.CentreOfMassJacobian(&frame_);
    jacobian_.topRows<2>() = frame_.topRows<2>();
    row = 2;
  }
  for (const LimbTask& limb : task.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.limb->contact];
    kinematics_.FrameJacobian(patch.link, patch.Centre(), &frame_);
    const int count = limb.limb->hold_orientation ? 6 : 3;
    jacobian_.middleRows(row, count) = frame_.bottomRows(count);
    row += count;
  }
  for (size_t i = 0; i < unknowns_.size(); ++i) {
    reduced_.col(static_cast<int>(i)) = jacobian_.col(unknowns_[i]);
  }
  if (!unknowns_.empty()) factor_.compute(reduced_);
}

LinkTurn WholeBodySolver::Turn(const WholeBodyTask& task) {
  return task.root_turn ? *task.root_turn : TurnedBy(task.root_yaw, task.root_pitch);
}

void WholeBodySolver::KnownRates(const WholeBodyTask& task, WholeBodyState* state) const {
  const int nv = kinematics_.model().nv();
  state->v.setZero(nv);
  state->a.setZero(nv);
  const LinkTurn turn = Turn(task);
  state->v.head<3>() = turn.angular_velocity;
  state->a.head<3>() = turn.angular_acceleration;
  state->v[5] = task.root_height.rate;
  state->a[5] = task.root_height.acceleration;
  if (!task.centre_of_mass) {
    state->v.segment<2>(3) = task.root_position.rate;
    state->a.segment<2>(3) = task.root_position.acceleration;
  }
  state->v.tail(nv - 6) = task.joints.rate;
  state->a.tail(nv - 6) = task.joints.acceleration;
  for (int unknown : unknowns_) {
    state->v[unknown] = 0;
    state->a[unknown] = 0;
  }
}

void WholeBodySolver::SolveRates(const WholeBodyTask& task, WholeBodyState* state) {
  KnownRates(task, state);
  const models::RobotModel& robot = kinematics_.model();
  const int rows = static_cast<int>(residual_.size());
  const auto add_unknowns = [&](const VectorXd& right, VectorXd* known) {
    if (rows == 0) return;
    const VectorXd solution = factor_.solve(right - jacobian_ * *known);
    for (size_t i = 0; i < unknowns_.size(); ++i) {
      (*known)[unknowns_[i]] = solution[static_cast<int>(i)];
    }
  };

  VectorXd rate(rows), acceleration(rows);
  int row = 0;
  if (task.centre_of_mass) {
    rate.head<2>() = task.centre_of_mass->rate;
    acceleration.head<2>() = task.centre_of_mass->acceleration;
    row = 2;
  }
  for (const LimbTask& limb : task.limbs) {
    if (limb.limb->hold_orientation) {
      const LinkTurn turn = TurnOf(limb);
      rate.segment<3>(row) = turn.angular_velocity;
      acceleration.segment<3>(row) = turn.angular_acceleration;
      row += 3;
    }
    rate.segment<3>(row) = limb.position.rate;
    acceleration.segment<3>(row) = limb.position.acceleration;
    row += 3;
  }
  add_unknowns(rate, &state->v);
  kinematics_.SetVelocity(state->v);
  row = 0;
  if (task.centre_of_mass) {
    acceleration.head<2>() -= kinematics_.CentreOfMassBias().head<2>();
    row = 2;
  }
  for (const LimbTask& limb : task.limbs) {
    const models::ContactPatch& patch = robot.contacts[limb.limb->contact];
    const int count = limb.limb->hold_orientation ? 6 : 3;
    acceleration.segment(row, count) -=
        kinematics_.FrameBias(patch.link, patch.Centre()).tail(count);
    row += count;
  }
  add_unknowns(acceleration, &state->a);
}

}  // namespace possibility::actions
