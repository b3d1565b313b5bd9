#include "experiments/recording/page_recording.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/viewer/viewer_page.h"
#include "models/input/input_error.h"
#include "tests/experiments/recording/png_size.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class KeptFilm : public Film {
 public:
  void Add(std::string_view png) override { pictures.emplace_back(png); }
  void Finish() override { is_finished = true; }

  std::vector<std::string> pictures;
  bool is_finished = false;
};

std::string SamplePage() {
  const models::RobotModel robot = testing::SampleRobot();
  return ViewerPage(testing::SamplePlan(robot, 4, 9), robot, testing::SampleScenario());
}

TEST(RecordedTimesTest, AreThoseOfTheLink) {
  const RecordedTimes none = ParseTimes("view=top");
  EXPECT_FALSE(none.begin);
  EXPECT_FALSE(none.end);
  EXPECT_EQ(none.speed, 1);
  const RecordedTimes all = ParseTimes("until=5.5&t=2&speed=0.5&camera=1,2,3,4,5,6");
  EXPECT_EQ(all.begin, 2);
  EXPECT_EQ(all.end, 5.5);
  EXPECT_EQ(all.speed, 0.5);
}

TEST(RecordedTimesTest, MustBeNumbersInOrder) {
  for (const char* link :
       {"t=x", "t=", "t=1e999", "until=2s", "speed=0", "speed=-1", "t=3&until=2"}) {
    EXPECT_THROW(ParseTimes(link), InputError) << link;
  }
}

class PageRecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!FindProgram({"chromium", "chromium-browser", "google-chrome"})) {
      GTEST_SKIP() << "chromium is not installed";
    }
  }
};

/// The robot moves by a third of a metre and turns, and the clock runs.
TEST_F(PageRecordingTest, EveryPictureShowsAnotherTime) {
  KeptFilm film;
  std::vector<std::pair<int, int>> counted;
  RecordPage(SamplePage(), {2, {640, 480}, "t=1&until=2.5&play=1"}, &film,
             [&](int done, int all) { counted.emplace_back(done, all); });
  ASSERT_EQ(film.pictures.size(), 4u);  // 1, 1.5, 2, 2.5 s
  EXPECT_TRUE(film.is_finished);
  EXPECT_EQ(counted.back(), std::pair(4, 4));
  for (std::size_t i = 0; i < film.pictures.size(); ++i) {
    EXPECT_EQ(testing::PngSize(film.pictures[i]), std::pair(640, 480));
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(film.pictures[i], film.pictures[j]) << i << j;
  }
}

TEST_F(PageRecordingTest, ABareRecordingIsTheSameEachTime) {
  KeptFilm once, again;
  for (KeptFilm* film : {&once, &again}) {
    RecordPage(SamplePage(), {1, {320, 240}, "t=3.7&bare=1"}, film, [](int, int) {});
  }
  ASSERT_EQ(once.pictures.size(), 1u);
  EXPECT_EQ(once.pictures, again.pictures);
}

TEST_F(PageRecordingTest, APageWithoutMotionIsRefused) {
  const models::RobotModel robot = testing::SampleRobot();
  actions::Plan plan;
  plan.no = {"exhausted", "", {}};
  KeptFilm film;
  EXPECT_THROW(RecordPage(ViewerPage(plan, robot, testing::SampleScenario()), {1, {320, 240}, ""},
                          &film, [](int, int) {}),
               InputError);
}

}  // namespace
}  // namespace possibility::experiments
