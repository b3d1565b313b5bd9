// view --record as its users run it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "experiments/recording/child_process.h"
#include "tests/experiments/program_run.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/recording/png_size.h"
#include "tests/experiments/standing_plan.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

class Record : public testing::ProgramRun {
 protected:
  void SetUp() override {
    ProgramRun::SetUp();
    testing::WriteStandingPlan(
        fs::path(POSSIBILITY_SOURCE_DIR) / "experiments/scenarios/three_routes_b.yaml",
        folder_ / "plan.json");
  }
};

TEST_F(Record, WritesFramesOrAFilm) {
  if (!FindProgram({"chromium"})) GTEST_SKIP() << "chromium is not installed";
  const std::string options = " --fps 4 --size 320x200 --link '#t=0.5&view=top'";
  const Outcome outcome = Run("view . --record frames" + options);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "frames\n");
  for (const char* name : {"frame_000001.png", "frame_000002.png", "frame_000003.png"}) {
    EXPECT_EQ(testing::PngSize(testing::ReadText(folder_ / "frames" / name)), std::pair(320, 200));
  }
  EXPECT_FALSE(fs::exists(folder_ / "frames/frame_000004.png"));
  EXPECT_FALSE(fs::exists(folder_ / "plan.html"));
  EXPECT_NE(ExpectRefused("view . --record frames").find("frame_00000"), std::string::npos);
  if (!FindProgram({"ffmpeg"})) return;
  const Outcome film = Run("view . --record film.webm --out page.html" + options);
  ASSERT_EQ(film.code, 0) << film.err;
  EXPECT_EQ(testing::ReadText(folder_ / "film.webm").substr(0, 4), "\x1a\x45\xdf\xa3");  // EBML
  EXPECT_TRUE(fs::exists(folder_ / "page.html"));
}

TEST_F(Record, WithoutItsProgramsSaysWhichOneIsMissing) {
  for (const auto& [target, missing] :
       {std::pair("frames", "chromium: not found"), std::pair("film.webm", "ffmpeg: not found")}) {
    const int code = Wait(Start(fmt::format("view . --record {}", target), "PATH=/nowhere"));
    EXPECT_EQ(code, 1);
    EXPECT_TRUE(Errors().starts_with(missing)) << Errors();
    const std::string errors = Errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_FALSE(fs::exists(folder_ / "film.webm"));
  }
}

TEST_F(Record, RefusesWhatItCannotRecord) {
  std::ofstream(folder_ / "file") << "";
  const std::pair<std::string, std::string> cases[] = {
      {"--record film.mp4", "ends in .webm"},
      {"--record file", "--record"},
      {"--record frames --fps 0", "--fps"},
      {"--record frames --fps 1.5", "--fps"},
      {"--record frames --size 640", "--size"},
      {"--record frames --size 640x", "--size"},
      {"--record frames --size 641x480", "--size"},
      {"--record frames --size 99999x480", "--size"},
      {"--record frames --link t=now", "--link: t"},
      {"--record frames --link 't=1&until=0'", "--link: until"},
  };
  for (const auto& [arguments, words] : cases) {
    const std::string line = ExpectRefused("view . " + arguments);
    EXPECT_NE(line.find(words), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace possibility::experiments
