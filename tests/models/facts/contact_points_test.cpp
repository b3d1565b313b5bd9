#include "models/facts/contact_points.h"

#include <gtest/gtest.h>

#include "models/robot/urdf_reader.h"
#include "tests/models/two_legged_robot.h"

namespace possibility::models {
namespace {

const std::string kSphere = "<sphere radius=\"0.05\"/>";

std::string WithPoints(const std::string& radius) {
  std::string urdf = TwoLeggedUrdf();
  const std::string collision = "<collision><geometry>" + kSphere + "</geometry></collision>";
  std::string point = collision;
  point.replace(point.find("0.05"), 4, radius);
  urdf.insert(urdf.find(collision), point + point);
  return urdf;
}

TEST(ContactPoints, SpheresOfRadiusZeroAreLeftOut) {
  for (const char* zero : {"0", "0.0", "0e0"}) {
    const UrdfWithoutPoints read = WithoutPoints(WithPoints(zero));
    EXPECT_EQ(read.points, (std::map<std::string, int>{{"tool", 2}}));
    const UrdfTree expected = ParseUrdf(TwoLeggedUrdf(), "robot.urdf");
    const UrdfTree tree = ParseUrdf(read.urdf, "robot.urdf");
    ASSERT_EQ(tree.links.size(), expected.links.size());
    for (std::size_t i = 0; i < tree.links.size(); ++i) {
      EXPECT_EQ(tree.links[i].name, expected.links[i].name);
      EXPECT_EQ(tree.links[i].shapes.size(), expected.links[i].shapes.size());
      EXPECT_EQ(tree.links[i].inertial.has_value(), expected.links[i].inertial.has_value());
    }
  }
}

TEST(ContactPoints, OtherTextIsUnchanged) {
  for (const std::string& text : {TwoLeggedUrdf(), WithPoints("-1"), WithPoints("none"),
                                  std::string("<robot"), std::string()}) {
    const UrdfWithoutPoints read = WithoutPoints(text);
    EXPECT_EQ(read.urdf, text);
    EXPECT_TRUE(read.points.empty());
  }
}

}  // namespace
}  // namespace possibility::models
