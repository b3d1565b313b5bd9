// From a URDF to a verified walk in one command. Suites that end in "Long" take minutes.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "tests/experiments/program_run.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::experiments {
namespace {

const std::string kHuboUrdf = POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.urdf";
const std::string kHuboYaml = POSSIBILITY_SOURCE_DIR "/models/drchubo1/drchubo1.yaml";

class RobotCommand : public testing::ProgramRun {
 protected:
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
};
class RobotCommandLong : public RobotCommand {};

TEST_F(RobotCommand, BadInputIsNamedInOneLine) {
  EXPECT_EQ(ExpectRefused("robot init " + kHuboUrdf), "robot init: expected --out DIR\n");
  EXPECT_EQ(ExpectRefused("robot jump x --out y"),
            "robot: expected init, check or fit, got 'jump'\n");
  EXPECT_EQ(ExpectRefused("robot init none.urdf --out y"), "none.urdf: no such file\n");
  EXPECT_EQ(ExpectRefused("robot init " + kHuboUrdf + " --packages none --out y"),
            "--packages: 'none' is not a folder\n");
  Write("short.urdf", models::TwoLeggedUrdf());
  EXPECT_EQ(
      ExpectRefused("robot init short.urdf --out y"),
      "short.urdf: the legs that end in 'l_slide' and 'r_slide' have 3 and 3 joints, expected "
      "6 each: fewer cannot place a foot in every direction\n");
  Write("bad.srdf", "<robot>");
  EXPECT_EQ(ExpectRefused("robot init " + kHuboUrdf + " --srdf bad.srdf --out y"),
            "bad.srdf:1: not a valid SRDF: no XML (XML_ERROR_MISMATCHED_ELEMENT)\n");
}

TEST_F(RobotCommand, SpoiltUrdfsGiveOneLine) {
  const std::string urdf = testing::ReadText(kHuboUrdf);
  std::mt19937 random(71);
  for (int trial = 0; trial < 30; ++trial) {
    std::string text = urdf;
    for (int i = 0; i < 40; ++i) text[random() % text.size()] = static_cast<char>(random() % 128);
    Write("spoilt.urdf", text);
    const Outcome outcome = Run("robot init spoilt.urdf --out y --fit-seconds 0.001");
    EXPECT_TRUE(outcome.code == 1 || outcome.code == 2 || outcome.code == 0) << outcome.err;
    if (outcome.code == 1) {
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
  }
}

TEST_F(RobotCommandLong, DrcHubo1WalksFromItsUrdfAlone) {
  const Outcome outcome = Run("robot init " + kHuboUrdf + " --out hubo --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(report["verified"]);
  EXPECT_GT(report["speed"], report["expected_speed"]);
  EXPECT_EQ(report["winding_ways_verified"], report["winding_ways"]);
  for (const std::string file : {"robot.yaml", "drchubo1.urdf", "flat.yaml", "plan.html"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "hubo" / file)) << file;
  }
  // The folder is all that the verifier needs.
  EXPECT_EQ(Run("verify hubo").code, 0) << Errors();
  const Outcome check = Run("robot check hubo --json");
  EXPECT_EQ(check.code, 0) << check.out;
}

/// DRC-HUBO1 with hips that turn inwards by 0.08 rad: upright it cannot stand on one foot.
TEST_F(RobotCommandLong, ATrunkSwaysOnlyWhereHipsCannotTurnInwards) {
  std::string narrow = testing::ReadText(kHuboUrdf);
  for (const auto& [joint, from, to] : {std::array{"LHR", "lower=\"-0.52\"", "lower=\"-0.08\""},
                                        std::array{"RHR", "upper=\"0.52\"", "upper=\"0.08\""}}) {
    const std::size_t at = narrow.find(fmt::format("<joint name=\"{}\"", joint));
    ASSERT_NE(at, std::string::npos);
    narrow = narrow.substr(0, at) + Replaced(narrow.substr(at), from, to);
  }
  Write("narrow.urdf", narrow);
  const Outcome outcome = Run("robot init narrow.urdf --out narrow --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(report["winding_ways_verified"], report["winding_ways"]);
  EXPECT_NE(testing::ReadText(folder_ / "narrow/robot.yaml").find("sway_deg: "), std::string::npos);
  ASSERT_EQ(Run("robot init " + kHuboUrdf + " --out usual").code, 0);
  EXPECT_EQ(testing::ReadText(folder_ / "usual/robot.yaml").find("sway_deg"), std::string::npos);
}

TEST_F(RobotCommand, MjcfFilesAreRestated) {
  Write(
      "short.xml",
      "<mujoco><asset><mesh name=\"wedge\" vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\"/></asset><worldbody>"
      "<body name=\"trunk\"><freejoint/><geom type=\"mesh\" mesh=\"wedge\"/><body><joint "
      "name=\"hip\"/><geom size=\"0.1\"/></body></body></worldbody></mujoco>");
  const std::string error = ExpectRefused("robot init short.xml --mjcf --out y");
#ifdef POSSIBILITY_WITH_MUJOCO
  EXPECT_EQ(error.substr(0, 14), "y/short.urdf: ") << error;
  EXPECT_NE(testing::ReadText(folder_ / "y/short.urdf").find("<joint name=\"hip\""),
            std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "y/meshes/0_wedge.stl"));
#else
  EXPECT_NE(error.find("libmujoco-dev"), std::string::npos);
#endif
}

TEST_F(RobotCommand, FitNamesWhatItCannotFit) {
  const std::string a1 = POSSIBILITY_SOURCE_DIR "/models/a1/a1.yaml";
  EXPECT_EQ(ExpectRefused("robot fit " + a1),
            a1 + ": gaits: 'walk': limbs: expected 2 feet, got 4 limbs\n");
  EXPECT_EQ(ExpectRefused("robot fit " POSSIBILITY_SOURCE_DIR "/models/a1"),
            ExpectRefused("robot fit " + a1))
      << "the folder's only robot";
  EXPECT_NE(ExpectRefused("robot fit " + kHuboYaml + " --gait run").find("'run'"),
            std::string::npos);
  EXPECT_EQ(ExpectRefused("robot fit nowhere"), "nowhere: no such file\n");
}

/// A gait made slow by hand is fitted; comments and everything else stay.
TEST_F(RobotCommandLong, FitMakesASlowWalkQuick) {
  const std::string models = POSSIBILITY_SOURCE_DIR "/models/h1_2/";
  const std::string text = testing::ReadText(models + "h1_2.yaml");
  const std::string slow = ReplacedEverywhere(text, "swing_time: 0.5197", "swing_time: 1.4");
  ASSERT_NE(slow, text);
  std::filesystem::create_directory(folder_ / "robot");
  Write("robot/robot.yaml", slow);
  Write("robot/h1_2.urdf", testing::ReadText(models + "h1_2.urdf"));
  const Outcome outcome = Run("robot fit robot --json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  EXPECT_TRUE(report["written"]);
  EXPECT_GT(report["speed_fitted"], 1.5 * report["speed_before"].get<double>());
  const std::string fitted = testing::ReadText(folder_ / "robot/robot.yaml");
  const std::string head = text.substr(0, text.find("gaits:"));
  EXPECT_EQ(fitted.substr(0, head.size()), head);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "robot/robot.fitted.yaml"));
  EXPECT_EQ(Run("robot check robot").code, 0) << Errors();
  // The numbers are as good as they get.
  const Outcome again = Run("robot fit robot --json");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_FALSE(nlohmann::json::parse(again.out)["written"]);
}

TEST_F(RobotCommandLong, TheReportHasAllFindings) {
  const Outcome outcome = Run("robot check " + kHuboYaml + " --json");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const auto report = nlohmann::json::parse(outcome.out);
  std::set<std::string> subjects;
  for (const auto& finding : report["findings"]) subjects.insert(finding["subject"]);
  for (const std::string gait : {"walk", "crawl"}) {
    for (const std::string what : {"balance", "joints", "torque", "strides", "speed"}) {
      EXPECT_TRUE(subjects.contains(gait + ": " + what)) << gait << " " << what;
    }
  }
  EXPECT_EQ(report["faults"], 0);
}

}  // namespace
}  // namespace possibility::experiments
