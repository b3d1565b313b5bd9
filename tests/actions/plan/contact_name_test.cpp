#include "actions/plan/contact_name.h"

#include <gtest/gtest.h>

#include <random>

#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

models::RobotModel TwoPatches() {
  models::RobotModel robot;
  robot.contacts = {
      {"sole", 1, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, -Eigen::Vector3d::UnitZ()},
      {"a peg [left", 2, {{0, 0, 0}}, -Eigen::Vector3d::UnitZ()}};
  return robot;
}

Phase Bearing(const std::vector<std::string>& contacts) {
  Phase phase;
  phase.contacts = contacts;
  return phase;
}

std::string RefusalOf(const std::vector<std::string>& contacts) {
  try {
    BearingPatches(TwoPatches(), Bearing(contacts));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ContactName, ParsesAPatchWithOrWithoutPoints) {
  EXPECT_EQ(ParseContactName("left_sole").patch, "left_sole");
  EXPECT_FALSE(ParseContactName("left_sole").points.has_value());
  EXPECT_EQ(ParseContactName("left_sole[0,3]").patch, "left_sole");
  EXPECT_EQ(ParseContactName("left_sole[0,3]").points, (std::vector<int>{0, 3}));
  EXPECT_EQ(ParseContactName("a [b][10]").patch, "a [b]");
  EXPECT_EQ(ParseContactName("a [b][10]").points, (std::vector<int>{10}));
}

TEST(ContactName, ParsesBackAsFormatted) {
  std::mt19937 generator(31);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<int> points;
    int point = static_cast<int>(generator() % 3);
    for (int i = 0; i <= trial % 5; ++i) {
      points.push_back(point);
      point += 1 + static_cast<int>(generator() % 20);
    }
    const ContactName name = ParseContactName(FormatContactName("left sole", points));
    EXPECT_EQ(name.patch, "left sole");
    EXPECT_EQ(name.points, points);
  }
}

TEST(BearingPatches, AreFoundByNameInOrder) {
  const auto bearing = BearingPatches(TwoPatches(), Bearing({"a peg [left", "sole[1,2]"}));
  ASSERT_EQ(bearing.size(), 2u);
  EXPECT_EQ(bearing[0].patch, 1);
  EXPECT_EQ(bearing[0].points, (std::vector<int>{0}));
  EXPECT_EQ(bearing[1].patch, 0);
  EXPECT_EQ(bearing[1].points, (std::vector<int>{1, 2}));
  EXPECT_EQ(CountPoints(TwoPatches(), Bearing({"a peg [left", "sole[1,2]"})), 3);
  EXPECT_EQ(CountPoints(TwoPatches(), Bearing({"sole"})), 4);
  EXPECT_EQ(CountPoints(TwoPatches(), Bearing({})), 0);
}

TEST(BearingPatches, AreAPatchOfTheirPoints) {
  const models::RobotModel robot = TwoPatches();
  const models::ContactPatch part = PatchOf(robot, {0, {1, 2}});
  EXPECT_EQ(part.link, 1);
  EXPECT_EQ(part.points, (std::vector<Eigen::Vector3d>{{1, 0, 0}, {1, 1, 0}}));
  EXPECT_EQ(part.normal_L, robot.contacts[0].normal_L);
  EXPECT_EQ(PatchOf(robot, {1, {0}}).points, robot.contacts[1].points);
}

TEST(BearingPatches, RefuseUnknownRepeatedAndUnorderedContacts) {
  EXPECT_NE(RefusalOf({"tail"}).find("\"tail\" unknown"), std::string::npos);
  EXPECT_NE(RefusalOf({"tail[0]"}).find("\"tail[0]\" unknown"), std::string::npos);
  EXPECT_NE(RefusalOf({"sole[3,4]"}).find("points from 0 to 3"), std::string::npos);
  EXPECT_NE(RefusalOf({"sole", "sole"}).find("twice"), std::string::npos);
  EXPECT_NE(RefusalOf({"sole[0]", "a peg [left", "sole[1]"}).find("twice"), std::string::npos);
  EXPECT_NE(RefusalOf({"sole[1,0]"}).find("ascending"), std::string::npos);
  EXPECT_EQ(RefusalOf({"sole[0,1,2,3]", "a peg [left"}), "");
}

}  // namespace
}  // namespace possibility::actions
