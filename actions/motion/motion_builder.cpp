#include "actions/motion/motion_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace possibility::actions {

std::shared_ptr<const dynamics::MultibodyModel> UncoupledModel(models::RobotModel robot) {
  for (models::Joint& joint : robot.joints) joint.mimic.reset();
  return dynamics::MultibodyModel::Spatial(robot);
}

void RequireJointLimits(const models::RobotModel& robot, const Eigen::VectorXd& q,
                        const Eigen::VectorXd& v, double speed_margin, double t) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const double position = q[7 + j];
    if (position < joint.lower || position > joint.upper) {
      throw MotionError(
          fmt::format("{} at {:.4f} leaves its limits {:.4f} to {:.4f} at {:.2f} s of a phase",
                      joint.name, position, joint.lower, joint.upper, t));
    }
    const double rate = v[6 + j];
    if (std::abs(rate) > speed_margin * joint.velocity) {
      throw MotionError(fmt::format("{} at {:.3f}/s is faster than {:.3f}/s at {:.2f} s of a phase",
                                    joint.name, rate, speed_margin * joint.velocity, t));
    }
  }
}

MotionBuilder::MotionBuilder(const models::RobotModel& robot, const MotionSettings& settings)
    : robot_(&robot), settings_(settings), solver_(robot), dynamics_(UncoupledModel(robot)) {}

std::vector<Phase> MotionBuilder::Build(const std::vector<MotionPhase>& phases,
                                        const Eigen::VectorXd& guess,
                                        const CancellationToken& cancellation) {
  std::vector<Phase> result;
  Eigen::VectorXd q = guess;
  double start = 0;
  for (const MotionPhase& phase : phases) {
    cancellation.ThrowIfCancelled();
    try {
      result.push_back(BuildPhase(phase, start, &q));
    } catch (const MotionError& error) {
      throw MotionError(error.what(), static_cast<int>(result.size()));
    }
    start += phase.duration;
  }
  return result;
}

Phase MotionBuilder::BuildPhase(const MotionPhase& phase, double start, Eigen::VectorXd* guess) {
  Phase result;
  std::vector<dynamics::ContactPoint> points;
  for (int contact : phase.contacts) {
    const models::ContactPatch& patch = robot_->contacts[contact];
    result.contacts.push_back(patch.name);
    for (const Eigen::Vector3d& p : patch.points) points.push_back({patch.link, p});
  }
  const int intervals =
      std::max(settings_.minimum_intervals,
               static_cast<int>(std::ceil(phase.duration / settings_.knot_spacing - 1e-9)));
  for (int i = 0; i <= intervals; ++i) {
    Knot knot = MakeKnot(phase, points, phase.duration * i / intervals, guess);
    knot.t += start;
    result.knots.push_back(std::move(knot));
  }
  return result;
}

Knot MotionBuilder::MakeKnot(const MotionPhase& phase,
                             const std::vector<dynamics::ContactPoint>& points, double t,
                             Eigen::VectorXd* guess) {
  const WholeBodyState state = solver_.Solve(phase.task(t), *guess);
  *guess = state.q;
  RequireJointLimits(*robot_, state.q, state.v, settings_.speed_margin, t);
  dynamics::ContactForceSettings force_settings;
  force_settings.friction = robot_->friction;
  force_settings.friction_margin = settings_.friction_margin;
  force_settings.normal_reserve =
      settings_.normal_reserve * robot_->TotalMass() * dynamics::kGravity;
  force_settings.torque_margin = settings_.torque_margin;
  dynamics_.SetState(state.q, state.v, state.a);
  const std::optional<dynamics::ContactForces> forces =
      dynamics::DistributeContactForces(&dynamics_, points, force_settings);
  if (!forces) {
    throw MotionError(fmt::format(
        "no contact forces within friction cones and torque limits realise the motion at {:.2f} s "
        "of a phase",
        t));
  }
  CheckCoupledTorques(forces->torques, t);
  Knot knot;
  knot.t = t;
  knot.q = state.q;
  knot.v = state.v;
  knot.a = state.a;
  knot.tau = forces->torques;
  knot.forces = forces->forces;
  return knot;
}

void MotionBuilder::CheckCoupledTorques(const Eigen::VectorXd& torques, double t) const {
  Eigen::VectorXd borne = torques;
  for (int j = 0; j < robot_->num_joints(); ++j) {
    const auto& mimic = robot_->joints[j].mimic;
    if (mimic) borne[mimic->joint] += mimic->multiplier * torques[j];
  }
  for (int j = 0; j < robot_->num_joints(); ++j) {
    const models::Joint& joint = robot_->joints[j];
    if (joint.mimic || std::abs(borne[j]) <= settings_.torque_margin * joint.effort) continue;
    throw MotionError(
        fmt::format("{} and its mimics need {:.1f}, more than {:.1f}, at {:.2f} s of a phase",
                    joint.name, borne[j], settings_.torque_margin * joint.effort, t));
  }
}

std::vector<Phase> Reversed(const std::vector<Phase>& phases) {
  std::vector<Phase> result(phases.rbegin(), phases.rend());
  if (result.empty()) return result;
  const double end = phases.back().knots.back().t;
  for (Phase& phase : result) {
    std::reverse(phase.knots.begin(), phase.knots.end());
    for (Knot& knot : phase.knots) {
      knot.t = end - knot.t;
      knot.v = -knot.v;
    }
  }
  return result;
}

}  // namespace possibility::actions
