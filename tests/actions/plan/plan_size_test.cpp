// Plan files are short: they leave out digits that carry nothing and, in long plans, repetitions.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>

#include "actions/plan/plan.h"
#include "actions/plan/plan_digits.h"
#include "actions/plan/plan_writer.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

std::string Rounded(double x, int decimals) {
  std::string text;
  AppendRounded(x, decimals, &text);
  return text;
}

TEST(PlanDigits, AreTheFewestOfTheRoundedNumber) {
  EXPECT_EQ(Rounded(0, 9), "0");
  EXPECT_EQ(Rounded(-0.0, 9), "0");
  EXPECT_EQ(Rounded(-1e-12, 9), "0");
  EXPECT_EQ(Rounded(1, 9), "1");
  EXPECT_EQ(Rounded(100, 7), "100");
  EXPECT_EQ(Rounded(0.1 + 0.2, 10), "0.3");
  EXPECT_EQ(Rounded(-0.12345678949, 10), "-0.1234567895");
  EXPECT_EQ(Rounded(123456.123456789, 7), "123456.123457");
  EXPECT_EQ(Rounded(9.99999999996, 10), "10");
  EXPECT_EQ(Rounded(1e300, 10), "1e+300");
  EXPECT_THROW(Rounded(std::nan(""), 9), std::invalid_argument);
  EXPECT_THROW(Rounded(INFINITY, 9), std::invalid_argument);
}

TEST(PlanDigits, RoundingTwiceChangesNothing) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> magnitude(-14, 18);
  for (int i = 0; i < 20000; ++i) {
    const double x = (random() % 2 == 0 ? 1 : -1) * std::pow(10, magnitude(random));
    const int decimals = 7 + static_cast<int>(random() % 4);
    const std::string text = Rounded(x, decimals);
    const double read = std::stod(text);
    EXPECT_EQ(Rounded(read, decimals), text) << x;
    const double rounded = actions::Rounded(x, decimals);
    EXPECT_EQ(std::stod(Rounded(rounded, decimals)), rounded) << x;
    EXPECT_LE(std::abs(read - x), std::max(0.51 * std::pow(10, -decimals), 6e-12 * std::abs(x)));
  }
}

Knot KnotOfManyDigits(double t, std::mt19937* random) {
  std::normal_distribution<double> normal;
  const auto vector = [&](Eigen::Index size) {
    return Eigen::VectorXd::NullaryExpr(size, [&] { return normal(*random); });
  };
  Knot knot{t, vector(9), vector(8), vector(8), vector(2), Eigen::Matrix3Xd(3, 4)};
  knot.q.head<4>().normalize();
  knot.forces.reshaped() = vector(12);
  return knot;
}

/// A gait of 100 steps of so many knots each. The steps differ only in where they are.
Plan RepeatedSteps(int num_knots) {
  std::mt19937 random(7);
  Phase step{{"foot"}, {}};
  for (int k = 0; k < num_knots; ++k) step.knots.push_back(KnotOfManyDigits(0.01 * k, &random));
  for (Knot& knot : step.knots) knot.q[8] = 0.5;
  Plan plan;
  plan.joints = {"a", "b"};
  plan.segments = {{"walk", {}}};
  const double duration = step.knots.back().t;
  for (int i = 0; i < 100; ++i) {
    Phase phase = step;
    for (Knot& knot : phase.knots) {
      knot.t += duration * i;
      knot.q[4] += 0.3 * i;
    }
    plan.segments[0].phases.push_back(phase);
  }
  plan.segments[0].phases[1].impulses = Eigen::Matrix3Xd::Random(3, 4);
  return plan;
}

class LongPlanFile : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string Written(const Plan& plan) const {
    WritePlan(plan, folder_ / "plan.json");
    return models::ReadFileContents(folder_ / "plan.json");
  }
  void ExpectRefused(const std::function<void(json*)>& change, const std::string& words) const {
    json document = whole_;
    change(&document);
    try {
      ParsePlan(document.dump(), folder_ / "plan.json");
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("possibility_plan_size_" + std::to_string(::getpid()));
  const Plan short_ = RepeatedSteps(200);
  const Plan long_ = RepeatedSteps(201);
  json whole_;  ///< the long plan's document
};

TEST_F(LongPlanFile, WritesRepeatedSeriesOnce) {
  const std::string rows = Written(short_);
  const std::string courses = Written(long_);
  EXPECT_FALSE(json::parse(rows).contains("series"));
  EXPECT_TRUE(json::parse(courses).contains("series"));
  EXPECT_LT(courses.size(), rows.size() / 5);
}

TEST_F(LongPlanFile, ReadsBackTheSameAsAPlanInRows) {
  const std::string text = Written(long_);
  const Plan read = ParsePlan(text, folder_ / "plan.json");
  EXPECT_EQ(Written(read), text);
  ASSERT_EQ(read.segments[0].phases.size(), 100u);
  EXPECT_EQ(read.segments[0].phases[1].impulses.cols(), 4);
  for (std::size_t p = 0; p < 100; ++p) {
    // This part has few enough knots to be written as rows.
    Plan part = long_;
    part.segments[0].phases = {long_.segments[0].phases[p]};
    const Plan in_rows = ParsePlan(Written(part), folder_ / "plan.json");
    const auto& expected = in_rows.segments[0].phases[0].knots;
    const auto& knots = read.segments[0].phases[p].knots;
    ASSERT_EQ(knots.size(), expected.size());
    for (std::size_t k = 0; k < knots.size(); ++k) {
      EXPECT_EQ(knots[k].t, expected[k].t);
      EXPECT_EQ(knots[k].q, expected[k].q);
      EXPECT_EQ(knots[k].v, expected[k].v);
      EXPECT_EQ(knots[k].a, expected[k].a);
      EXPECT_EQ(knots[k].tau, expected[k].tau);
      EXPECT_EQ(knots[k].forces, expected[k].forces);
    }
  }
}

TEST_F(LongPlanFile, RefusesMalformedSeries) {
  whole_ = json::parse(Written(long_));
  ExpectRefused([](json* d) { (*d)["series"] = 1; }, "series: expected an array");
  ExpectRefused([](json* d) { (*d)["series"][3] = "x"; }, "series[3]");
  ExpectRefused([](json* d) { (*d)["series"][0] = {1}; }, "series[0]: expected a number or at");
  ExpectRefused([](json* d) { (*d)["segments"][0]["phases"][2]["v"][1] = 1000000; },
                "segments[0].phases[2].v[1]: expected an integer from 0 to");
  ExpectRefused([](json* d) { (*d)["segments"][0]["phases"][2]["v"][1] = -1; },
                "segments[0].phases[2].v[1]: expected an integer from 0 to");
  ExpectRefused([](json* d) { (*d)["segments"][0]["phases"][2]["v"].push_back(0); },
                "segments[0].phases[2].v: expected 8 indices, got 9");
  ExpectRefused([](json* d) { (*d)["segments"][0]["phases"][2]["forces"].push_back(0); },
                "segments[0].phases[2].forces: expected 3 indices per contact point, got 13");
  ExpectRefused([](json* d) { (*d)["segments"][0]["phases"][2]["t"].erase(0); },
                "expected the index of a series of 200 numbers as in t, got one of 201");
  ExpectRefused(
      [](json* d) {
        (*d)["segments"][0]["phases"][2]["q"][0] = 0;
        (*d)["segments"][0]["phases"][2]["q"][1] = 0;
      },
      "segments[0].phases[2].q: expected a unit quaternion");
  ExpectRefused(
      [](json* d) { (*d)["segments"][0]["phases"][0]["forces"] = std::vector<int>(1000002, 0); },
      "expected at most 2e+08 numbers");
  ExpectRefused([](json* d) { d->erase("series"); }, "segments[0].phases[0].q");
}

}  // namespace
}  // namespace possibility::actions
