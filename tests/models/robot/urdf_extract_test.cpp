// The text of a URDF that urdfdom sees. urdfdom passes texts of the file to printf as formats.

#include "models/robot/urdf_extract.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "models/robot/urdf_reader.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

TEST(UrdfExtract, LegalPercentSignsLoad) {
  std::string urdf = TwoLeggedUrdf();
  urdf = ReplacedEverywhere(urdf, "<link name=\"tool\">",
                            "<!-- 100% --><link name=\"tool\"><visual><geometry><mesh "
                            "filename=\"%n/100%s.stl\"/></geometry></visual>");
  urdf = ReplacedEverywhere(urdf, "two_legged", "two%nlegged");
  urdf = ReplacedEverywhere(urdf, "l_hip", "l%hip");
  urdf = ReplacedEverywhere(urdf, "l_yaw", "%n%s");
  const std::string yaml = ReplacedEverywhere(TwoLeggedYaml(), "l_yaw", "'%n%s'");
  const TemporaryFolder folder;
  folder.Write("robot.urdf", urdf);
  const RobotModel robot = LoadRobotModel(folder.Write("robot.yaml", yaml));
  EXPECT_EQ(robot.joints[0].name, "%n%s");
  EXPECT_EQ(robot.links[1].name, "l%hip");
}

// '!' sorts before '%', but the replacement of '%' sorts before '!'.
TEST(UrdfExtract, NamesStaySorted) {
  std::string urdf = ReplacedEverywhere(TwoLeggedUrdf(), "l_hip", "a%");
  urdf = ReplacedEverywhere(urdf, "r_hip", "a!");
  urdf = ReplacedEverywhere(urdf, "l_yaw", "b%");
  urdf = ReplacedEverywhere(urdf, "r_yaw", "b!");
  const UrdfTree tree = ParseUrdf(urdf, "robot.urdf");
  EXPECT_EQ(tree.links[0].name, "a!");
  EXPECT_EQ(tree.links[1].name, "a%");
  EXPECT_EQ(tree.joints[0].name, "b!");
  EXPECT_EQ(tree.joints[1].name, "b%");
}

TEST(UrdfExtract, TheExtractNeverHoldsAPercentSign) {
  const std::string tokens[] = {"%n", "%", "&#37;", "&#x25;", "%s", "&amp;#37;"};
  const std::string urdf = TwoLeggedUrdf();
  std::mt19937 random(5);
  int extracted = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string text = urdf;
    text.insert(random() % text.size(), tokens[random() % std::size(tokens)]);
    try {
      EXPECT_EQ(ExtractUrdf(text, "robot.urdf").find('%'), std::string::npos) << text;
      ++extracted;
    } catch (const InputError&) {
    }
  }
  EXPECT_GT(extracted, 200);
}

TEST(UrdfExtract, KeepsLinksAndJointsAndIsIdempotent) {
  const std::filesystem::path file =
      std::filesystem::path(POSSIBILITY_SOURCE_DIR) / "models/drchubo1/drchubo1.urdf";
  const std::string extract = ExtractUrdf(ReadFileContents(file), file);
  const UrdfTree tree = ParseUrdf(extract, file);
  EXPECT_EQ(tree.links.size(), 52u);
  EXPECT_EQ(tree.joints.size(), 51u);
  EXPECT_EQ(ExtractUrdf(extract, file), extract);
}

TEST(UrdfExtract, ACapsuleIsRead) {
  const UrdfTree tree = ParseUrdf(Replaced(TwoLeggedUrdf(), "<sphere radius=\"0.05\"/>",
                                           "<capsule radius=\"0.05\" length=\"0.2\"/>"),
                                  "robot.urdf");
  const auto tool = std::ranges::find(tree.links, "tool", &UrdfLink::name);
  ASSERT_EQ(tool->shapes.size(), 1u);
  EXPECT_EQ(tool->shapes[0].shape.type, ShapeType::kCapsule);
  EXPECT_EQ(tool->shapes[0].shape.radius, 0.05);
  EXPECT_EQ(tool->shapes[0].shape.length, 0.2);
}

TEST(UrdfExtract, VisualsTakeThePlaceOfCollisionsIfAskedFor) {
  const std::string urdf =
      Replaced(TwoLeggedUrdf(), "<link name=\"tool\">",
               "<link name=\"tool\"><visual><origin xyz=\"1 2 3\"/><geometry><box size=\"1 1 "
               "1\"/></geometry><material/></visual>");
  for (const bool shown : {false, true}) {
    const UrdfTree tree =
        ParseUrdf(urdf, "robot.urdf", shown ? UrdfGeometry::kVisual : UrdfGeometry::kCollision);
    std::size_t shapes = 0;
    for (const UrdfLink& link : tree.links) shapes += link.shapes.size();
    EXPECT_EQ(shapes, shown ? 1u : 2u);
    const auto tool = std::ranges::find(tree.links, "tool", &UrdfLink::name);
    ASSERT_EQ(tool->shapes.size(), 1u);
    EXPECT_EQ(tool->shapes[0].shape.type, shown ? ShapeType::kBox : ShapeType::kSphere);
    EXPECT_EQ(tool->shapes[0].X_PS.translation().z(), shown ? 3 : 0);
  }
}

std::string BelowAWorld(const std::string& joint_type, const std::string& world) {
  return Replaced(TwoLeggedUrdf(), "<link name=\"base\">",
                  "<link name=\"world\">" + world + "</link><joint name=\"free\" type=\"" +
                      joint_type +
                      "\"><parent link=\"world\"/><child link=\"base\"/><limit lower=\"0\" "
                      "upper=\"1\" velocity=\"1\" effort=\"1\"/></joint><link name=\"base\">");
}

TEST(UrdfExtract, AWorldThatTheRobotFloatsInIsLeftOut) {
  const UrdfTree tree = ParseUrdf(BelowAWorld("floating", ""), "robot.urdf");
  const UrdfTree plain = ParseUrdf(TwoLeggedUrdf(), "robot.urdf");
  EXPECT_EQ(tree.root, "base");
  EXPECT_EQ(tree.links.size(), plain.links.size());
  EXPECT_EQ(tree.joints.size(), plain.joints.size());
  EXPECT_EQ(ParseUrdf(BelowAWorld("revolute", ""), "robot.urdf").root, "world");
  EXPECT_EQ(ParseUrdf(BelowAWorld("floating",
                                  "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" "
                                  "ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial>"),
                      "robot.urdf")
                .root,
            "world");
}

}  // namespace
}  // namespace possibility::models
