#include "experiments/exports/foxglove_messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/exports/foxglove_schemas.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

using nlohmann::json;

/// The first place where `value` is not what the schema wants; empty if there is none.
std::string Mismatch(const json& value, const json& schema, const std::string& path) {
  const std::string type = schema.value("type", "");
  if (type == "object") {
    if (!value.is_object()) return path;
    for (const auto& name : schema.value("required", json::array())) {
      if (!value.contains(name)) return path + "." + name.get<std::string>();
    }
    for (const auto& [name, member] : value.items()) {
      if (!schema["properties"].contains(name)) return path + "." + name;
      const std::string inner = Mismatch(member, schema["properties"][name], path + "." + name);
      if (!inner.empty()) return inner;
    }
    return "";
  }
  if (type == "array") {
    if (!value.is_array()) return path;
    for (const auto& item : value) {
      const std::string inner = Mismatch(item, schema["items"], path + "[]");
      if (!inner.empty()) return inner;
    }
    return "";
  }
  const bool fits = type == "number"    ? value.is_number()
                    : type == "integer" ? value.is_number_integer()
                    : type == "string"  ? value.is_string()
                    : type == "boolean" ? value.is_boolean()
                                        : false;
  return fits ? "" : path;
}

Eigen::Isometry3d FrameOf(const json& transform) {
  const json& p = transform["translation"];
  const json& q = transform["rotation"];
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() << p["x"], p["y"], p["z"];
  X.linear() = Eigen::Quaterniond(q["w"], q["x"], q["y"], q["z"]).toRotationMatrix();
  return X;
}

class FoxgloveMessages : public ::testing::Test {
 protected:
  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Knot knot_ = testing::SampleKnot(robot_, 0.7, 5);
  static constexpr std::uint64_t kTime = 3000000007;
};

TEST_F(FoxgloveMessages, TransformsMultiplyToTheLinksPoses) {
  dynamics::TreeKinematics kinematics(robot_);
  kinematics.SetPosition(knot_.q);
  const json message = json::parse(LinkTransforms(robot_, kinematics.X_WL(), kTime));
  EXPECT_EQ(Mismatch(message, json::parse(FrameTransformsSchema()), "tf"), "");
  const json& transforms = message["transforms"];
  ASSERT_EQ(transforms.size(), 2u);
  EXPECT_EQ(transforms[0]["parent_frame_id"], "world");
  EXPECT_EQ(transforms[1]["parent_frame_id"], transforms[0]["child_frame_id"]);
  EXPECT_EQ(transforms[0]["timestamp"]["sec"], 3);
  EXPECT_EQ(transforms[0]["timestamp"]["nsec"], 7);
  const Eigen::Isometry3d X = FrameOf(transforms[0]) * FrameOf(transforms[1]);
  EXPECT_LT((X.matrix() - kinematics.X_WL()[1].matrix()).norm(), 1e-5);
}

TEST_F(FoxgloveMessages, JointStatesNameAndRound) {
  const json message = json::parse(JointStates(robot_, knot_, kTime));
  EXPECT_EQ(Mismatch(message, json::parse(JointStatesSchema()), "joints"), "");
  EXPECT_EQ(message["joints"][0]["name"], "hip");
  EXPECT_NEAR(message["joints"][0]["position"], knot_.q[7], 5e-7);
  EXPECT_NEAR(message["joints"][0]["velocity"], knot_.v[6], 5e-6);
  EXPECT_NEAR(message["joints"][0]["effort"], knot_.tau[0], 5e-4);
}

TEST_F(FoxgloveMessages, ScenesHoldEveryShape) {
  models::Scenario scenario = testing::SampleScenario();
  models::Obstacle wedge;
  wedge.name = "wedge";
  wedge.shape = models::Shape::ConvexMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  scenario.environment.obstacles.push_back(wedge);
  models::Surface surface;
  surface.name = "hill";
  surface.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  surface.mesh.triangles = {{0, 1, 2}};
  scenario.environment.surfaces.push_back(surface);
  wedge.surface = 0;  // a piece of the hill, not shown
  scenario.environment.obstacles.push_back(wedge);
  const json schema = json::parse(SceneUpdateSchema());
  const json world = json::parse(WorldScene(scenario.environment, kTime));
  EXPECT_EQ(Mismatch(world, schema, "scene"), "");
  ASSERT_EQ(world["entities"].size(), 4u);
  EXPECT_EQ(world["entities"][0]["cubes"][0]["size"]["x"], 4);
  EXPECT_EQ(world["entities"][1]["cylinders"][0]["size"]["z"], 1);
  EXPECT_EQ(world["entities"][2]["triangles"][0]["indices"].size(), 12u);
  EXPECT_EQ(world["entities"][3]["triangles"][0]["points"].size(), 3u);
  const json robot = json::parse(RobotScene(robot_, kTime));
  EXPECT_EQ(Mismatch(robot, schema, "robot"), "");
  ASSERT_EQ(robot["entities"].size(), 2u);
  EXPECT_EQ(robot["entities"][1]["frame_id"], "leg");
  EXPECT_EQ(robot["entities"][1]["spheres"].size(), 2u) << "the ends of a capsule";
}

TEST_F(FoxgloveMessages, ArrowsPointAlongForces) {
  const std::vector<PointForce> forces = {{"a", true, {1, 2, 3}, {0, 30, 40}},
                                          {"b", false, {4, 5, 6}, {0, 0, 0}}};
  const json arrows = json::parse(ForceArrows(forces, kTime));
  EXPECT_EQ(Mismatch(arrows, json::parse(SceneUpdateSchema()), "arrows"), "");
  ASSERT_EQ(arrows["entities"][0]["arrows"].size(), 1u);
  const json& arrow = arrows["entities"][0]["arrows"][0];
  EXPECT_NEAR(arrow["shaft_length"], 0.05, 1e-9);
  const json& q = arrow["pose"]["orientation"];
  const Eigen::Vector3d direction =
      Eigen::Quaterniond(q["w"], q["x"], q["y"], q["z"]) * Eigen::Vector3d::UnitX();
  EXPECT_LT((direction - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-6);
  const json numbers = json::parse(ContactForces(forces, kTime));
  EXPECT_EQ(Mismatch(numbers, json::parse(ContactForcesSchema()), "forces"), "");
  EXPECT_EQ(numbers["points"][0]["force"]["z"], 40);
  EXPECT_EQ(numbers["points"][1]["bears"], false);
}

}  // namespace
}  // namespace possibility::experiments
