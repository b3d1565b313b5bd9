#include "models/input/yaml_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

YamlNode Parse(const std::string& text) { return YamlNode::Parse(text, "a.yaml"); }

std::string ErrorOf(const std::string& text) {
  try {
    Parse(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(YamlReader, ReadsEveryType) {
  const YamlNode root = Parse(
      "text: some words\nflag: true\nnumber: +1.5e2\nangle: -90\ncount: 42\nvector: [1, -2, .5]\n"
      "interval: [-1, 2]\nlist: [a, b]\n");
  EXPECT_EQ(root.At("text").String(), "some words");
  EXPECT_TRUE(root.At("flag").Boolean());
  EXPECT_EQ(root.At("number").Number(), 150);
  EXPECT_NEAR(root.At("angle").Degrees(), -M_PI / 2, 1e-15);
  EXPECT_EQ(root.At("count").Integer(0, 42), 42u);
  EXPECT_EQ(root.At("vector").Vector3(), Eigen::Vector3d(1, -2, 0.5));
  EXPECT_EQ(root.At("interval").Interval(), Eigen::Vector2d(-1, 2));
  EXPECT_EQ(root.At("list").Strings(), (std::vector<std::string>{"a", "b"}));
  EXPECT_FALSE(root.Find("missing").has_value());
  EXPECT_EQ(root.Entries().size(), 8u);
}

TEST(YamlReader, MalformedNumbersAreRefused) {
  for (const std::string bad : {"1.0m", "0x10", "1,5", "--1", "+-1", "1 2", "''", "true", "1e",
                                "[1]", "{a: 1}", "", "1e999"}) {
    EXPECT_THROW(Parse("a: " + bad).At("a").Number(), InputError) << bad;
  }
}

TEST(YamlReader, RefusesNoneOrSeveralDocuments) {
  EXPECT_EQ(ErrorOf(""), "a.yaml: expected a YAML map, got nothing");
  EXPECT_EQ(ErrorOf("~"), "a.yaml: expected a YAML map, got nothing");
  EXPECT_EQ(ErrorOf("a: 1\n---\nb: 2\n"),
            "a.yaml: expected one YAML document and nothing after it");
  EXPECT_EQ(ErrorOf(", a: 1"), "a.yaml: expected a YAML map, got nothing");
  EXPECT_EQ(ErrorOf("a: 1\n...\n, b: 1"),
            "a.yaml: expected one YAML document and nothing after it");
}

TEST(YamlReader, ErrorsNameTheLineOfTheKey) {
  const YamlNode root = Parse("a:\n  b:\n    - 1\n    - x\n  c:\n");
  const auto message = [](auto read) -> std::string {
    try {
      read();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([&] { root.At("a").At("b").Items()[1].Number(); }),
            "a.yaml:4: a.b[1]: expected a number, got x");
  EXPECT_EQ(message([&] { root.At("a").At("c").Number(); }),
            "a.yaml:5: a.c: expected a number, got nothing");
  EXPECT_EQ(message([&] { root.At("a").MapOf({"b", "d"}); }), "a.yaml:5: a: unknown key 'c'");
}

TEST(YamlReader, MessagesAreOneShortLine) {
  const YamlNode root = Parse("a: \"two\\nlines\"\nb: " + std::string(1000, 'x') + "\n");
  for (const std::string key : {"a", "b"}) {
    try {
      root.At(key).Number();
      FAIL();
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      EXPECT_LT(std::string(error.what()).size(), 120u);
    }
  }
}

// A recursive alias is a map that contains itself. Reading by a schema must end all the same.
TEST(YamlReader, SurvivesRecursiveAliases) {
  const YamlNode root = Parse("a: &x {a: *x}");
  EXPECT_THROW(root.At("a").At("a").At("a").Number(), InputError);
}

}  // namespace
}  // namespace possibility::models
