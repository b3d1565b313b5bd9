#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "dynamics/sagittal/sagittal_reduction.h"
#include "dynamics/tree/contact_point.h"
#include "dynamics/tree/multibody_model.h"
#include "models/robot/robot_yaml.h"
#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {

using ModelPtr = std::shared_ptr<const MultibodyModel>;

inline const models::RobotModel& Hubo() {
  static const models::RobotModel robot = models::LoadRobotModel(
      std::string(POSSIBILITY_SOURCE_DIR) + "/models/drchubo1/drchubo1.yaml");
  return robot;
}

/// A random tree some of whose joints mimic others.
inline models::RobotModel CoupledTree(std::mt19937* random, int num_joints) {
  models::RobotModel tree = RandomTree(random, num_joints);
  for (int j = 0; j < num_joints; j += 3) {
    const int master = (j + 1) % num_joints;
    if (master % 3 == 0) continue;
    tree.joints[j].mimic =
        models::Mimic{master, Uniform(random, 0.5, 2) * (j % 2 == 0 ? 1 : -1), 0.3};
  }
  return tree;
}

struct MotionState {
  Eigen::VectorXd q, v, a;
};

inline MotionState RandomMotionState(std::mt19937* random, const MultibodyModel& model) {
  MotionState state{RandomVector(random, model.nq(), 2), RandomVector(random, model.nv(), 3),
                    RandomVector(random, model.nv(), 10)};
  if (model.base() == Base::kFloating) state.q.head<4>().normalize();
  return state;
}

inline ContactPoint RandomPoint(std::mt19937* random, const MultibodyModel& model) {
  const int link = static_cast<int>((*random)() % model.tree().num_links());
  return {link, RandomVector(random, 3, 0.3)};
}

/// All models whose derivatives are tested, with how many states each.
struct ModelCase {
  std::string name;
  ModelPtr model;
  int states;
};

inline std::vector<ModelCase> Cases(int hubo_states, int tree_states) {
  std::mt19937 random(11);
  std::vector<ModelCase> cases = {
      {"drchubo1", MultibodyModel::Spatial(Hubo()), hubo_states},
      {"drchubo1, sagittal", SagittalReduction(Hubo()).model(), hubo_states}};
  for (int i = 0; i < 20; ++i) {
    const int joints = 2 + i;
    const auto number = std::to_string(i);
    cases.push_back(
        {"tree " + number, MultibodyModel::Spatial(RandomTree(&random, joints)), tree_states});
    cases.push_back({"coupled tree " + number,
                     MultibodyModel::Spatial(CoupledTree(&random, joints)), tree_states});
    if (i % 4 == 1) {
      cases.push_back({"driven tree " + number,
                       MultibodyModel::Spatial(WithActuators(RandomTree(&random, joints), &random)),
                       tree_states});
      cases.push_back(
          {"driven coupled tree " + number,
           MultibodyModel::Spatial(WithActuators(CoupledTree(&random, joints), &random)),
           tree_states});
      cases.push_back(
          {"driven planar tree " + number,
           MultibodyModel::Planar(WithActuators(RandomPlanarTree(&random, joints), &random)),
           tree_states});
    }
    cases.push_back({"planar tree " + number,
                     MultibodyModel::Planar(RandomPlanarTree(&random, joints)), tree_states});
  }
  return cases;
}

}  // namespace possibility::dynamics
