// `plan --watch` as its users run it: versions of a scenario's file, and what is printed for each.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>

#include "tests/experiments/program_run.h"
#include "tests/experiments/read_text.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using testing::ReadText;

class PlanWatch : public testing::ProgramRun {
 protected:
  void SetUp() override {
    ProgramRun::SetUp();
    // Ignored where tests run in the background, and programs inherit that.
    std::signal(SIGINT, SIG_DFL);
    text_ = ReadText(fs::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios/crack.yaml");
    const std::string robot = "robot: ../../";
    text_.replace(text_.find(robot), robot.size(), "robot: " POSSIBILITY_SOURCE_DIR "/");
    Save(text_);
  }

  /// As editors do: another file takes the place of the old one.
  void Save(const std::string& text) const {
    std::ofstream(folder_ / "new.yaml") << text;
    fs::rename(folder_ / "new.yaml", folder_ / "room.yaml");
  }

  /// The line of stdout of this number, once it is there; empty if it never comes.
  std::string Line(int number) const {
    for (int tenth = 0; tenth < 600; ++tenth) {
      std::istringstream out(Output());
      std::string line;
      for (int i = 0; i <= number && std::getline(out, line); ++i) {
        if (i == number && !out.eof()) return line;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return {};
  }

  nlohmann::json Object(int number) const { return nlohmann::json::parse(Line(number)); }

  std::string text_;
};

TEST_F(PlanWatch, AnswersEveryVersionAndEndsWhenInterrupted) {
  const pid_t child = Start("plan room.yaml --watch --json --threads 1 --out out");
  const nlohmann::json first = Object(0);
  EXPECT_EQ(first["status"], "found");
  EXPECT_EQ(first["replanning"]["plan_kept"], false);

  Save(text_ + "\n# no change of the world\n");
  const nlohmann::json second = Object(1);
  EXPECT_EQ(second["status"], "found");
  EXPECT_EQ(second["replanning"]["plan_kept"], true);
  EXPECT_EQ(second["replanning"]["samples_kept"], second["replanning"]["samples"]);
  EXPECT_EQ(second["plan_duration_s"], first["plan_duration_s"]);
  EXPECT_EQ(Run("verify out").code, 0) << "the plan names the file's new hash";

  EXPECT_EQ(::kill(child, 0), 0);
  ::kill(child, SIGINT);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(Wait(child), -1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(1));
}

TEST_F(PlanWatch, AVersionWithAnErrorGetsOneLine) {
  const pid_t child = Start("plan room.yaml --watch --json --threads 1 --out out");
  Object(0);
  const std::string plan = ReadText(folder_ / "out/plan.json");
  Save(text_ + "\nspeed: 3\n");
  const nlohmann::json broken = Object(1);
  EXPECT_EQ(broken["status"], "error");
  EXPECT_NE(broken["error"].get<std::string>().find("speed"), std::string::npos);
  EXPECT_EQ(Errors(), broken["error"].get<std::string>() + "\n");
  EXPECT_EQ(ReadText(folder_ / "out/plan.json"), plan);
  Save(text_ + "\n# again\n");
  EXPECT_EQ(Object(2)["status"], "found");
  ::kill(child, SIGINT);
  EXPECT_EQ(Wait(child), -1);
}

TEST_F(PlanWatch, AnErrorInTheFirstVersionIsBadInput) {
  Save(text_ + "\nspeed: 3\n");
  EXPECT_NE(ExpectRefused("plan room.yaml --watch --out out").find("speed"), std::string::npos);
}

}  // namespace
}  // namespace possibility::experiments
