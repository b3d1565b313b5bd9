#include "experiments/exports/mujoco_export.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>
#include <unistd.h>

#include <sstream>

#ifdef POSSIBILITY_WITH_MUJOCO
#include <mujoco/mujoco.h>
#endif

#include "dynamics/tree/tree_derivatives.h"
#include "experiments/exports/mujoco_tree.h"
#include "experiments/samples/quantities.h"
#include "models/robot/robot_yaml.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

int CountElements(const tinyxml2::XMLElement* element, const std::string& name) {
  int count = 0;
  for (; element != nullptr; element = element->NextSiblingElement()) {
    count += element->Name() == name;
    count += CountElements(element->FirstChildElement(), name);
  }
  return count;
}

models::Scenario SceneOfAllShapes() {
  models::Scenario scenario = testing::SampleScenario();
  const auto add = [&](const std::string& name, const models::Shape& shape) {
    models::Obstacle obstacle;
    obstacle.name = name;
    obstacle.shape = shape;
    obstacle.X_WO.translation() << 1, 2, 3;
    obstacle.X_WO.linear() =
        Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    scenario.environment.obstacles.push_back(obstacle);
  };
  add("ball & \"co\"", models::Shape::Sphere(0.2));
  add("pill", models::Shape::Capsule(0.1, 0.4));
  add("wedge", models::Shape::ConvexMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  return scenario;
}

class MujocoExport : public ::testing::Test {
 protected:
  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
  const models::Scenario scenario_ = SceneOfAllShapes();
};

TEST_F(MujocoExport, HoldsSceneRobotAndKeyframes) {
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(MujocoXml({plan_, robot_, scenario_}, {0.5, false}).c_str()),
            tinyxml2::XML_SUCCESS);
  const tinyxml2::XMLElement* root = document.FirstChildElement("mujoco");
  ASSERT_NE(root, nullptr);
  const auto* world = root->FirstChildElement("worldbody");
  EXPECT_EQ(CountElements(world->FirstChildElement(), "body"), robot_.num_links());
  EXPECT_EQ(CountElements(world->FirstChildElement(), "site"), 5) << "the contact points";
  EXPECT_EQ(CountElements(world->FirstChildElement(), "geom"), 5 + 2);
  EXPECT_EQ(CountElements(root->FirstChildElement("asset")->FirstChildElement(), "mesh"), 1);
  const auto* key = root->FirstChildElement("keyframe")->FirstChildElement("key");
  EXPECT_EQ(CountElements(key, "key"), 9);
  std::istringstream words(key->Attribute("qpos"));
  for (const int i : {4, 5, 6, 0, 1, 2, 3, 7}) {
    double number = 0;
    words >> number;
    EXPECT_EQ(number, plan_.segments[0].phases[0].knots[0].q[i]);
  }
}

#ifdef POSSIBILITY_WITH_MUJOCO

/// A model loaded by MuJoCo.
class MujocoModel {
 public:
  explicit MujocoModel(const std::string& xml) {
    char error[1000] = "";
    mjVFS files;
    mj_defaultVFS(&files);
    mj_makeEmptyFileVFS(&files, "model.xml", static_cast<int>(xml.size()));
    std::copy(xml.begin(), xml.end(), static_cast<char*>(files.filedata[0]));
    model_ = mj_loadXML("model.xml", &files, error, sizeof(error));
    mj_deleteVFS(&files);
    EXPECT_NE(model_, nullptr) << error;
    if (model_ != nullptr) data_ = mj_makeData(model_);
  }
  ~MujocoModel() {
    if (data_ != nullptr) mj_deleteData(data_);
    if (model_ != nullptr) mj_deleteModel(model_);
  }
  MujocoModel(const MujocoModel&) = delete;
  MujocoModel& operator=(const MujocoModel&) = delete;

  mjModel* model() { return model_; }
  mjData* data() { return data_; }

  /// Inverse dynamics without contacts and limits.
  Eigen::VectorXd InverseDynamics(const Eigen::VectorXd& qpos, const Eigen::VectorXd& qvel,
                                  const Eigen::VectorXd& qacc) {
    model_->opt.disableflags |= mjDSBL_CONSTRAINT;
    std::copy(qpos.begin(), qpos.end(), data_->qpos);
    std::copy(qvel.begin(), qvel.end(), data_->qvel);
    std::copy(qacc.begin(), qacc.end(), data_->qacc);
    mj_inverse(model_, data_);
    return Eigen::Map<const Eigen::VectorXd>(data_->qfrc_inverse, model_->nv);
  }

 private:
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
};

TEST_F(MujocoExport, MujocoLoadsEveryShape) {
  MujocoModel mujoco(MujocoXml({plan_, robot_, scenario_}, {0.5, false}));
  ASSERT_NE(mujoco.model(), nullptr);
  EXPECT_EQ(mujoco.model()->nkey, 9);
  EXPECT_EQ(mujoco.model()->key_time[8], 4);
  mj_resetDataKeyframe(mujoco.model(), mujoco.data(), 0);
  mj_forward(mujoco.model(), mujoco.data());
  for (int i = 2; i < 4; ++i) {  // the mesh's frame is that of its inertia
    const models::Obstacle& obstacle = scenario_.environment.obstacles[i];
    const Eigen::Map<const Eigen::Vector3d> place(mujoco.data()->geom_xpos + 3 * i);
    EXPECT_LT((place - obstacle.X_WO.translation()).norm(), 1e-12);
  }
}

TEST_F(MujocoExport, MujocosDynamicsAreOurs) {
  models::RobotModel robot =
      models::LoadRobotModel(POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml");
  for (int j = 0; j < robot.num_joints(); j += 2)
    robot.joints[j].actuator.armature = 0.1 + 0.01 * j;
  for (int j = 0; j < robot.num_joints(); j += 3) {
    robot.joints[j].actuator.viscous_friction = 1 + 0.1 * j;
  }
  const actions::Plan plan = testing::SamplePlan(robot, 1, 3);
  actions::Plan standing = plan;
  for (auto& segment : standing.segments) segment.phases[0].contacts = {};
  for (auto& segment : standing.segments) {
    for (auto& knot : segment.phases[0].knots) knot.forces.resize(3, 0);
  }
  MujocoModel mujoco(MujocoXml({standing, robot, scenario_}, {0.5, false}));
  ASSERT_NE(mujoco.model(), nullptr);
  ASSERT_EQ(mujoco.model()->nq, robot.nq());
  ASSERT_EQ(mujoco.model()->nu, robot.num_joints());
  EXPECT_NEAR(mj_getTotalmass(mujoco.model()), robot.TotalMass(), 1e-9);
  const MujocoTree tree(robot);
  dynamics::TreeDerivatives motion(robot);
  for (const actions::Segment& segment : standing.segments) {
    for (const actions::Knot& knot : segment.phases[0].knots) {
      motion.SetState(knot.q, knot.v, knot.a);
      // Forces change axes as the velocities do that they are dual to.
      const Eigen::VectorXd expected = tree.Rates(knot.q, motion.InverseDynamics());
      const Eigen::VectorXd found = mujoco.InverseDynamics(
          tree.Positions(knot.q), tree.Rates(knot.q, knot.v), tree.Rates(knot.q, knot.a));
      EXPECT_LT((found - expected).norm(), 1e-8 * expected.norm());
      for (const actions::BearingPoint& point : AllContactPoints(robot)) {
        const int site =
            mj_name2id(mujoco.model(), mjOBJ_SITE, ContactColumn(robot, point).c_str());
        ASSERT_GE(site, 0);
        const Eigen::Map<const Eigen::Vector3d> place(mujoco.data()->site_xpos + 3 * site);
        EXPECT_LT((place - motion.kinematics().Position(point.link, point.p_L)).norm(), 1e-10);
      }
    }
  }
}

#else

TEST_F(MujocoExport, MujocoLoadsTheModel) { GTEST_SKIP() << "libmujoco-dev is not installed"; }

#endif

}  // namespace
}  // namespace possibility::experiments
