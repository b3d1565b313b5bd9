#include "models/facts/srdf_reader.h"

#include <gtest/gtest.h>

#include <random>

#include "models/input/input_error.h"
#include "tests/message_of.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

const std::string kSrdf = R"(<?xml version="1.0"?>
<robot name="two_legged">
  <virtual_joint name="world" type="floating" parent_frame="map" child_link="base"/>
  <group name="left_leg"><chain base_link="base" tip_link="l_foot"/></group>
  <group name="all"><joint name="l_yaw"/><joint name="world"/><link name="tool"/>
    <group name="left_leg"/></group>
  <group_state name="half_sitting" group="all">
    <joint name="world" value="0 0 1 0 0 0 1"/>
    <joint name="l_yaw" value="0.25"/>
    <joint name="mount" value="1"/>
  </group_state>
  <end_effector name="foot" parent_link="l_foot" group="left_leg"/>
  <disable_collisions link1="base" link2="tool" reason="Adjacent"/>
  <disable_collisions link1="base" link2="antenna" reason="Never"/>
</robot>
)";

Srdf Parsed(const std::string& text) {
  return ParseSrdf(text, "a.srdf", ParseUrdf(TwoLeggedUrdf(), "robot.urdf"));
}

TEST(SrdfReader, ReadsWhatIsThere) {
  const Srdf srdf = Parsed(kSrdf);
  ASSERT_EQ(srdf.groups.size(), 2u);
  EXPECT_EQ(srdf.groups[0].chains.front(), std::pair(std::string("base"), std::string("l_foot")));
  EXPECT_EQ(srdf.groups[1].joints, std::vector<std::string>{"l_yaw"});
  EXPECT_EQ(srdf.groups[1].links, std::vector<std::string>{"tool"});
  EXPECT_EQ(srdf.groups[1].groups, std::vector<std::string>{"left_leg"});
  ASSERT_EQ(srdf.states.size(), 1u);
  EXPECT_EQ(srdf.states[0].group, "all");
  EXPECT_EQ(srdf.states[0].joints, (std::map<std::string, double>{{"l_yaw", 0.25}}));
  ASSERT_EQ(srdf.end_effectors.size(), 1u);
  EXPECT_EQ(srdf.end_effectors[0].parent_link, "l_foot");
  // Files are shared by variants of a robot: pairs of links that this one lacks do not matter.
  ASSERT_EQ(srdf.disabled.size(), 1u);
  EXPECT_EQ(srdf.disabled[0].reason, "Adjacent");
}

TEST(SrdfReader, EachFaultIsNamedInOneLine) {
  const auto error = [](const std::string& from, const std::string& to) {
    return MessageOf<InputError>([&] { Parsed(Replaced(kSrdf, from, to)); });
  };
  EXPECT_EQ(error("</robot>", ""), "a.srdf:2: not a valid SRDF: no XML (XML_ERROR_PARSING)");
  EXPECT_EQ(MessageOf<InputError>([] { Parsed("<urdf/>"); }),
            "a.srdf:1: not a valid SRDF: expected a <robot> element");
  EXPECT_EQ(error("tip_link=\"l_foot\"", "tip_link=\"toe\""),
            "a.srdf:4: <chain>: unknown link 'toe'");
  EXPECT_EQ(error("value=\"0.25\"", "value=\"a\""),
            "a.srdf:9: <joint>: value: expected a number, got 'a'");
  EXPECT_EQ(error("value=\"0.25\"", "value=\"nan\""),
            "a.srdf:9: <joint>: value: expected a number, got 'nan'");
  EXPECT_EQ(error("name=\"all\"", "name=\"left_leg\""),
            "a.srdf:5: <group>: 'left_leg' is already taken");
  EXPECT_EQ(error("group name=\"all\"", "group"), "a.srdf:5: <group>: expected a name");
  EXPECT_EQ(error("parent_link=\"l_foot\"", ""),
            "a.srdf:12: <end_effector>: expected a parent_link");
}

TEST(SrdfReader, SpoiltFilesGiveOneLine) {
  std::mt19937 random(51);
  int refused = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::string text = kSrdf;
    for (int i = 0; i < 3; ++i) text[random() % text.size()] = static_cast<char>(random() % 256);
    const std::string error = MessageOf<InputError>([&] { Parsed(text); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    refused += error != "no error";
  }
  EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace possibility::models
