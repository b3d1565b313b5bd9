#include "experiments/trials/expression.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

double Evaluate(const std::string& text) {
  return EvaluateExpression(text, {{"gap", 0.4}, {"_n2", 3}, {"e", 2}});
}

TEST(Expression, EvaluatesPrecedenceAndNames) {
  EXPECT_EQ(Evaluate("1 + 2 * 3"), 7);
  EXPECT_EQ(Evaluate("(1 + 2) * 3"), 9);
  EXPECT_EQ(Evaluate("8 / 4 / 2"), 1);
  EXPECT_EQ(Evaluate("8 - 4 - 2"), 2);
  EXPECT_EQ(Evaluate("-2 * -3"), 6);
  EXPECT_EQ(Evaluate("--2"), 2);
  EXPECT_EQ(Evaluate("-(1 - 3)"), 2);
  EXPECT_DOUBLE_EQ(Evaluate("gap + 0.5"), 0.9);
  EXPECT_DOUBLE_EQ(Evaluate(" ( gap+_n2)/e "), 1.7);
  EXPECT_DOUBLE_EQ(Evaluate("1.5e2"), 150);
}

/// A random expression and its value, computed while it is built.
std::pair<std::string, double> RandomExpression(int depth, std::mt19937* random) {
  if (depth == 0 || (*random)() % 5 == 0) {
    const double number = static_cast<double>((*random)() % 1000) / 8;
    return {fmt::format("{}", number), number};
  }
  const auto [left, a] = RandomExpression(depth - 1, random);
  const auto [right, b] = RandomExpression(depth - 1, random);
  switch ((*random)() % 4) {
    case 0:
      return {"(" + left + "+" + right + ")", a + b};
    case 1:
      return {"( " + left + " - " + right + ")", a - b};
    case 2:
      return {"(" + left + ") *(" + right + " )", a * b};
    default:
      return {"(-" + left + ")", -a};
  }
}

TEST(Expression, AgreesWithTheMachineOnRandomExpressions) {
  std::mt19937 random(2);
  for (int round = 0; round < 2000; ++round) {
    const auto [text, value] = RandomExpression(5, &random);
    // "a * b" within a sum has no brackets around it.
    EXPECT_EQ(Evaluate("(" + text + ")"), value) << text;
  }
}

TEST(Expression, ErrorsNameTheFault) {
  for (const char* bad : {"", " ", "1 +", "* 2", "(1", "1)", "1 2", "gap gap", "2 ** 3", "1,5",
                          "1 / 0", "0 / 0", "nosuch", "1e999", "inf", "nan", "$", "1 + ${gap}"}) {
    EXPECT_THROW(Evaluate(bad), InputError) << bad;
  }
  EXPECT_THROW(Evaluate(std::string(100000, '(')), InputError);
  EXPECT_THROW(Evaluate(std::string(100000, '-')), InputError);
  try {
    Evaluate("gapp + 1");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'gap'"), std::string::npos)
        << error.what();
  }
}

TEST(Expression, NeverCrashesOnRandomText) {
  std::mt19937 random(3);
  const std::string letters = "01.e+-*/() gap";
  for (int round = 0; round < 20000; ++round) {
    std::string text;
    for (unsigned i = 0; i < 1 + round % 12u; ++i) text += letters[random() % letters.size()];
    try {
      EXPECT_TRUE(std::isfinite(Evaluate(text))) << text;
    } catch (const InputError&) {
    }
  }
}

}  // namespace
}  // namespace possibility::experiments
