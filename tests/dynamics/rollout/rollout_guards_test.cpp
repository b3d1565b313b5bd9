#include "dynamics/rollout/rollout_guards.h"

#include <gtest/gtest.h>

#include <random>

#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"
#include "tests/dynamics/rollout/walking_models.h"

namespace possibility::dynamics {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// DRC-HUBO1 that stands on some corners of its soles, with stiff feedback.
class Standing {
 public:
  explicit Standing(std::vector<int> held)
      : robot_(models::LoadRobotModel(std::filesystem::path(POSSIBILITY_SOURCE_DIR) /
                                      "models/drchubo1/drchubo1.yaml")),
        model_(MultibodyModel::Spatial(robot_)),
        posture_(robot_.Configuration(robot_.GaitNamed("walk").posture)),
        stance_(std::make_shared<RolloutStance>()) {
    RolloutDynamics robot = Robot();
    robot.SetState(State());
    for (int i = 0; i < robot.num_contacts(); ++i) {
      if (!std::count(held.begin(), held.end(), i)) stance_->free.push_back(i);
    }
    stance_->held = std::move(held);
    stance_->points = robot.HeldWhereTheyAre(stance_->held);
    stance_->patches = robot.PatchesOf(stance_->held);
    stance_->slack.assign(static_cast<std::size_t>(robot.num_contacts()), 0);
    stance_->passes.assign(static_cast<std::size_t>(robot.num_contacts()), false);
  }

  RolloutDynamics Robot() const {
    std::vector<RolloutContact> contacts;
    for (const char* name : {"left_sole", "right_sole"}) {
      const models::ContactPatch& patch = robot_.contacts[robot_.ContactIndex(name)];
      for (const Vector3d& point : patch.points) {
        contacts.push_back(ContactOn(patch.name, patch.link, point, Vector3d::UnitZ()));
      }
    }
    JointControl control;
    control.stiffness = VectorXd::Constant(model_->num_joints(), 3000);
    control.damping = VectorXd::Constant(model_->num_joints(), 90);
    control.command = [posture = VectorXd(posture_.tail(model_->num_joints()))](
                          double, JointCommand* command) { command->position = posture; };
    return RolloutDynamics(model_, contacts, control, {});
  }

  VectorXd State() const {
    VectorXd state(model_->nq() + model_->nv());
    state << posture_, VectorXd::Zero(model_->nv());
    return state;
  }
  int nv() const { return model_->nv(); }
  std::shared_ptr<const RolloutStance> stance() const { return stance_; }

 private:
  models::RobotModel robot_;
  std::shared_ptr<const MultibodyModel> model_;
  VectorXd posture_;
  std::shared_ptr<RolloutStance> stance_;
};

VectorXd ValuesAt(const Standing& standing, RolloutDynamics* robot, double t,
                  const VectorXd& state) {
  RobotRolloutSettings settings;
  settings.ends_at_slip = true;
  const RolloutGuards guards(standing.stance(), settings, robot);
  VectorXd values(guards.size());
  guards.Evaluate(t, state, values);
  return values;
}

// The integrator evaluates rates at a step's end before it corrects the state there.
TEST(RolloutGuards, SignsAreTheStatesOwnHoweverNearTheLastAccelerationWas) {
  std::mt19937 random(5);
  int reused = 0, signs[2] = {};
  for (const std::vector<int>& held :
       {std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}, {0, 3, 4, 7}, {1, 2, 3}, {}}) {
    const Standing standing(held);
    for (int trial = 0; trial < 200; ++trial) {
      VectorXd before = standing.State();
      before.tail(standing.nv()) = RandomVector(&random, standing.nv(), 0.01);
      before[6] += Uniform(&random, -3e-5, 3e-5);
      VectorXd after = before;
      const double distance = std::pow(10, Uniform(&random, -9, -5));
      const double speed = std::pow(10, Uniform(&random, -6, -2));
      const auto nq = after.size() - standing.nv();
      after.head(nq) += RandomVector(&random, static_cast<int>(nq), distance);
      after.head<4>().normalize();
      after.tail(standing.nv()) += RandomVector(&random, standing.nv(), speed);

      RolloutDynamics used = standing.Robot(), fresh = standing.Robot();
      Eigen::Matrix3Xd forces;
      used.Accelerate(0.3, before, *standing.stance(), &forces);
      const VectorXd values = ValuesAt(standing, &used, 0.3, after);
      const VectorXd expected = ValuesAt(standing, &fresh, 0.3, after);
      reused += values != expected;
      for (Eigen::Index i = 0; i < values.size(); ++i) {
        EXPECT_EQ(values[i] > 0, expected[i] > 0) << values[i] << " and " << expected[i];
        ++signs[expected[i] > 0];
      }
    }
  }
  EXPECT_GT(reused, 50) << "the test is about values of another state";
  EXPECT_GT(signs[0], 100);
  EXPECT_GT(signs[1], 100);
}

TEST(RolloutGuards, AnotherTimeOrAnotherStanceIsEvaluatedAnew) {
  const Standing standing({0, 1, 2, 3, 4, 5, 6, 7}), other({0, 3, 4, 7});
  const VectorXd state = standing.State();
  VectorXd near = state;
  near.tail(standing.nv()).setConstant(1e-5);
  RolloutDynamics fresh = standing.Robot();
  const VectorXd expected = ValuesAt(standing, &fresh, 0.3, near);
  Eigen::Matrix3Xd forces;
  RolloutDynamics later = standing.Robot();
  later.Accelerate(0.4, state, *standing.stance(), &forces);
  EXPECT_EQ(ValuesAt(standing, &later, 0.3, near), expected);
  RolloutDynamics elsewhere = standing.Robot();
  elsewhere.Accelerate(0.3, state, *other.stance(), &forces);
  EXPECT_EQ(ValuesAt(standing, &elsewhere, 0.3, near), expected);
  RolloutDynamics moved = standing.Robot();
  moved.Accelerate(0.3, state, *standing.stance(), &forces);
  moved.SetState(other.State());
  EXPECT_EQ(ValuesAt(standing, &moved, 0.3, near), expected);
}

}  // namespace
}  // namespace possibility::dynamics
