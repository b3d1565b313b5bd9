#include "models/input/action_name.h"

#include <gtest/gtest.h>

#include <string>

namespace possibility::models {
namespace {

TEST(ActionName, AcceptsShortNamesOfLettersDigitsAndTwoSigns) {
  for (const std::string& name : {std::string("walk"), std::string("step_up"), std::string("X"),
                                  std::string("jump-2"), std::string(64, 'a')}) {
    EXPECT_TRUE(IsActionName(name)) << name;
  }
}

TEST(ActionName, RefusesMarkupPathsAndControlCharacters) {
  for (const std::string& name :
       {std::string(), std::string("<b>"), std::string("../walk"), std::string("a/b"),
        std::string("walk\0", 5), std::string("\0", 1), std::string("a b"), std::string("a\n"),
        std::string("\x1b[2J"), std::string("walk->crawl"), std::string("2walk"),
        std::string("_walk"), std::string("-walk"), std::string("w\xc3\xa4lk"), std::string("%s"),
        std::string(65, 'a')}) {
    EXPECT_FALSE(IsActionName(name)) << name;
  }
}

}  // namespace
}  // namespace possibility::models
