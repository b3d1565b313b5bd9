#include "actions/evidence/verifier_state.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/plan/contact_name.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

double FarthestCorner(const Eigen::AlignedBox3d& box) {
  return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
}

}  // namespace

std::vector<BearingPoint> BearingPoints(const models::RobotModel& robot, const Phase& phase) {
  std::vector<BearingPoint> points;
  for (const BearingPatch& bearing : BearingPatches(robot, phase)) {
    const models::ContactPatch& contact = robot.contacts[bearing.patch];
    for (const int i : bearing.points) {
      points.push_back({bearing.patch, i, contact.link, contact.points[i]});
    }
  }
  return points;
}

std::string NameOf(const models::RobotModel& robot, const BearingPoint& point) {
  return fmt::format("{} point {}", robot.contacts[point.patch].name, point.index);
}

StateEvaluator::StateEvaluator(const models::RobotModel& robot) : robot_(&robot), dynamics_(robot) {
  for (const models::Link& link : robot.links) {
    double radius = 0;
    for (const models::PosedShape& posed : link.shapes) {
      radius = std::max(radius, FarthestCorner(posed.shape.Bounds(posed.X_PS)));
    }
    link_radii_.push_back(radius);
  }
}

VerifierState StateEvaluator::Evaluate(Knot knot) {
  VerifierState state;
  state.knot = std::move(knot);
  dynamics_.SetState(state.knot.q, state.knot.v);
  state.X_WL.reserve(robot_->num_links());
  for (int link = 0; link < robot_->num_links(); ++link) {
    state.X_WL.push_back(dynamics_.LinkPose(link));
  }
  PropagateVelocities(&state);
  return state;
}

void StateEvaluator::PropagateVelocities(VerifierState* state) const {
  const int n = robot_->num_links();
  state->w_WL.resize(n);
  state->v_WL.resize(n);
  state->w_WL[0] = state->knot.v.head<3>();
  state->v_WL[0] = state->knot.v.segment<3>(3);
  for (int link = 1; link < n; ++link) {
    const models::Joint& joint = robot_->joints[link - 1];
    const double rate = state->knot.v[5 + link];
    const Vector3d axis = state->X_WL[link].linear() * joint.axis;
    const Vector3d arm = state->X_WL[link].translation() - state->X_WL[joint.parent].translation();
    state->w_WL[link] = state->w_WL[joint.parent];
    state->v_WL[link] = state->v_WL[joint.parent] + state->w_WL[joint.parent].cross(arm);
    if (joint.type == models::JointType::kPrismatic) {
      state->v_WL[link] += rate * axis;
    } else {
      state->w_WL[link] += rate * axis;
    }
  }
  for (int link = 0; link < n; ++link) {
    state->max_speed = std::max(
        state->max_speed, state->v_WL[link].norm() + state->w_WL[link].norm() * link_radii_[link]);
  }
}

}  // namespace possibility::actions
