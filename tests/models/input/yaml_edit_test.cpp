#include "models/input/yaml_edit.h"

#include <gtest/gtest.h>

#include "models/input/input_error.h"
#include "tests/message_of.h"

namespace possibility::models {
namespace {

const std::string kCommented = R"(# a robot
gaits:
  - name: stand
  - name: walk  # on two feet
    posture: {height: 1.5, joints: {LHP: -10, "R P": 2}}  # deg
    parameters:
      forward: 0.2   # m
      turn: 3
)";

TEST(YamlEdit, OnlyTheValuesChange) {
  const std::string edited = WithYamlEdits(kCommented, "robot.yaml",
                                           {{{"gaits", "1", "posture", "height"}, "0.75"},
                                            {{"gaits", "1", "posture", "joints", "R P"}, "-22.5"},
                                            {{"gaits", "1", "parameters", "forward"}, "1"},
                                            {{"gaits", "1", "name"}, "run"}});
  EXPECT_EQ(edited, R"(# a robot
gaits:
  - name: stand
  - name: run  # on two feet
    posture: {height: 0.75, joints: {LHP: -10, "R P": -22.5}}  # deg
    parameters:
      forward: 1   # m
      turn: 3
)");
}

TEST(YamlEdit, AMissingLastKeyIsAdded) {
  const std::string edited = WithYamlEdits(kCommented, "robot.yaml",
                                           {{{"gaits", "1", "posture", "joints", "LKP"}, "4"},
                                            {{"gaits", "1", "parameters", "x"}, "5"}});
  EXPECT_NE(edited.find(R"(joints: {"LKP": 4, LHP: -10)"), std::string::npos) << edited;
  EXPECT_NE(edited.find("parameters:\n      \"x\": 5\n      forward: 0.2   # m\n"),
            std::string::npos)
      << edited;
  EXPECT_EQ(WithYamlEdits("a: {}\n", "a.yaml", {{{"a", "b"}, "1"}}), "a: {\"b\": 1}\n");
}

TEST(YamlEdit, CharactersOfSeveralBytesStayWhereTheyAre) {
  EXPECT_EQ(WithYamlEdits("# größer → 10 µm\na: \"ü\"\nb: 1 # ü\n", "a.yaml", {{{"b"}, "2"}}),
            "# größer → 10 µm\na: \"ü\"\nb: 2 # ü\n");
}

TEST(YamlEdit, WhatCannotBeEditedIsNamed) {
  const auto message = [](const std::string& text, const std::vector<std::string>& path) {
    return MessageOf<InputError>([&] { WithYamlEdits(text, "a.yaml", {{path, "1"}}); });
  };
  EXPECT_EQ(message(kCommented, {"gaits", "2", "name"}), "a.yaml: gaits.2.name: no such key");
  EXPECT_EQ(message(kCommented, {"gaits", "x"}), "a.yaml: gaits.x: no such key");
  EXPECT_EQ(message(kCommented, {"gaits"}), "a.yaml: gaits: expected a number");
  EXPECT_EQ(message("a: \"1\"\n", {"a"}), "a.yaml: a: expected a plain number");
  EXPECT_EQ(message("a: [1\n", {"a"}).find("a.yaml: not valid YAML"), 0u);
}

}  // namespace
}  // namespace possibility::models
