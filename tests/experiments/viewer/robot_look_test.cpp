// What a robot looks like: its URDF's <visual> elements, and what pages make of them.

#include "experiments/viewer/robot_look.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "experiments/recording/headless_browser.h"
#include "experiments/viewer/viewer_page.h"
#include "models/robot/robot_yaml.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/viewer/page_data.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;
using ModelFolder = models::TemporaryFolder;

const models::TriangleMesh kBody = models::testing::BoxMesh({0.2, 0.3, 0.1});

/// Adds a `<visual>` to a link of the two-legged robot.
std::string WithVisual(const std::string& urdf, const std::string& link,
                       const std::string& geometry) {
  const std::string begin = "<link name=\"" + link + "\">\n";
  return Replaced(urdf, begin, begin + "<visual><geometry>" + geometry + "</geometry></visual>");
}

std::string MeshNamed(const std::string& attributes) { return "<mesh " + attributes + "/>"; }

models::RobotModel Load(const ModelFolder& folder, const std::string& urdf) {
  folder.Write("robot.urdf", urdf);
  return models::LoadRobotModel(folder.Write("robot.yaml", models::TwoLeggedYaml()));
}

TEST(RobotLookTest, MeshesAreReadOnceForEachScaleAndMirroredOnesTurnedOutwards) {
  const ModelFolder folder;
  folder.Write("body.stl", models::testing::BinaryStl(kBody));
  std::string urdf = models::TwoLeggedUrdf();
  for (const std::string link : {"l_hip", "l_thigh"}) {
    urdf = WithVisual(urdf, link, MeshNamed("filename=\"body.stl\""));
  }
  urdf = WithVisual(urdf, "r_hip", MeshNamed("filename=\"body.stl\" scale=\"2 -1 1\""));
  const models::RobotModel robot = Load(folder, urdf);
  const RobotLook look = LookOf(robot);
  EXPECT_TRUE(look.faults.empty());
  ASSERT_EQ(look.links.size(), robot.links.size());
  const auto mesh_of = [&](const std::string& link) {
    return look.links[robot.LinkIndex(link)].meshes.at(0).mesh;
  };
  ASSERT_EQ(look.meshes.size(), 2u);
  EXPECT_EQ(mesh_of("l_hip"), mesh_of("l_thigh"));
  EXPECT_NEAR(models::testing::EnclosedVolume(look.meshes[mesh_of("l_hip")]), 0.2 * 0.3 * 0.1,
              1e-8);
  EXPECT_NEAR(models::testing::EnclosedVolume(look.meshes[mesh_of("r_hip")]), 2 * 0.2 * 0.3 * 0.1,
              1e-8);
  EXPECT_TRUE(look.links[robot.LinkIndex("r_foot")].meshes.empty());
}

TEST(RobotLookTest, ALinkOnAFixedJointIsSeenAtItsPlace) {
  const ModelFolder folder;
  folder.Write("body.stl", models::testing::BinaryStl(kBody));
  std::string urdf =
      WithVisual(models::TwoLeggedUrdf(), "tool", MeshNamed("filename=\"body.stl\""));
  urdf = WithVisual(urdf, "base", "<sphere radius=\"0.2\"/>");
  const RobotLook look = LookOf(Load(folder, urdf));
  ASSERT_EQ(look.links[0].meshes.size(), 1u);
  // The tool is 0.3 m above the base, turned by 0.5 rad about y.
  EXPECT_TRUE((look.links[0].meshes[0].X_LM * Vector3d(1, 0, 0))
                  .isApprox(Vector3d(std::cos(0.5), 0, 0.3 - std::sin(0.5)), 1e-12));
  ASSERT_EQ(look.links[0].shapes.size(), 1u) << "collision shapes are not what is seen";
  EXPECT_EQ(look.links[0].shapes[0].shape.radius, 0.2);
}

TEST(RobotLookTest, AMeshThatCannotBeReadIsAFaultAndHidesNoOther) {
  const ModelFolder folder;
  folder.Write("body.stl", models::testing::BinaryStl(kBody));
  folder.Write("spoilt.stl", "solid nothing");
  std::string urdf =
      WithVisual(models::TwoLeggedUrdf(), "base", MeshNamed("filename=\"body.stl\""));
  urdf = WithVisual(urdf, "l_hip", MeshNamed("filename=\"none.stl\""));
  urdf = WithVisual(urdf, "r_hip", MeshNamed("filename=\"spoilt.stl\""));
  const models::RobotModel robot = Load(folder, urdf);
  const RobotLook look = LookOf(robot);
  ASSERT_EQ(look.faults.size(), 2u);
  EXPECT_NE(look.faults[0].find("link 'l_hip'"), std::string::npos) << look.faults[0];
  EXPECT_NE(look.faults[0].find("none.stl"), std::string::npos) << look.faults[0];
  EXPECT_NE(look.faults[1].find("spoilt.stl"), std::string::npos) << look.faults[1];
  EXPECT_EQ(look.links[0].meshes.size(), 1u);
  EXPECT_TRUE(look.links[robot.LinkIndex("l_hip")].meshes.empty());
}

TEST(RobotLookTest, NothingIsKnownOfARobotWithoutVisualsOrWithOtherLinksThanItsFile) {
  const ModelFolder folder;
  models::RobotModel robot = Load(folder, models::TwoLeggedUrdf());
  EXPECT_TRUE(LookOf(robot).links.empty());
  robot = Load(folder, WithVisual(models::TwoLeggedUrdf(), "base", "<sphere radius=\"0.2\"/>"));
  EXPECT_EQ(LookOf(robot).links.size(), robot.links.size());
  robot.links[1].name = "another";
  EXPECT_TRUE(LookOf(robot).links.empty());
  robot.file = folder.path() / "gone.yaml";
  const RobotLook gone = LookOf(robot);
  EXPECT_TRUE(gone.links.empty());
  EXPECT_EQ(gone.faults.size(), 1u);
  EXPECT_TRUE(LookOf(testing::SampleRobot()).faults.empty()) << "it was built in code";
}

TEST(RobotLookTest, ManyTrianglesBecomeFewEnoughForAPage) {
  const ModelFolder folder;
  constexpr int kSide = 200;  // 80,000 triangles
  models::TriangleMesh hills;
  for (int i = 0; i <= kSide; ++i) {
    for (int j = 0; j <= kSide; ++j) {
      hills.vertices.emplace_back(0.01 * i, 0.01 * j, 0.1 * std::sin(0.1 * i) * std::cos(0.07 * j));
    }
  }
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const int a = i * (kSide + 1) + j, b = a + kSide + 1;
      hills.triangles.push_back({a, b, a + 1});
      hills.triangles.push_back({a + 1, b, b + 1});
    }
  }
  folder.Write("hills.stl", models::testing::BinaryStl(hills));
  folder.Write("body.stl", models::testing::BinaryStl(kBody));
  std::string urdf =
      WithVisual(models::TwoLeggedUrdf(), "base", MeshNamed("filename=\"body.stl\""));
  urdf = WithVisual(urdf, "l_hip", MeshNamed("filename=\"hills.stl\""));
  const RobotLook look = LookOf(Load(folder, urdf));
  ASSERT_EQ(look.meshes.size(), 2u);
  std::size_t all = 0;
  for (const models::TriangleMesh& mesh : look.meshes) all += mesh.triangles.size();
  EXPECT_LE(all, kMostSeenTriangles + 100u);
  EXPECT_GT(all, kMostSeenTriangles / 2u);
  for (const models::TriangleMesh& mesh : look.meshes) {
    if (mesh.triangles.size() > 12) continue;
    EXPECT_EQ(mesh.triangles.size(), 12u) << "the box has no triangle to spare";
  }
}

/// The sample plan's robot stands still, seen as a ball on its trunk.
class LookOnAPage : public ::testing::Test {
 protected:
  std::string Page(const std::string& mesh) const {
    folder_.Write("body.stl", models::testing::BinaryStl(kBody));
    models::RobotModel robot =
        Load(folder_, WithVisual(models::TwoLeggedUrdf(), "base", MeshNamed(mesh)));
    actions::Plan plan = testing::SamplePlan(testing::SampleRobot(), 4, 9);
    plan.segments.clear();
    return ViewerPage(plan, robot, testing::SampleScenario());
  }

  ModelFolder folder_;
};

TEST_F(LookOnAPage, OnlyLinksOfWhichSomethingIsSeenHaveALook) {
  const nlohmann::json data = testing::EmbeddedData(Page("filename=\"body.stl\""));
  ASSERT_EQ(data["meshes"].size(), 1u);
  EXPECT_EQ(testing::Unpacked<std::int32_t>(data["meshes"][0]["triangles"]).size(), 36u);
  EXPECT_EQ(data["links"][0]["look"][0]["type"], "mesh");
  EXPECT_EQ(data["links"][0]["look"][0]["mesh"], 0);
  EXPECT_FALSE(data["links"][1].contains("look"));
  EXPECT_FALSE(data["links"][0]["shapes"].empty()) << "collision shapes are still there";
}

TEST_F(LookOnAPage, SaysWhyAMeshIsNotDrawn) {
  const nlohmann::json data = testing::EmbeddedData(Page("filename=\"none.stl\""));
  EXPECT_FALSE(data["links"][0].contains("look"));
  const nlohmann::json last = data["facts"].back();
  EXPECT_EQ(last[0], "Not drawn");
  EXPECT_NE(last[1].get<std::string>().find("none.stl"), std::string::npos);
}

TEST_F(LookOnAPage, IsDrawnAndCollisionShapesCanBeSwitchedOn) {
  if (!FindProgram({"chromium", "chromium-browser", "google-chrome"})) {
    GTEST_SKIP() << "chromium is not installed";
  }
  HeadlessBrowser browser({600, 500});
  browser.Open(Page("filename=\"body.stl\""), "");
  if (browser.Evaluate("page === null") == true) GTEST_SKIP() << "chromium has no WebGL here";
  const auto number = [&](const std::string& of) -> double {
    return browser.Evaluate("page.views[0].drawing." + of);
  };
  EXPECT_EQ(number("links[0].children[0].geometry.attributes.position.count"), 36);
  // Corners of a box have a crease: every normal is that of its own face.
  EXPECT_EQ(number("links[0].children[0].geometry.attributes.normal.array.filter("
                   "(x) => Math.abs(x) > 1e-6).length"),
            36);
  EXPECT_EQ(browser.Evaluate("page.views[0].drawing.collision.visible"), false);
  EXPECT_EQ(browser.Evaluate("element('collision').parentElement.hidden"), false);
  browser.Evaluate("element('collision').click(); 0");
  EXPECT_EQ(browser.Evaluate("page.views[0].drawing.collision.visible"), true);
}

}  // namespace
}  // namespace possibility::experiments
