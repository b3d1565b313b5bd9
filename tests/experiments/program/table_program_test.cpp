// Table, sweep and merge of the built program, also killed and resumed.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "experiments/trials/results_file.h"
#include "tests/experiments/program_run.h"
#include "tests/experiments/read_text.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using testing::ProgramRun;
using testing::ReadText;

/// Runs with small scenarios whose plans take only a moment.
class ExperimentProgram : public ProgramRun {
 protected:
  void SetUp() override {
    ProgramRun::SetUp();
    fs::create_directories(folder_ / "scenarios");
    WriteScenario("three_routes_a", "");
    WriteScenario("closed_room",
                  "    - {name: wall, shape: box, size: [0.2, 4, 2.2], position: [2, 0, 1.1]}\n",
                  "2.8");
  }

  /// A scenario of a few steps across a floor, with or without a way. Its time limit is for
  /// sanitizers, which are slow.
  void WriteScenario(const std::string& name, const std::string& obstacles,
                     const std::string& goal_x = "1.7") const {
    std::ofstream(folder_ / "scenarios" / (name + ".yaml"))
        << "name: " << name << "\nrobot: " POSSIBILITY_SOURCE_DIR
        << "/models/drchubo1/drchubo1.yaml\nactions: [walk]\n"
           "start: {action: walk, x: 1.2, y: 0, yaw_deg: 0}\n"
           "goal: {action: walk, x: "
        << goal_x
        << ", y: 0, yaw_deg: 0}\n"
           "time_limit: 1000\nenvironment:\n  bounds: {x: [0, 4], y: [-2, 2]}\n  ground:\n"
           "    - {name: floor, size: [4, 4, 0.5], position: [2, 0, -0.25]}\n  obstacles:\n"
           "    - {name: post, shape: box, size: [0.1, 0.1, 1], position: [0.1, 1.9, 0.5]}\n"
        << obstacles;
  }

  /// The records of a finished run, without what may differ between runs.
  std::vector<std::string> Facts(const fs::path& folder) const {
    std::vector<std::string> lines;
    for (TrialRecord record : ReadResults(folder_ / folder / "results.jsonl")) {
      record.timings = {};
      record.memory_mb = 0;
      record.real_time_ratio = {};
      lines.push_back(record.Json().dump());
    }
    return lines;
  }

  /// Runs a table to its end and kills it `kills` times at random moments.
  void RunKilled(const std::string& table, const fs::path& out, int kills, int longest_ms) const {
    std::mt19937 random(static_cast<unsigned>(kills));
    const std::string arguments = table + " --out " + out.string();
    int killed = 0;
    for (int i = 0; i < kills; ++i) {
      const pid_t child = Start(arguments);
      std::this_thread::sleep_for(
          std::chrono::milliseconds(20 + random() % static_cast<unsigned>(longest_ms)));
      ::kill(child, SIGKILL);
      if (Wait(child) == -1) ++killed;
    }
    EXPECT_GT(killed, 0);
    ASSERT_EQ(Run(arguments).code, 0) << Errors();
  }

  const std::string table_ = "table --scenarios scenarios --scenario three_routes_a_1 ";
};
using ExperimentProgramLong = ExperimentProgram;

TEST_F(ExperimentProgram, AKilledAndResumedTableEqualsAnUninterruptedOne) {
  const std::string table = table_ + "--trials 5 --threads 2";
  ASSERT_EQ(Run(table + " --out whole").code, 0) << Errors();
  RunKilled(table, "killed", 4, 300);
  EXPECT_EQ(Facts("killed"), Facts("whole"));
  ASSERT_EQ(Facts("whole").size(), 5u);
  const fs::path picture = fs::path("plans") / "three_routes_a_1_default.svg";
  EXPECT_EQ(ReadText(folder_ / "killed" / picture), ReadText(folder_ / "whole" / picture));
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "killed")) {
    EXPECT_NE(entry.path().extension(), ".unfinished") << entry.path();
  }
}

TEST_F(ExperimentProgramLong, ATableKilledTwentyTimesEqualsAnUninterruptedOne) {
  const std::string table = table_ + "--trials 20 --preset both --threads 2";
  ASSERT_EQ(Run(table + " --out whole").code, 0) << Errors();
  RunKilled(table, "killed", 20, 1200);
  EXPECT_EQ(Facts("killed"), Facts("whole"));
}

TEST_F(ExperimentProgram, AFinishedTableIsKeptAndMayBeExtended) {
  ASSERT_EQ(Run(table_ + "--trials 1 --out t").code, 0) << Errors();
  const std::string before = ReadText(folder_ / "t/results.jsonl");
  ASSERT_EQ(Run(table_ + "--trials 1 --out t --json").code, 0) << Errors();
  EXPECT_EQ(ReadText(folder_ / "t/results.jsonl"), before);
  EXPECT_EQ(nlohmann::ordered_json::parse(Output()),
            nlohmann::ordered_json::parse(ReadText(folder_ / "t/summary.json")));
  ASSERT_EQ(Run(table_ + "--trials 2 --out t").code, 0) << Errors();
  EXPECT_EQ(ReadText(folder_ / "t/results.jsonl").rfind(before, 0), 0u);
  EXPECT_EQ(Facts("t").size(), 2u);
}

TEST_F(ExperimentProgram, MergedShardsEqualOneRun) {
  ASSERT_EQ(Run(table_ + "--trials 5 --out whole").code, 0) << Errors();
  for (const char* shard : {"0/2", "1/2"}) {
    ASSERT_EQ(Run(table_ + "--trials 5 --shard " + shard + " --out part" + shard[0]).code, 0)
        << Errors();
  }
  EXPECT_EQ(Facts("part0").size() + Facts("part1").size(), 5u);
  ASSERT_EQ(Run("merge part1 part0 --out merged").code, 0) << Errors();
  EXPECT_EQ(Facts("merged"), Facts("whole"));
  ASSERT_EQ(Run("merge part0 --out merged").code, 0) << "again is no harm";
  EXPECT_EQ(Facts("merged"), Facts("whole"));
  for (const char* name : {"table.md", "report.html", "summary.json", "success.svg",
                           "plans/three_routes_a_1_default.svg"}) {
    EXPECT_TRUE(fs::exists(folder_ / "merged" / name)) << name;
  }
}

TEST_F(ExperimentProgram, ResultsOfOtherScenariosOrSettingsAreRefused) {
  ASSERT_EQ(Run(table_ + "--trials 1 --out t").code, 0) << Errors();
  const std::string before = ReadText(folder_ / "t/results.jsonl");
  EXPECT_EQ(Run(table_ + "--trials 2 --out t --time-limit 20").code, 1);
  EXPECT_NE(Errors().find("results.jsonl:1: row 'three_routes_a_1' comes from other settings"),
            std::string::npos)
      << Errors();
  WriteScenario("three_routes_a", "", "1.6");
  EXPECT_EQ(Run(table_ + "--trials 2 --out t").code, 1);
  EXPECT_NE(Errors().find("another scenario"), std::string::npos) << Errors();
  EXPECT_EQ(ReadText(folder_ / "t/results.jsonl"), before);
  ASSERT_EQ(Run(table_ + "--trials 1 --out other").code, 0) << Errors();
  EXPECT_EQ(Run("merge t other --out merged").code, 1);
}

TEST_F(ExperimentProgram, AnInfeasibleTwinIsAnsweredNo) {
  ASSERT_EQ(
      Run("table --scenarios scenarios --scenario closed_room --trials 2 --out t --json").code, 0)
      << Errors();
  const auto json = nlohmann::ordered_json::parse(Output());
  EXPECT_TRUE(json["rows"].empty());
  ASSERT_EQ(json["twins"].size(), 1u);
  EXPECT_EQ(json["twins"][0]["plans"], 0);
  // Either "no" is allowed, but not a time limit.
  const auto& no = json["twins"][0]["no"];
  EXPECT_EQ(no.value("proven_infeasible", 0) + no.value("exhausted", 0), 2);
}

TEST_F(ExperimentProgram, ASweepIsResumedShardedAndMerged) {
  std::ofstream(folder_ / "length.yaml")
      << "name: length_${length}\nrobot: " POSSIBILITY_SOURCE_DIR
         "/models/drchubo1/drchubo1.yaml\nactions: [walk]\n"
         "start: {action: walk, x: 1.2, y: 0, yaw_deg: 0}\n"
         "goal: {action: walk, x: ${1.2 + length}, y: 0, yaw_deg: 0}\ntime_limit: 1000\n"
         "environment:\n  bounds: {x: [0, 5], y: [-2, 2]}\n  ground:\n"
         "    - {name: floor, size: [5, 4, 0.5], position: [2.5, 0, -0.25]}\n  obstacles:\n"
         "    - posts: {count: 5, x: [0, 5], y: [-2, 2], size: [0.05, 0.1], height: 1, clear: "
         "[[1.2, 0, 1], [2, 0, 1], [2.8, 0, 1]]}\n";
  const std::string sweep = "sweep length.yaml --parameter length --values 0.3:0.6:0.3 --trials 2 ";
  ASSERT_EQ(Run(sweep + "--out whole --json").code, 0) << Errors();
  const auto json = nlohmann::ordered_json::parse(Output());
  ASSERT_EQ(json["rows"].size(), 2u);
  EXPECT_LT(json["rows"][0]["length_m"]["median"].get<double>(),
            json["rows"][1]["length_m"]["median"].get<double>());
  const std::string before = ReadText(folder_ / "whole/results.jsonl");
  ASSERT_EQ(Run(sweep + "--out whole").code, 0) << Errors();
  EXPECT_EQ(ReadText(folder_ / "whole/results.jsonl"), before);
  ASSERT_EQ(Run(sweep + "--out p0 --shard 0/3").code, 0) << Errors();
  ASSERT_EQ(Run(sweep + "--out p1 --shard 1/3").code, 0) << Errors();
  ASSERT_EQ(Run(sweep + "--out p2 --shard 2/3").code, 0) << Errors();
  ASSERT_EQ(Run("merge p0 p1 p2 --out merged").code, 0) << Errors();
  EXPECT_EQ(Facts("merged"), Facts("whole"));
  EXPECT_TRUE(fs::exists(folder_ / "merged/sweep.csv"));
  EXPECT_EQ(Run("table --scenarios scenarios --scenario three_routes_a_1 --out whole").code, 1);
  EXPECT_NE(Errors().find("another experiment"), std::string::npos) << Errors();
}

TEST_F(ExperimentProgram, WrongInputsGiveOneLineAndExitCode1) {
  std::ofstream(folder_ / "file") << "";
  std::ofstream(folder_ / "sweep.yaml") << "name: a_${n}\n";
  std::ofstream(folder_ / "broken.yaml") << "name: a_${n\n";
  fs::create_directories(folder_ / "damaged");
  std::ofstream(folder_ / "damaged/results.jsonl") << "{}\n{}\n";
  fs::create_directories(folder_ / "empty");
  const std::string sweep = "sweep sweep.yaml --out s ";
  const std::string cases[] = {
      table_ + "--trials 0",
      table_ + "--trials 1.5",
      table_ + "--threads 0",
      table_ + "--seed -1",
      table_ + "--preset fast",
      table_ + "--shard 2/2",
      table_ + "--time-limit 0",
      table_ + "--out file",
      table_ + "--out damaged",
      "table --scenarios scenarios --scenario three_routes_d",
      "table --scenarios nowhere --scenario hallway",
      "sweep",
      sweep + "--parameter n",
      sweep + "--values 1:2:1",
      sweep + "--parameter m --values 1:2:1",
      sweep + "--parameter n+1 --values 1:2:1",
      sweep + "--parameter n --values 2:1:1",
      sweep + "--parameter n --values 1:2:1",
      "sweep broken.yaml --parameter n --values 1 --out s",
      "sweep none.yaml --parameter n --values 1 --out s",
      "merge",
      "merge damaged",
      "merge empty --out m",
      "merge damaged --out m",
      "merge none --out m",
      "plan scenarios/three_routes_a.yaml --preset both",
  };
  for (const std::string& arguments : cases) ExpectRefused(arguments);
}

TEST_F(ExperimentProgram, RolloutSimulatesEachPerturbation) {
  ASSERT_EQ(Run("plan scenarios/three_routes_a.yaml --out plan --json").code, 0);
  const Outcome outcome =
      Run("rollout plan --json --perturb mass=1.02,slope_deg=0.5 --perturb side_slope_deg=25");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  const auto cases = nlohmann::ordered_json::parse(outcome.out)["cases"];
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[0]["perturbation"], (nlohmann::ordered_json{{"mass", 1.02}, {"slope_deg", 0.5}}));
  EXPECT_TRUE(cases[0]["survives"]);
  EXPECT_FALSE(cases[1]["survives"]);
  ASSERT_FALSE(cases[0]["stretches"].empty());
  EXPECT_TRUE(cases[0]["stretches"][0]["fell_at_s"].is_null());
  EXPECT_LT(cases[0]["stretches"][0]["worst_position_m"], 0.1);
}

TEST_F(ExperimentProgram, ThePaperPresetGivesALongerPlan) {
  ASSERT_EQ(
      Run("plan scenarios/three_routes_a.yaml --preset paper --threads 1 --out paper --json").code,
      0)
      << Errors();
  const auto paper = nlohmann::ordered_json::parse(Output());
  ASSERT_EQ(Run("plan scenarios/three_routes_a.yaml --threads 1 --out default --json").code, 0);
  const auto best = nlohmann::ordered_json::parse(Output());
  // Only the default planner improves the plan that it found.
  EXPECT_LT(best["plan_duration_s"].get<double>(), paper["plan_duration_s"].get<double>());
}

}  // namespace
}  // namespace possibility::experiments
