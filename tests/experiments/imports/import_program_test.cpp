// Motions that leave the program and come back to it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "experiments/formats/npy_array.h"
#include "models/archive/zip_file.h"
#include "tests/experiments/program_run.h"
#include "tests/experiments/standing_plan.h"

namespace possibility::experiments {
namespace {

using testing::ReadText;

class ImportProgram : public testing::ProgramRun {
 protected:
  static std::string Scenario(const std::string& name) {
    return "'" POSSIBILITY_SOURCE_DIR "/experiments/scenarios/" + name + ".yaml'";
  }
  const std::string robot_ = "'" POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml'";

  void Plan(const std::string& scenario) const {
    const Outcome outcome = Run("plan " + Scenario(scenario) + " --seed 3 --threads 1 --out out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  /// Leaves out the columns of a CSV file whose names begin with one of `prefixes`. No field has a
  /// comma.
  void DropColumns(const std::string& file, const std::vector<std::string>& prefixes) const {
    std::istringstream lines(ReadText(folder_ / file));
    std::ofstream kept(folder_ / file);
    std::vector<bool> keep;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream fields(line);
      const bool is_header = keep.empty();
      std::string text;
      std::size_t column = 0;
      for (std::string field; std::getline(fields, field, ','); ++column) {
        if (is_header) {
          keep.push_back(std::none_of(prefixes.begin(), prefixes.end(), [&](const auto& prefix) {
            return field.starts_with(prefix);
          }));
        }
        if (keep[column]) text += (text.empty() ? "" : ",") + field;
      }
      kept << text << "\n";
    }
  }
};

TEST_F(ImportProgram, APlanImportedFromItsOwnTableVerifies) {
  Plan("three_routes_c");  // walks, crawls, jumps
  ASSERT_EQ(Run("export out --csv tables").code, 0);
  const Outcome outcome = Run("import tables/trajectory.csv --robot " + robot_ + " --scenario " +
                              Scenario("three_routes_c") + " --out again --json");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_TRUE(nlohmann::json::parse(outcome.out)["accepted"]);
  EXPECT_EQ(Run("verify again").code, 0);
  // The same motion, whatever its forces.
  const auto plan = nlohmann::json::parse(ReadText(folder_ / "out/plan.json"));
  const auto again = nlohmann::json::parse(ReadText(folder_ / "again/plan.json"));
  ASSERT_EQ(plan["segments"].size(), again["segments"].size());
  for (std::size_t i = 0; i < plan["segments"].size(); ++i) {
    const auto& phases = plan["segments"][i]["phases"];
    const auto& phases_again = again["segments"][i]["phases"];
    ASSERT_EQ(phases.size(), phases_again.size());
    for (std::size_t k = 0; k < phases.size(); ++k) {
      EXPECT_EQ(phases[k]["t"], phases_again[k]["t"]);
      EXPECT_EQ(phases[k]["v"], phases_again[k]["v"]);
      EXPECT_EQ(phases[k].contains("impulses"), phases_again[k].contains("impulses"));
    }
  }
}

TEST_F(ImportProgram, PositionsAndContactsAreCompletedAndVerify) {
  Plan("three_routes_a");
  ASSERT_EQ(Run("export out --csv tables --period 0.004").code, 0);
  DropColumns("tables/trajectory.csv", {"v_", "a_", "tau_"});
  const Outcome outcome =
      Run("import tables/trajectory.csv --scenario " + Scenario("three_routes_a") + " --out again");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

TEST_F(ImportProgram, APlanOfFormatTwoVerifiesAndTakesThePlaceOfFormatOne) {
  Plan("three_routes_a");
  ASSERT_EQ(Run("export out --csv tables").code, 0);
  const std::string import =
      "import tables/trajectory.csv --scenario " + Scenario("three_routes_a") + " --out again";
  ASSERT_EQ(Run(import).code, 0);
  const Outcome outcome = Run(import + " --format 2");
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "again/plan.json"));
  EXPECT_LT(std::filesystem::file_size(folder_ / "again/plan.zip"),
            std::filesystem::file_size(folder_ / "out/plan.json") / 5);
  EXPECT_EQ(Run("verify again").code, 0);
}

TEST_F(ImportProgram, AMotionThatTheRobotCannotDoIsRejected) {
  Plan("three_routes_a");
  ASSERT_EQ(Run("export out --npz plan.npz --period 0.01").code, 0);
  auto members = models::ReadZip(ReadText(folder_ / "plan.npz"), "plan.npz");
  NpyArray q = ReadNpy(members.at("q.npy"), "q");
  // The robot stands one centimetre higher throughout.
  double* numbers = reinterpret_cast<double*>(q.bytes.data());
  for (std::size_t row = 0; row < q.shape[0]; ++row) numbers[row * q.shape[1] + 6] += 0.01;
  members["q.npy"] = NpyFile(q);
  models::ZipWriter archive(folder_ / "spoilt.npz");
  for (const auto& [name, content] : members) archive.Add(name, content);
  archive.Commit();
  const Outcome outcome =
      Run("import spoilt.npz --scenario " + Scenario("three_routes_a") + " --out again --json");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  bool is_off_the_ground = false;
  const auto report = nlohmann::json::parse(outcome.out);
  for (const auto& violation : report["violations"]) {
    is_off_the_ground = is_off_the_ground || violation["kind"] == "contact_ground";
  }
  EXPECT_TRUE(is_off_the_ground) << outcome.out;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "again/plan.json")) << "to look at";
}

TEST_F(ImportProgram, ScenariosMayListActionsOfThePlanner) {
  const std::string beam = POSSIBILITY_SOURCE_DIR "/experiments/scenarios/beam.yaml";  // step_over
  testing::WriteStandingPlan(beam, folder_ / "plan.json");
  ASSERT_EQ(Run("export plan.json --csv tables").code, 0);
  const Outcome outcome =
      Run("import tables/trajectory.csv --scenario '" + beam + "' --out again --json");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(report["violations"].size(), 1u) << outcome.out;
  EXPECT_EQ(report["violations"][0]["kind"], "goal") << "the robot stands at the start";
}

TEST_F(ImportProgram, BadInputIsRefusedInOneLine) {
  std::ofstream(folder_ / "motion.csv") << "t,x\n";
  const std::string scenario = " --scenario " + Scenario("three_routes_a") + " --out again";
  ExpectRefused("import");
  ExpectRefused("import motion.csv");
  ExpectRefused("import none.csv" + scenario);
  ExpectRefused("import . " + scenario);
  ExpectRefused("import motion.csv --scenario none.yaml --out again");
  ExpectRefused("import motion.csv --format 3" + scenario);
  ExpectRefused("import motion.csv --robot none.yaml" + scenario);
  EXPECT_NE(
      ExpectRefused("import motion.csv" + scenario).find("motion.csv:1: no column 'q_root_qw'"),
      std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "again/plan.json"));
}

}  // namespace
}  // namespace possibility::experiments
