#include "experiments/trials/scenario_template.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "experiments/trials/post_field.h"
#include "experiments/trials/sweep_values.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

class Template : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "out");
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Instance(const std::string& text, double value, std::uint64_t seed = 1) const {
    const fs::path file = folder_ / "template.yaml";
    std::ofstream(file) << text;
    return ScenarioTemplate(file).Instantiate({{"n", value}}, seed, folder_ / "out");
  }
  std::string ErrorOf(const std::string& text, double value) const {
    try {
      Instance(text, value);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const fs::path folder_ =
      fs::temp_directory_path() / ("possibility_template_" + std::to_string(::getpid()));
};

TEST_F(Template, ReplacesExpressionsAndNothingElse) {
  EXPECT_EQ(Instance("a: ${n}\nb: [${n + 0.1}, ${ 2 * (n-1) }] # ${no such}\nc: $n {n}\n", 0.2),
            "a: 0.2\nb: [0.3, -1.6] \nc: $n {n}\n");
  EXPECT_EQ(Instance("actions: [${n of walk, crawl , jump}]\n", 2), "actions: [walk, crawl]\n");
}

TEST_F(Template, TheRobotsPathIsRelativeToTheOutputFolder) {
  EXPECT_EQ(Instance("robot: ../robots/one.yaml\n", 1), "robot: ../../robots/one.yaml\n");
}

TEST_F(Template, ErrorsNameFileAndLine) {
  const std::string begin = (folder_ / "template.yaml").string() + ":2: ";
  for (const char* line : {"a: ${m}", "a: ${n", "a: ${1/0}", "a: ${}", "a: [${n of x}]",
                           "  - posts: {count: -1, x: [0, 1], y: [0, 1], size: [1, 2], height: 1}",
                           "  - posts: {count: 1}",
                           "  - posts: {count: 1, x: [0, 1], y: [0, 1], size: [0.1, 0.2], height: "
                           "1, clear: [[0.5, 0.5, 9]]}"}) {
    const std::string error = ErrorOf("x: 1\n" + std::string(line) + "\n", 2);
    EXPECT_EQ(error.rfind(begin, 0), 0u) << line << " -> " << error;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
  EXPECT_THROW(ScenarioTemplate(folder_ / "none.yaml"), InputError);
}

TEST_F(Template, MentionsTheNamesOfItsExpressions) {
  const fs::path file = folder_ / "template.yaml";
  std::ofstream(file) << "a: ${gap_2 + x}\n# ${comment}\nb: plain\n";
  const ScenarioTemplate scenario(file);
  EXPECT_TRUE(scenario.Mentions("gap_2"));
  EXPECT_TRUE(scenario.Mentions("x"));
  for (const char* name : {"gap", "plain", "comment", "a"}) {
    EXPECT_FALSE(scenario.Mentions(name)) << name;
  }
}

TEST_F(Template, PostsKeepLanesAndCirclesClear) {
  PostField field;
  field.count = 3000;
  field.x_high = 20;
  field.y_low = -10;
  field.y_high = 10;
  field.size_low = 0.05;
  field.size_high = 0.3;
  field.height = 1;
  field.pitch = 5;
  field.lane = 2;
  field.clear = {{5, 0, 2}};
  const std::vector<std::string> posts = PostsOf(field, 4);
  ASSERT_EQ(posts.size(), 3000u);
  EXPECT_EQ(posts, PostsOf(field, 4));
  EXPECT_NE(posts, PostsOf(field, 5));
  std::string yaml =
      "name: field\nrobot: r.yaml\nactions: [walk]\n"
      "start: {action: walk, x: 1, y: 0, yaw_deg: 0}\n"
      "goal: {action: walk, x: 1, y: 0, yaw_deg: 0}\n"
      "environment:\n  bounds: {x: [0, 20], y: [-10, 10]}\n  ground:\n"
      "    - {name: floor, size: [20, 20, 1], position: [10, 0, -0.5]}\n"
      "  obstacles:\n";
  for (const std::string& post : posts) yaml += "    - " + post + "\n";
  std::ofstream(folder_ / "field.yaml") << yaml;
  const models::Scenario scenario = models::LoadScenario(folder_ / "field.yaml");
  int obstacles = 0;
  for (const models::Obstacle& obstacle : scenario.environment.obstacles) {
    if (obstacle.is_ground) continue;
    ++obstacles;
    const Eigen::AlignedBox3d box = obstacle.shape.Bounds(obstacle.X_WO);
    EXPECT_NEAR(box.min().z(), 0, 1e-9);
    EXPECT_NEAR(box.max().z(), 1, 1e-9);
    for (const double middle : {2.5, 7.5, 12.5, 17.5}) {
      EXPECT_TRUE(box.max().x() < middle - 0.999 || box.min().x() > middle + 0.999);
      EXPECT_TRUE(box.max().y() < middle - 10.999 || box.min().y() > middle - 9.001);
    }
    EXPECT_GT(box.exteriorDistance(Eigen::Vector3d(5, 0, 0.5)), 1.999);
  }
  EXPECT_EQ(obstacles, 3000);
}

TEST_F(Template, PathsOfMeshesAreSeenFromTheScenario) {
  std::ofstream(folder_ / "map.yaml") << "environment:\n  meshes:\n"
                                         "    - {name: a, file: parts/a.stl, scale: ${s}}\n"
                                         "    - name: b\n      file: b.obj\n";
  EXPECT_EQ(ScenarioTemplate(folder_ / "map.yaml").Instantiate({{"s", 2}}, 1, folder_ / "out/x"),
            "environment:\n  meshes:\n"
            "    - {name: a, file: ../../parts/a.stl, scale: 2}\n"
            "    - name: b\n      file: ../../b.obj\n");
}

TEST_F(Template, EveryShippedTemplateGivesValidScenarios) {
  const fs::path sweeps = fs::path(POSSIBILITY_SOURCE_DIR) / "experiments/sweeps";
  const std::map<std::string, std::pair<std::string, std::vector<double>>> cases = {
      {"gap_width", {"gap", {0.2, 1}}},        {"bar_height", {"height", {0.7, 1.4}}},
      {"corridor_width", {"width", {0.6, 2}}}, {"obstacle_count", {"count", {10, 10000}}},
      {"room_size", {"side", {6, 24}}},        {"actions", {"actions", {1, 2, 3}}},
      {"door_width", {"width", {0.6, 1.1}}}};
  int found = 0;
  for (const auto& entry : fs::directory_iterator(sweeps)) {
    ++found;
    const auto& [parameter, values] = cases.at(entry.path().stem().string());
    const ScenarioTemplate scenario_template(entry.path());
    EXPECT_TRUE(scenario_template.Mentions(parameter));
    for (const double value : values) {
      const fs::path file = folder_ / "out" / "scenario.yaml";
      std::ofstream(file) << scenario_template.Instantiate({{parameter, value}}, 3,
                                                           folder_ / "out");
      const models::Scenario scenario = models::LoadScenario(file);
      EXPECT_NO_THROW(
          models::CheckScenarioAgainstRobot(scenario, models::LoadRobotModel(scenario.robot_file)));
    }
  }
  EXPECT_EQ(found, static_cast<int>(cases.size()));
}

TEST(SweepValues, ParsesRangesAndLists) {
  EXPECT_EQ(ParseSweepValues("--values", "0.1:0.5:0.1"),
            (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
  EXPECT_EQ(ParseSweepValues("--values", "1:2:0.4"), (std::vector<double>{1, 1.4, 1.8}));
  EXPECT_EQ(ParseSweepValues("--values", "3:3:1"), (std::vector<double>{3}));
  EXPECT_EQ(ParseSweepValues("--values", "-1,0,10"), (std::vector<double>{-1, 0, 10}));
  for (const char* bad : {"", "1,", "1:2", "1:2:0", "2:1:1", "1:2:-1", "1,1", "2,1", "a", "nan",
                          "1:inf:1", "0:1e6:1e-6", "1;2", " 1"}) {
    EXPECT_THROW(ParseSweepValues("--values", bad), InputError) << bad;
  }
}

}  // namespace
}  // namespace possibility::experiments
