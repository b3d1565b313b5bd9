#include "experiments/regression/regression_comparison.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using nlohmann::json;
using Kind = RegressionDifference::Kind;

json Problem(const std::string& name) {
  return {{"name", name},
          {"status", "solved"},
          {"optimum", "global"},
          {"objective", 2.0},
          {"iterations", 20},
          {"relative_error", 1e-7},
          {"seconds", {{"total", 0.1}}}};
}

json RunOf(const std::vector<json>& problems) {
  return {{"format", "possibility-regress/1"}, {"problems", problems}};
}

/// Compares a problem with itself after `members` have been replaced in the copy.
RegressionComparison After(const json& members) {
  json changed = Problem("hop");
  changed.update(members);
  return CompareRegressions(RunOf({Problem("hop")}), RunOf({changed}));
}

/// The differences, e.g. "worse iterations".
std::vector<std::string> Kinds(const RegressionComparison& comparison) {
  std::vector<std::string> kinds;
  for (const auto& difference : comparison.differences) {
    const char* kind = difference.kind == Kind::kWorse    ? "worse "
                       : difference.kind == Kind::kSlower ? "slower "
                                                          : "note ";
    kinds.push_back(kind + difference.what);
  }
  return kinds;
}

using Strings = std::vector<std::string>;

TEST(RegressionComparison, ARunEqualsItself) {
  const json run = RunOf({Problem("hop"), Problem("swing")});
  EXPECT_EQ(Kinds(CompareRegressions(run, run)), Strings{});
  EXPECT_FALSE(CompareRegressions(run, run).failed());
}

TEST(RegressionComparison, MoreThanTenPerCentMoreIterationsAreWorse) {
  EXPECT_EQ(Kinds(After({{"iterations", 22}})), Strings{});
  const RegressionComparison worse = After({{"iterations", 23}});
  EXPECT_EQ(Kinds(worse), Strings{"worse iterations"});
  EXPECT_TRUE(worse.failed());
  EXPECT_EQ(worse.differences[0].problem, "hop");
  EXPECT_EQ(worse.differences[0].text, "iterations 20, now 23 (+15 %)");
  EXPECT_EQ(Kinds(After({{"iterations", 3}})), Strings{});
}

TEST(RegressionComparison, SecondsAreReportedButNeverFail) {
  EXPECT_EQ(Kinds(After({{"seconds", {{"total", 0.129}}}})), Strings{});
  const RegressionComparison slower = After({{"seconds", {{"total", 0.2}}}});
  EXPECT_EQ(Kinds(slower), Strings{"slower seconds"});
  EXPECT_FALSE(slower.failed());
}

TEST(RegressionComparison, DifferencesUnderFiveMillisecondsAreNotReported) {
  json before = Problem("hop"), after = Problem("hop");
  before["seconds"]["total"] = 0.001;
  after["seconds"]["total"] = 0.0055;
  EXPECT_EQ(Kinds(CompareRegressions(RunOf({before}), RunOf({after}))), Strings{});
  after["seconds"]["total"] = 0.0065;
  EXPECT_EQ(Kinds(CompareRegressions(RunOf({before}), RunOf({after}))), Strings{"slower seconds"});
}

TEST(RegressionComparison, AnErrorBeyondTheSolversToleranceIsWorse) {
  EXPECT_EQ(Kinds(After({{"relative_error", 1.09e-7}})), Strings{});
  EXPECT_EQ(Kinds(After({{"relative_error", 1.2e-7}})), Strings{"worse error"});
  json before = Problem("hop");
  before["relative_error"] = 1e-15;
  json after = Problem("hop");
  after["relative_error"] = 9e-9;
  EXPECT_EQ(Kinds(CompareRegressions(RunOf({before}), RunOf({after}))), Strings{});
}

TEST(RegressionComparison, AFailureIsWorseAndNamesItsStatus) {
  const RegressionComparison failed = After({{"status", "infeasible"},
                                             {"optimum", nullptr},
                                             {"objective", nullptr},
                                             {"relative_error", nullptr}});
  EXPECT_EQ(Kinds(failed), (Strings{"worse status", "worse optimum"}));
  EXPECT_EQ(failed.differences[0].text, "status solved, now infeasible");
  EXPECT_EQ(Kinds(After({{"status", "acceptable"}})), Strings{"worse status"});
}

TEST(RegressionComparison, ARepairedProblemMayTakeLonger) {
  json before = Problem("hop");
  before.update({{"status", "failed"}, {"optimum", nullptr}, {"iterations", 2}});
  EXPECT_EQ(Kinds(CompareRegressions(RunOf({before}), RunOf({Problem("hop")}))), Strings{});
}

TEST(RegressionComparison, AMinimumThatBecomesASaddleIsWorse) {
  json minimum = Problem("hop"), other = Problem("hop");
  minimum["stationary_point"] = "minimum";
  other["stationary_point"] = "saddle";
  const auto kinds = [](const json& before, const json& after) {
    return Kinds(CompareRegressions(RunOf({before}), RunOf({after})));
  };
  EXPECT_EQ(kinds(minimum, other), Strings{"worse stationary point"});
  EXPECT_EQ(kinds(other, minimum), Strings{});
  other["stationary_point"] = "unknown";
  EXPECT_EQ(kinds(minimum, other), Strings{"note stationary point"});
  // Files from before the second-order check say nothing.
  EXPECT_EQ(kinds(minimum, Problem("hop")), Strings{});
  EXPECT_EQ(kinds(Problem("hop"), minimum), Strings{});
  other["stationary_point"] = 1;
  EXPECT_THROW(kinds(minimum, other), InputError);
}

TEST(RegressionComparison, AnotherOptimumIsWorseIfItsObjectiveIsHigher) {
  const RegressionComparison higher =
      After({{"optimum", "second basin"}, {"objective", 2.1}, {"relative_error", 1e-5}});
  EXPECT_EQ(Kinds(higher), Strings{"worse optimum"});
  EXPECT_EQ(higher.differences[0].text,
            "met optimum 'global', now 'second basin' (objective 2, now 2.1)");
  EXPECT_EQ(Kinds(After({{"optimum", "lower"}, {"objective", 1.9}})), Strings{"note optimum"});
}

TEST(RegressionComparison, LostProblemsFailAndNewOnesAreNoted) {
  const json before = RunOf({Problem("hop"), Problem("swing")});
  const json after = RunOf({Problem("hop"), Problem("sit")});
  const RegressionComparison comparison = CompareRegressions(before, after);
  EXPECT_EQ(Kinds(comparison), (Strings{"worse problem", "note problem"}));
  EXPECT_EQ(comparison.differences[0].problem, "swing");
  EXPECT_EQ(comparison.differences[1].problem, "sit");
  EXPECT_TRUE(comparison.failed());
  EXPECT_EQ(Kinds(CompareRegressions(before, after, false)), Strings{"note problem"});
}

TEST(RegressionComparison, OtherOptionsAndMachinesAreNoted) {
  json before = RunOf({Problem("hop")}), after = before;
  before["options"] = {{"linear_solver", "ldlt"}, {"intervals", nullptr}};
  after["options"] = {{"linear_solver", "mumps"}, {"intervals", nullptr}};
  after["environment"] = {{"cpu", "another"}};
  const RegressionComparison comparison = CompareRegressions(before, after);
  EXPECT_EQ(Kinds(comparison), (Strings{"note environment", "note options"}));
  EXPECT_EQ(comparison.differences[1].text, "options: linear_solver was \"ldlt\", now \"mumps\"");
  EXPECT_FALSE(comparison.failed());
}

TEST(RegressionComparison, TextAndJsonHoldTheSameDifferences) {
  const RegressionComparison worse = After({{"iterations", 40}, {"seconds", {{"total", 1.0}}}});
  EXPECT_EQ(worse.Text(),
            "worse   hop: iterations 20, now 40 (+100 %)\n"
            "slower  hop: 0.1000 s, now 1.0000 s (+900 %)\n"
            "1 thing got worse\n");
  const auto object = worse.Json();
  EXPECT_TRUE(object["failed"].get<bool>());
  ASSERT_EQ(object["differences"].size(), 2u);
  EXPECT_EQ(object["differences"][0]["kind"], "worse");
  EXPECT_EQ(object["differences"][1]["what"], "seconds");
}

/// Every member that is missing or of another type gives an error of one line that names the
/// member.
TEST(RegressionComparison, RejectsAMalformedRun) {
  const json good = RunOf({Problem("hop")});
  const auto rejects = [&](const json& bad, const std::string& culprit) {
    try {
      CompareRegressions(bad, good);
      ADD_FAILURE() << bad;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(culprit), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    }
  };
  for (const json& bad : {json(), json(1), json::array(), json::object()}) rejects(bad, "format");
  json other = good;
  other["format"] = "possibility-regress/2";
  rejects(other, "possibility-regress/1");
  const json members = Problem("hop");
  for (const auto& [key, value] : members.items()) {
    json without = good, wrong = good;
    without["problems"][0].erase(key);
    wrong["problems"][0][key] = json::array();
    rejects(without, "'" + key + "'");
    rejects(wrong, "'" + key + "'");
  }
  json negative = good;
  negative["problems"][0]["iterations"] = -1;
  rejects(negative, "'iterations'");
  rejects(RunOf({Problem("hop"), Problem("hop")}), "twice");
  rejects(RunOf({json(3)}), "problems[0]");
}

TEST(RegressionComparison, FilesThatCannotBeUsedAreNamed) {
  const auto file = std::filesystem::temp_directory_path() / "possibility_regression_file.json";
  const auto error = [&](const std::string& content) -> std::string {
    std::ofstream(file) << content;
    try {
      ReadRegressionFile(file);
    } catch (const InputError& failure) {
      return failure.what();
    }
    return "";
  };
  for (const char* content : {"", "{", "[]", "{\"format\": 1}", "\xff\xfe"}) {
    EXPECT_EQ(error(content).find(file.string() + ": "), 0u) << content;
  }
  EXPECT_EQ(error(RunOf({Problem("hop")}).dump()), "");
  std::filesystem::remove(file);
  EXPECT_THROW(ReadRegressionFile(file), InputError);
  EXPECT_THROW(ReadRegressionFile(file.parent_path()), InputError);
}

}  // namespace
}  // namespace possibility::experiments
