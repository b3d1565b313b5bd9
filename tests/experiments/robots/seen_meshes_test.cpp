// Copies of the meshes by which a robot is seen.

#include "experiments/robots/seen_meshes.h"

#include <gtest/gtest.h>

#include <string>

#include "experiments/viewer/robot_look.h"
#include "models/mesh/mesh_reader.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::experiments {
namespace {

/// A robot seen as one box in three places and as a mesh that is missing.
std::string SeenUrdf() {
  std::string urdf = models::TwoLeggedUrdf();
  for (const std::string link : {"base", "l_hip", "r_hip", "l_thigh"}) {
    const std::string begin = "<link name=\"" + link + "\">\n";
    const std::string file = link == "l_thigh" ? "none.stl" : "parts/body.stl";
    urdf = Replaced(urdf, begin,
                    begin + "<visual><geometry><mesh filename=\"" + file +
                        "\" scale=\"1 2 1\"/></geometry></visual>");
  }
  return urdf;
}

TEST(SeenMeshesTest, TheCopyIsSeenWithoutTheOriginal) {
  const models::TemporaryFolder original;
  std::filesystem::create_directories(original.path() / "parts");
  original.Write("parts/body.stl",
                 models::testing::BinaryStl(models::testing::BoxMesh({0.2, 0.3, 0.1})));
  const SeenMeshes seen = CopySeenMeshes(SeenUrdf(), original.path() / "robot.urdf", {});
  ASSERT_EQ(seen.files.size(), 1u) << "one mesh, whatever the number of its links";
  EXPECT_EQ(seen.triangles, 12u);
  ASSERT_EQ(seen.warnings.size(), 1u);
  EXPECT_NE(seen.warnings[0].find("link 'l_thigh'"), std::string::npos) << seen.warnings[0];

  const models::TemporaryFolder copy;
  std::filesystem::create_directories(copy.path() / "meshes");
  copy.Write(seen.files[0].name, seen.files[0].bytes);
  copy.Write("robot.urdf", seen.urdf);
  const models::RobotModel robot =
      models::LoadRobotModel(copy.Write("robot.yaml", models::TwoLeggedYaml()));
  const RobotLook look = LookOf(robot);
  ASSERT_EQ(look.meshes.size(), 1u);
  EXPECT_NEAR(models::testing::EnclosedVolume(look.meshes[0]), 2 * 0.2 * 0.3 * 0.1, 1e-8);
  for (const std::string link : {"base", "l_hip", "r_hip"}) {
    EXPECT_EQ(look.links[robot.LinkIndex(link)].meshes.size(), 1u) << link;
  }
  EXPECT_EQ(look.faults.size(), 1u);
}

TEST(SeenMeshesTest, AUrdfWithoutSeenMeshesStaysAsItIs) {
  const std::string urdf = models::TwoLeggedUrdf();
  const SeenMeshes seen = CopySeenMeshes(urdf, "robot.urdf", {});
  EXPECT_EQ(seen.urdf, urdf);
  EXPECT_TRUE(seen.files.empty());
  EXPECT_TRUE(seen.warnings.empty());
}

}  // namespace
}  // namespace possibility::experiments
