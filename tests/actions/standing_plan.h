#pragma once

#include <string>

#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "tests/actions/plan_mutations.h"

namespace possibility::actions::testing {

inline models::Scenario FlatScenario() {
  models::Scenario scenario;
  scenario.name = "flat";
  scenario.content_hash = "flat scenario";
  models::Obstacle floor;
  floor.name = "floor";
  floor.shape = models::Shape::Box({4, 4, 0.1});
  floor.X_WO.translation().z() = -0.05;
  floor.is_ground = true;
  scenario.environment.obstacles = {floor};
  scenario.environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-2, -2), Eigen::Vector2d(2, 2));
  scenario.actions = {"walk"};
  scenario.start = {"walk", 0, 0, 0, 0};
  scenario.goals = {scenario.start};
  return scenario;
}

/// Rest-to-rest motion of the pelvis by (x, y, z) away from the nominal stance, or back to it. The
/// first foot stands `stride` (m) before its place, the others as far behind theirs.
inline MotionPhase PelvisShift(const NominalStance& stance, const Eigen::Vector3d& shift, bool back,
                               double duration, double stride = 0) {
  MotionPhase phase;
  phase.duration = duration;
  for (const models::GaitLimb& limb : stance.gait->limbs) phase.contacts.push_back(limb.contact);
  phase.task = [&stance, shift, back, duration, stride](double t) {
    const models::Posture& posture = stance.gait->posture;
    const ScalarSignal s = RestToRest(t, duration);
    const auto blend = [&](double nominal, double change) {
      return back ? Blend(nominal + change, nominal, s) : Blend(nominal, nominal + change, s);
    };
    WholeBodyTask task;
    task.root_pitch = Constant(posture.root_pitch);
    task.root_height = blend(posture.root_height, shift.z());
    const ScalarSignal x = blend(0, shift.x());
    const ScalarSignal y = blend(0, shift.y());
    task.root_position = {{x.value, y.value}, {x.rate, y.rate}, {x.acceleration, y.acceleration}};
    task.joints = ConstantVector<Eigen::VectorXd>(posture.joints);
    for (std::size_t i = 0; i < stance.gait->limbs.size(); ++i) {
      LimbTask limb;
      limb.limb = &stance.gait->limbs[i];
      limb.position = ConstantVector<Eigen::Vector3d>(stance.patch_centres[i]);
      limb.position.value.x() += i == 0 ? stride : -stride;
      limb.orientation = stance.patch_orientations[i];
      task.limbs.push_back(limb);
    }
    return task;
  };
  return phase;
}

/// A plan for the flat scenario that has no segment yet.
inline VerifierSubject PlanWithoutMotion(const std::string& robot_yaml) {
  VerifierSubject subject;
  subject.robot = models::LoadRobotModel(robot_yaml);
  subject.scenario = FlatScenario();
  Plan& plan = subject.plan;
  plan.robot_file = subject.robot.file;
  plan.robot_hash = subject.robot.content_hash;
  plan.scenario_file = "flat.yaml";
  plan.scenario_hash = subject.scenario.content_hash;
  for (const models::Joint& joint : subject.robot.joints) plan.joints.push_back(joint.name);
  return subject;
}

/// A robot that stands on both feet, shifts its pelvis by a few centimetres, and back again.
inline VerifierSubject StandingPlan(const std::string& robot_yaml, double stride = 0) {
  VerifierSubject subject = PlanWithoutMotion(robot_yaml);
  const NominalStance stance = SolveNominalStance(subject.robot, subject.robot.GaitNamed("walk"));
  const Eigen::Vector3d shift(0.02, 0.03, -0.02);
  MotionBuilder builder(subject.robot);
  const std::vector<Phase> phases = builder.Build({PelvisShift(stance, shift, false, 0.8, stride),
                                                   PelvisShift(stance, shift, true, 0.8, stride)},
                                                  stance.q);

  for (const Phase& phase : phases) subject.plan.segments.push_back({"walk", {phase}});
  return subject;
}

/// DRC-HUBO1's plan, for tests that work on copies.
inline const VerifierSubject& ValidSubject() {
  static const VerifierSubject subject =
      StandingPlan(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  return subject;
}

}  // namespace possibility::actions::testing
