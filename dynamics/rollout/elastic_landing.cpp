#include "dynamics/rollout/elastic_landing.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace possibility::dynamics {

namespace {

using Eigen::VectorXd;

void Check(const MultibodyModel& model, const Eigen::Ref<const VectorXd>& posture,
           const ElasticLandingSettings& settings) {
  const auto fail = [](const std::string& what) {
    throw std::invalid_argument("LandElastically: " + what);
  };
  if (posture.size() != model.num_joints() || !posture.allFinite()) {
    fail(fmt::format("the posture is not {} finite numbers", model.num_joints()));
  }
  if (!(settings.time_limit > 0) || !std::isfinite(settings.time_limit)) {
    fail(fmt::format("the time limit is {} s, expected a positive number", settings.time_limit));
  }
  if (!(settings.rest_energy > 0)) {
    fail(fmt::format("rest_energy is {} J, expected a positive number", settings.rest_energy));
  }
}

/// The most loaded joint, in words; empty if no joint reaches its limit.
std::string Saturation(const MultibodyModel& model, const VectorXd& utilisation) {
  Eigen::Index joint = -1;
  if (utilisation.size() == 0 || utilisation.maxCoeff(&joint) < 1) return "";
  return fmt::format("; joint '{}' reached its effort limit",
                     model.tree().joints[model.joints()[joint]].name);
}

}  // namespace

ElasticGains GainsOfFrequency(const std::shared_ptr<const MultibodyModel>& model,
                              const Eigen::Ref<const VectorXd>& q, double frequency,
                              double damping_ratio) {
  if (!(frequency >= 0) || !(damping_ratio >= 0) || !std::isfinite(frequency * damping_ratio)) {
    throw std::invalid_argument("GainsOfFrequency: frequency and damping ratio must be >= 0");
  }
  MultibodyDynamics dynamics(model);
  dynamics.SetState(q, VectorXd::Zero(model->nv()));
  const VectorXd inertia = dynamics.MassMatrix().diagonal().tail(model->num_joints());
  return {inertia * frequency * frequency, inertia * (2 * damping_ratio * frequency)};
}

ElasticLandingOutcome LandElastically(const std::shared_ptr<const MultibodyModel>& model,
                                      const std::vector<RolloutContact>& contacts,
                                      const Eigen::Ref<const VectorXd>& q,
                                      const Eigen::Ref<const VectorXd>& v,
                                      const Eigen::Ref<const VectorXd>& posture,
                                      const ElasticLandingSettings& settings) {
  if (!model) throw std::invalid_argument("LandElastically: no model");
  Check(*model, posture, settings);
  JointControl control;
  control.command = [target = VectorXd(posture)](double, JointCommand* command) {
    command->position = target;
  };
  control.stiffness = settings.stiffness;
  control.damping = settings.damping;
  control.compensates_gravity = true;
  for (const RolloutContact& contact : contacts) control.gravity_support.push_back(contact.point);
  RobotRolloutSettings rollout = settings.rollout;
  rollout.rest_energy = settings.rest_energy;
  rollout.rest_time = settings.rest_time;
  rollout.hybrid.end_at_zeno = true;

  RobotSimulator simulator(model, contacts, std::move(control), rollout);
  ElasticLandingOutcome outcome;
  outcome.rollout = simulator.Run(q, v, 0, settings.time_limit);
  outcome.time = outcome.rollout.time;
  outcome.is_at_rest = outcome.rollout.end == RobotRolloutEnd::kAtRest;
  outcome.reason = outcome.rollout.reason;
  if (outcome.rollout.end == RobotRolloutEnd::kTime) {
    outcome.reason = fmt::format("not at rest within {:.3g} s", settings.time_limit);
  }
  if (!outcome.is_at_rest) outcome.reason += Saturation(*model, outcome.rollout.torque_utilisation);
  return outcome;
}

}  // namespace possibility::dynamics
