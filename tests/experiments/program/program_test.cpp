// The built program as its users run it: its exit codes and what it writes to which stream.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "models/robot/robot_yaml.h"
#include "tests/experiments/program_run.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/standing_plan.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using testing::ProgramRun;
using testing::ReadText;

class Program : public ProgramRun {
 protected:
  void WriteStandingPlan() const {
    testing::WriteStandingPlan(scenario_file_, folder_ / "plan.json");
  }

  static bool FindViolation(const nlohmann::json& report, const std::string& kind) {
    const auto& violations = report["violations"];
    return std::any_of(violations.begin(), violations.end(),
                       [&](const nlohmann::json& violation) { return violation["kind"] == kind; });
  }

  /// lighter.yaml: DRC-HUBO1 with a tenth of every mass and inertia.
  fs::path WriteLighterRobot() const {
    const fs::path original = fs::path(POSSIBILITY_SOURCE_DIR) / "models/drchubo1";
    std::istringstream urdf(ReadText(original / "drchubo1.urdf"));
    std::ofstream lighter(folder_ / "drchubo1.urdf");
    for (std::string line; std::getline(urdf, line);) {
      for (const std::string key :
           {"mass value=\"", " ixx=\"", " ixy=\"", " ixz=\"", " iyy=\"", " iyz=\"", " izz=\""}) {
        const std::size_t place = line.find(key);
        if (place == std::string::npos) continue;
        const std::size_t begin = place + key.size();
        const std::size_t length = line.find('"', begin) - begin;
        line.replace(begin, length, fmt::format("{}", std::stod(line.substr(begin, length)) / 10));
      }
      lighter << line << "\n";
    }
    fs::copy_file(original / "drchubo1.yaml", folder_ / "lighter.yaml");
    return folder_ / "lighter.yaml";
  }

  const fs::path scenario_file_ =
      fs::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios/three_routes_b.yaml";
};

TEST_F(Program, HelpExitsWith0AndWritesNoError) {
  for (const char* arguments :
       {"--help", "plan --help", "verify --help", "rollout --help", "view --help", "export --help",
        "import --help", "regress --help", "bench --help"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments;
    EXPECT_FALSE(outcome.out.empty()) << arguments;
    EXPECT_TRUE(outcome.err.empty()) << arguments << outcome.err;
  }
}

TEST_F(Program, ANoWritesAPlanFileAndAPageWithTheReason) {
  const std::string room = POSSIBILITY_SOURCE_DIR "/experiments/scenarios/closed_room.yaml";
  fs::create_directories(folder_ / "out");
  std::ofstream(folder_ / "out" / "plan.json") << "an older plan";
  const Outcome outcome = Run("plan '" + room + "' --out out --json");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["no"], "proven_infeasible");
  const nlohmann::json plan = nlohmann::json::parse(ReadText(folder_ / "out" / "plan.json"));
  EXPECT_TRUE(plan["segments"].empty());
  EXPECT_EQ(plan["no"]["barrier"]["closed_by"][0], "dividing_wall");
  const auto& explored = plan["explored"];
  EXPECT_LT(fs::file_size(folder_ / "out" / "plan.json"),
            8000 + 25 * (explored["vertices"].size() + explored["edges"].size()));
  const std::string page = ReadText(folder_ / "out" / "plan.html");
  EXPECT_NE(page.find("dividing_wall"), std::string::npos);
  EXPECT_EQ(Run("view out --out again.html").code, 0);
  EXPECT_TRUE(ReadText(folder_ / "again.html") == page);
  const Outcome verified = Run("verify out");
  EXPECT_EQ(verified.code, 1) << verified.out;
  EXPECT_NE(verified.err.find("proven_infeasible"), std::string::npos) << verified.err;
  EXPECT_EQ(Run("export out --csv tables").code, 1);
}

TEST_F(Program, AFolderKeepsThePlanOfTheLatestRunOnly) {
  const std::string room = POSSIBILITY_SOURCE_DIR "/experiments/scenarios/closed_room.yaml";
  fs::create_directories(folder_ / "out");
  std::ofstream(folder_ / "out" / "plan.json") << "an older plan";
  const Outcome packed = Run("plan '" + room + "' --out out --format 2 --json");
  EXPECT_EQ(packed.code, 2) << packed.err;
  EXPECT_EQ(nlohmann::json::parse(packed.out)["plan"], "out/plan.zip");
  EXPECT_TRUE(fs::exists(folder_ / "out" / "plan.zip"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "plan.json"));
  EXPECT_EQ(Run("view out --out again.html").code, 0);
  EXPECT_EQ(Run("plan '" + room + "' --out out").code, 2);
  EXPECT_TRUE(fs::exists(folder_ / "out" / "plan.json"));
  EXPECT_FALSE(fs::exists(folder_ / "out" / "plan.zip"));
}

TEST_F(Program, PlansOfFormat2AreReadLikeThoseOfFormat1) {
  WriteStandingPlan();
  ASSERT_EQ(Run("export plan.json --plan small.zip").code, 0);
  EXPECT_LT(fs::file_size(folder_ / "small.zip"), fs::file_size(folder_ / "plan.json"));
  // It stands without torques in plan.json; in small.zip it has them.
  EXPECT_EQ(Run("verify plan.json").code, 3);
  const Outcome verified = Run("verify small.zip --json");
  EXPECT_EQ(verified.out.find("\"dynamics\""), std::string::npos) << verified.out;
  EXPECT_EQ(Run("view small.zip").code, 0);
  EXPECT_NE(ReadText(folder_ / "small.html").find("three_routes_b"), std::string::npos);
  EXPECT_EQ(Run("export small.zip --csv tables --plan back.json").code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "tables" / "trajectory.csv"));
  EXPECT_EQ(Run("export back.json --plan again.zip").code, 0);
  EXPECT_EQ(Run("verify back.json --json").code, verified.code);

  const std::string bytes = ReadText(folder_ / "small.zip");
  std::ofstream(folder_ / "cut.zip", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  for (const char* command : {"verify cut.zip", "view cut.zip", "export cut.zip --csv tables"}) {
    EXPECT_NE(ExpectRefused(command).find("cut.zip"), std::string::npos);
  }
}

TEST_F(Program, BadUsageAndInputGiveOneLineAndExitCode1) {
  const std::string scenario = scenario_file_.string();
  std::ofstream(folder_ / "broken.yaml") << "name: [unclosed\n";
  std::ofstream(folder_ / "plan.json") << "{\"format\": \"possibility-plan/1\"";
  std::ofstream(folder_ / "file") << "";
  const std::string cases[] = {
      "",
      "fly",
      "plan",
      "plan a.yaml b.yaml",
      "plan --no-such-option " + scenario,
      "plan no_such_file.yaml",
      "plan broken.yaml",
      "plan .",
      "plan " + scenario + " --seed -1",
      "plan " + scenario + " --seed 1.5",
      "plan " + scenario + " --seed",
      "plan " + scenario + " --threads 0",
      "plan " + scenario + " --threads 257",
      "plan " + scenario + " --time-limit 0",
      "plan " + scenario + " --time-limit nan",
      "plan " + scenario + " --time-limit inf",
      "plan " + scenario + " --actions walk,,crawl",
      "plan " + scenario + " --actions fly --out out",
      "plan " + scenario + " --actions walk,crawl,jump --out out",
      "plan " + scenario + " --format 3 --out out",
      "plan " + scenario + " --out file",
      "plan " + scenario + " --out file/below",
      "verify",
      "verify no_such_folder",
      "verify plan.json",
      "verify .",
      "rollout",
      "rollout no_such_folder",
      "rollout plan.json --perturb fly=1",
      "rollout plan.json --perturb mass",
      "rollout plan.json --perturb mass=nan",
      "rollout plan.json --perturb mass=1,mass=2",
      "rollout plan.json --perturb friction=-1",
      "view plan.json",
      "view plan.json --speed 2",
      "export plan.json",
      "export plan.json --csv tables",
      "export plan.json --csv tables --step 0",
      "export plan.json --npz arrays.npz --period -1",
      "export plan.json --npz none/arrays.npz",
      "export plan.json --plan plan.txt",
      "export plan.json --plan none/plan.zip",
      "regress --problem no_such_problem --robot '" POSSIBILITY_SOURCE_DIR
      "/models/drchubo1/drchubo1.yaml'",
      "regress --robot no_such_robot.yaml",
      "regress --problem kirk,,kirk",
      "regress --problem kirk,kirk",
      "regress --scheme euler",
      "regress --intervals 0",
      "regress --intervals 10001",
      "regress --solver snopt",
      "regress --linear-solver ma99",
      "regress --hessian none",
      "regress --against no_such_file.json",
      "regress --against plan.json",
      "regress --against broken.yaml",
      "regress --against .",
      "regress --problem kirk --out .",
      "regress --problem kirk --out file/below.json",
      "bench",
      "bench collocation --robot no_such_robot.yaml",
  };
  for (const std::string& arguments : cases) ExpectRefused(arguments);
}

/// For every option with a value and every argument of every command that --help lists.
TEST_F(Program, EmptyValuesAreRefusedAndNameTheirOption) {
  int options = 0;
  for (const std::string command : {"plan", "verify", "rollout", "view", "export", "import",
                                    "bench", "regress", "library", "table", "sweep", "merge"}) {
    std::istringstream help(Run(command + " --help").out);
    for (std::string line; std::getline(help, line);) {
      const std::size_t begin = line.find_first_not_of(' ');
      const std::string option = line.substr(std::min(begin, line.size()));
      const std::string name = option.substr(0, option.find(' '));
      const bool takes_text = option.find(" TEXT") != std::string::npos;
      if (begin == 0 || !takes_text) continue;
      ++options;
      const bool is_named = name.starts_with("--");
      const std::string refusal =
          ExpectRefused(command + (is_named ? " " + name : std::string()) + " ''");
      EXPECT_NE(refusal.find(name + ": the value is empty"), std::string::npos) << refusal;
    }
  }
  EXPECT_GE(options, 45);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(Program, RolloutRefusesAPlanThatIsRejected) {
  WriteStandingPlan();
  const std::string line = ExpectRefused("rollout plan.json --perturb mass=1.05");
  EXPECT_NE(line.find("is not simulated because it is rejected"), std::string::npos) << line;
}

TEST_F(Program, VersionNamesProgramAndPlanFormat) {
  const Outcome outcome = Run("--version");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out, "possibility " POSSIBILITY_VERSION
                         "\nplan format possibility-plan/1, possibility-plan/2\n");
}

TEST_F(Program, JsonErrorsAreOneObject) {
  for (const char* arguments : {"plan no_such_file.yaml --json", "verify . --json"}) {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.code, 1);
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(json["status"], "error");
    EXPECT_EQ(json["error"].get<std::string>() + "\n", outcome.err);
  }
}

TEST_F(Program, VerifyRejectsAPlanThatBreaksTheLawsOfMotion) {
  WriteStandingPlan();
  const Outcome text = Run("verify plan.json");
  EXPECT_EQ(text.code, 3) << text.err;
  EXPECT_FALSE(text.out.empty());
  const Outcome json = Run("verify . --json");
  EXPECT_EQ(json.code, 3);
  EXPECT_FALSE(nlohmann::json::parse(json.out)["accepted"]);
}

TEST_F(Program, VerifyNamesTheFilesThatItUsed) {
  WriteStandingPlan();
  const fs::path robot = fs::path(POSSIBILITY_SOURCE_DIR) / "models/drchubo1/drchubo1.yaml";
  const std::string text = Run("verify plan.json").out;
  EXPECT_NE(text.find("three_routes_b.yaml\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("drchubo1.yaml\"\n"), std::string::npos) << text;
  const auto json =
      nlohmann::json::parse(Run("verify . --json --scenario '" + scenario_file_.string() +
                                "' --robot '" + robot.string() + "'")
                                .out);
  EXPECT_EQ(json["scenario"], scenario_file_.string());
  EXPECT_EQ(json["robot"], robot.string());
  EXPECT_FALSE(FindViolation(json, "file_mismatch"));
}

/// A copy of the robot with a tenth of the mass, in the plan's folder.
TEST_F(Program, APlanOfALighterRobotIsAFileMismatch) {
  WriteStandingPlan();
  const fs::path lighter = WriteLighterRobot();
  auto plan = nlohmann::json::parse(ReadText(folder_ / "plan.json"));
  plan["robot"]["file"] = lighter.string();
  plan["robot"]["hash"] = models::LoadRobotModel(lighter).content_hash;
  std::ofstream(folder_ / "plan.json") << plan;
  for (const std::string options : {"", " --robot lighter.yaml"}) {
    const Outcome outcome = Run("verify plan.json --json" + options);
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_TRUE(FindViolation(nlohmann::json::parse(outcome.out), "file_mismatch")) << outcome.out;
  }
}

/// The paths in the plan may be invalid.
TEST_F(Program, VerifyReadsRobotAndScenarioFromOptions) {
  WriteStandingPlan();
  auto plan = nlohmann::json::parse(ReadText(folder_ / "plan.json"));
  plan["robot"]["file"] = "gone.yaml";
  plan["scenario"]["file"] = "gone.yaml";
  std::ofstream(folder_ / "plan.json") << plan;
  ExpectRefused("verify plan.json");
  fs::copy_file(scenario_file_, folder_ / "moved.yaml");
  const std::string line = ExpectRefused("verify plan.json --scenario moved.yaml");
  EXPECT_NE(line.find("--robot"), std::string::npos) << line;
  const Outcome outcome =
      Run("verify plan.json --json --scenario moved.yaml --robot '" POSSIBILITY_SOURCE_DIR
          "/models/drchubo1/drchubo1.yaml'");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_FALSE(FindViolation(nlohmann::json::parse(outcome.out), "file_mismatch")) << outcome.out;
  EXPECT_TRUE(FindViolation(nlohmann::json::parse(outcome.out), "goal")) << outcome.out;
}

TEST_F(Program, ViewWritesThePageBesideThePlanOrToTheGivenFile) {
  WriteStandingPlan();
  EXPECT_EQ(Run("view .").code, 0);
  const std::string page = ReadText(folder_ / "plan.html");
  EXPECT_NE(page.find("three_routes_b"), std::string::npos);
  EXPECT_EQ(Run("view plan.json --out elsewhere.html").code, 0);
  EXPECT_EQ(ReadText(folder_ / "elsewhere.html"), page);
  EXPECT_EQ(Run("view plan.json --out no_such_folder/page.html").code, 1);
}

TEST_F(Program, ViewOfTwoPlansWritesOnePageOfBoth) {
  WriteStandingPlan();
  EXPECT_EQ(Run("view . plan.json").code, 0);
  const std::string page = ReadText(folder_ / "comparison.html");
  EXPECT_NE(page.find("id=\"plan-data-b\""), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "plan.html"));
  EXPECT_EQ(Run("view plan.json . --out both.html").code, 0);
  EXPECT_EQ(ReadText(folder_ / "both.html"), page);
}

TEST_F(Program, ViewRefusesFilesThatAreNeitherPlanNorJump) {
  WriteStandingPlan();
  const std::string robot = POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml";
  std::ofstream(folder_ / "text.json") << "no JSON";
  std::ofstream(folder_ / "list.json") << "[]";
  std::ofstream(folder_ / "other.json") << R"({"format": "possibility-jumps/1", "reach": []})";
  std::ofstream(folder_ / "jump.json") << R"({"format": "possibility-solution/1"})";
  const fs::path jumps = POSSIBILITY_SOURCE_DIR "/models/drchubo1/jumps";
  for (const auto& entry : fs::recursive_directory_iterator(jumps)) {
    if (entry.path().filename() != "jump_10_0.zip") continue;
    fs::copy_file(entry.path(), folder_ / "motion.zip", fs::copy_options::overwrite_existing);
  }
  const std::pair<std::string, std::string> cases[] = {
      {"none.json", "no such file"},
      {"text.json", "neither a plan nor a jump"},
      {"list.json", "neither a plan nor a jump"},
      {"other.json", "neither a plan nor a jump"},
      {"jump.json", "jump.json"},
      {"motion.zip", "view the .json beside it"},
      {"plan.json jump.json", "expected two plans"},
      {"jump.json plan.json", "expected two plans"},
      {"plan.json none.json", "none.json: no such file"},
      {"plan.json . plan.json", "expected one or two"},
      {"plan.json --robot '" + robot + "'", "--robot"},
      {". --robot '" + robot + "'", "--robot"},
  };
  for (const auto& [arguments, words] : cases) {
    const std::string line = ExpectRefused("view " + arguments + " --out page.html");
    EXPECT_NE(line.find(words), std::string::npos) << line;
    EXPECT_FALSE(fs::exists(folder_ / "page.html")) << arguments;
  }
}

TEST_F(Program, ViewOfAJumpAloneNeedsTheRobotOption) {
  fs::path jump;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(POSSIBILITY_SOURCE_DIR) /
                                                            "models/drchubo1/jumps")) {
    const bool is_solution = entry.path().extension() == ".json";
    if (is_solution && entry.path().filename().string().starts_with("jump_")) jump = entry.path();
  }
  ASSERT_FALSE(jump.empty());
  fs::copy_file(jump, folder_ / "jump.json");
  const std::string line = ExpectRefused("view jump.json");
  EXPECT_NE(line.find("expected --robot ROBOT.yaml"), std::string::npos) << line;
  ExpectRefused("view jump.json --robot none.yaml");
}

TEST_F(Program, ExportWritesBothTables) {
  WriteStandingPlan();
  EXPECT_EQ(Run("export . --csv tables/deep").code, 0);
  const std::string trajectory = ReadText(folder_ / "tables/deep/trajectory.csv");
  EXPECT_EQ(std::count(trajectory.begin(), trajectory.end(), '\n'), 1 + 3);
  EXPECT_FALSE(fs::exists(folder_ / "tables/deep/margins.csv"));
  EXPECT_EQ(Run("export . --csv tables --period 0.1 --margins").code, 0);
  const std::string finer = ReadText(folder_ / "tables/trajectory.csv");
  EXPECT_EQ(std::count(finer.begin(), finer.end(), '\n'), 1 + 11);
  const std::string margins = ReadText(folder_ / "tables/margins.csv");
  EXPECT_EQ(std::count(margins.begin(), margins.end(), '\n'), 1 + 11);
  EXPECT_TRUE(fs::exists(folder_ / "tables/contact_forces.csv"));
}

TEST_F(Program, ExportWritesSeveralKindsAtOnceAndNamesThem) {
  WriteStandingPlan();
  const Outcome outcome = Run("export . --csv tables --npz arrays.npz --step 0.1");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out,
            "tables/trajectory.csv\ntables/contact_forces.csv\ntables/units.csv\n"
            "tables/gains.csv\narrays.npz\n");
  EXPECT_TRUE(ReadText(folder_ / "arrays.npz").starts_with("PK\x03\x04"));
}

TEST_F(Program, APlanForAnotherRobotIsRefusedByView) {
  WriteStandingPlan();
  auto json = nlohmann::json::parse(ReadText(folder_ / "plan.json"));
  json["segments"][0]["phases"][0]["contacts"][0] = "third_foot";
  std::ofstream(folder_ / "plan.json") << json;
  ExpectRefused("view plan.json");
}

TEST_F(Program, BenchDynamicsPrintsRowsAndRatios) {
  const Outcome outcome = Run("bench dynamics --json --robot '" POSSIBILITY_SOURCE_DIR
                              "/models/drchubo1/drchubo1.yaml'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  for (const auto& row : json["rows"]) {
    EXPECT_FALSE(row["name"].get<std::string>().empty());
    EXPECT_GT(row["microseconds"].get<double>(), 0);
  }
  EXPECT_GT(json["ratios"]["derivatives_speedup"].get<double>(), 0);
  EXPECT_GT(json["ratios"]["two_thread_throughput"].get<double>(), 0);
}

TEST_F(Program, BenchRefusesAnUnknownSubjectByName) {
  const Outcome outcome = Run("bench dynamix");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(
      outcome.err,
      "bench: unknown subject 'dynamix', expected anytime, collocation, confirmation, dynamics, "
      "graph, replanning (did you mean 'dynamics'?)\n");
  EXPECT_EQ(Run("bench dynamics --robot no_such_robot.yaml").code, 1);
}

TEST_F(Program, RegressComparesARunWithTheOneBefore) {
  const Outcome first = Run("regress --problem block_move,kirk --out runs/first.json --json");
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_EQ(first.err, "");
  const auto printed = nlohmann::json::parse(first.out);
  EXPECT_EQ(printed["format"], "possibility-regress/1");
  EXPECT_FALSE(printed["environment"]["cpu"].get<std::string>().empty());
  ASSERT_EQ(printed["problems"].size(), 2u);
  EXPECT_EQ(printed["problems"][0]["name"], "block_move");
  EXPECT_NEAR(printed["problems"][0]["objective"].get<double>(), 12, 1e-6);
  EXPECT_EQ(printed["problems"][1]["optimum"], "global");
  EXPECT_EQ(nlohmann::json::parse(ReadText(folder_ / "runs/first.json")), printed);

  const Outcome same = Run("regress --problem kirk,block_move --against runs/first.json");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_NE(same.out.find("2 of 2 within tolerance"), std::string::npos) << same.out;
  EXPECT_NE(same.out.find("nothing got worse"), std::string::npos) << same.out;
}

TEST_F(Program, RegressWithSlsqpMeetsTheOptimaOfIpopt) {
  const Outcome slsqp = Run("regress --problem block_move,pendulum_1s --solver slsqp --json");
#ifdef POSSIBILITY_WITH_NLOPT
  EXPECT_EQ(slsqp.code, 0) << slsqp.err;
  const auto printed = nlohmann::json::parse(slsqp.out);
  EXPECT_EQ(printed["options"]["solver"], "slsqp");
  for (const auto& problem : printed["problems"]) {
    EXPECT_EQ(problem["optimum"], "global");
    EXPECT_EQ(problem["stationary_point"], "minimum");
    EXPECT_EQ(problem["evaluations"]["hessian"], 0);
  }
#else
  EXPECT_EQ(slsqp.code, 1);
  EXPECT_NE(slsqp.err.find("libnlopt-dev"), std::string::npos) << slsqp.err;
#endif
}

TEST_F(Program, RegressFailsIfAProblemIsWorseOrMissesItsOptimum) {
  ASSERT_EQ(Run("regress --problem block_move --out old.json").code, 0);
  auto json = nlohmann::json::parse(ReadText(folder_ / "old.json"));
  json["problems"][0]["iterations"] = 0;
  std::ofstream(folder_ / "old.json") << json;
  const Outcome worse = Run("regress --problem block_move --against old.json --json");
  EXPECT_EQ(worse.code, 3);
  EXPECT_NE(worse.err.find("worse"), std::string::npos) << worse.err;
  const auto printed = nlohmann::json::parse(worse.out);
  EXPECT_TRUE(printed["comparison"]["failed"].get<bool>());
  EXPECT_EQ(printed["comparison"]["differences"][0]["what"], "iterations");

  const Outcome missed = Run("regress --problem block_move --scheme trapezoidal --intervals 5");
  EXPECT_EQ(missed.code, 3);
  EXPECT_NE(missed.err.find("block_move"), std::string::npos) << missed.err;
}

}  // namespace
}  // namespace possibility::experiments
