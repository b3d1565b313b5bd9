#include "experiments/trials/expression.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <locale>
#include <random>
#include <string>

#include "models/input/input_error.h"
#include "tests/message_of.h"

namespace possibility::experiments {
namespace {

double Evaluate(const std::string& text) {
  return EvaluateExpression(text, {{"gap", 0.4}, {"_n2", 3}, {"e", 2}});
}

std::string Message(const std::string& text) {
  return MessageOf<InputError>([&] { Evaluate(text); });
}

TEST(Expression, EvaluatesPrecedenceAndNames) {
  EXPECT_EQ(Evaluate("1 + 2 * 3"), 7);
  EXPECT_EQ(Evaluate("(1 + 2) * 3"), 9);
  EXPECT_EQ(Evaluate("8 / 4 / 2"), 1);
  EXPECT_EQ(Evaluate("8 - 4 - 2"), 2);
  EXPECT_EQ(Evaluate("-2 * -3"), 6);
  EXPECT_EQ(Evaluate("--2"), 2);
  EXPECT_EQ(Evaluate("-+ -2"), 2);
  EXPECT_EQ(Evaluate("1 - -2"), 3);
  EXPECT_EQ(Evaluate("1---2"), -1);
  EXPECT_EQ(Evaluate("8 / -4 / 2"), -1);
  EXPECT_EQ(Evaluate("-8 / --4 - 2 * -3"), 4);
  EXPECT_EQ(Evaluate("1.5e-2"), 0.015);
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
  for (const char* bad :
       {"",        " ",      "1 +",  "* 2",        "(1",          "1)",     "1 2",
        "gap gap", "2 ** 3", "1,5",  "1 / 0",      "0 / 0",       "nosuch", "1e999",
        "inf",     "nan",    "$",    "1 + ${gap}", "1 / (1 / 0)", "1e--2",  "()",
        "(1)(2)",  "gap(1)", "1..2", "0x10"}) {
    EXPECT_THROW(Evaluate(bad), InputError) << bad;
  }
  EXPECT_THROW(Evaluate(std::string(100000, '(')), InputError);
  EXPECT_THROW(Evaluate(std::string(100000, '-')), InputError);
  EXPECT_EQ(Message("gapp + 1"),
            "there is no 'gapp' in 'gapp + 1', expected one of _n2, e, gap (did you mean 'gap'?)");
  EXPECT_EQ(Message("1 +"), "'1 +': expected a number, a name or '(' at the end");
  EXPECT_EQ(Message(""), "'': expected a number, a name or '(' at the end");
  EXPECT_EQ(Message("- "), "'- ': expected a number, a name or '(' at the end");
  EXPECT_EQ(Message("(1"), "'(1': expected ')' at the end");
  EXPECT_EQ(Message("1)"), "'1)': unexpected ')' at character 2");
  EXPECT_EQ(Message("1 2"), "'1 2': unexpected '2' at character 3");
  EXPECT_EQ(Message("2 ** 3"), "'2 ** 3': unexpected '* 3' at character 4");
  EXPECT_EQ(Message("1e999"), "'1e999': unexpected '1e999' at character 1");
  EXPECT_EQ(Message("1 / 0"), "'1 / 0' is not finite, expected a number");
  EXPECT_EQ(Message("1,5"), "'1,5': expected a digit, a letter, + - * / ( or ) at character 2");
}

// What muParser knows by itself.
TEST(Expression, NothingElseOfMuParserIsAllowed) {
  for (const char* foreign :
       {"sin(1)",  "sqrt(4)",  "min(1, 2)", "sum(1)", "rnd()",  "_pi",    "_e",
        "2 ^ 3",   "1 < 2",    "1 == 1",    "1 != 2", "1 && 1", "1 || 0", "1 ? 2 : 3",
        "gap = 3", "gap += 1", "1, 2",      "\"a\"",  "!1",     "1;2",    "1\n+1"}) {
    EXPECT_THROW(Evaluate(foreign), InputError) << foreign;
  }
  EXPECT_THROW(Evaluate(std::string("1\0+", 3)), InputError);
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Expression, TheLocaleDoesNotMatter) {
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  EXPECT_EQ(Evaluate("1.5 + 2000.25"), 2001.75);
  EXPECT_THROW(Evaluate("1,5"), InputError);
  std::locale::global(before);
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
