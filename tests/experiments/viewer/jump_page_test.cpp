#include "experiments/viewer/jump_page.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "actions/jump/jump_library.h"
#include "models/input/input_error.h"
#include "tests/actions/drchubo1.h"
#include "tests/experiments/viewer/page_data.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr actions::JumpTask kTask = {0.5, 0};

const fs::path kRobotFolder = fs::path(POSSIBILITY_SOURCE_DIR) / "models/drchubo1";

/// The jump, solved once per test program and written as a library would write it.
class JumpPageTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const models::RobotModel& robot = actions::DrcHubo1();
    const actions::NominalStance launch =
        actions::SolveNominalStance(robot, robot.GaitNamed("walk"));
    const actions::NominalStance landing =
        actions::SolveNominalStance(robot, robot.GaitNamed("crawl"));
    const actions::JumpSolver solver(robot, launch, landing);
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "jumps");
    for (const char* name : {"drchubo1.yaml", "drchubo1.urdf"}) {
      fs::copy_file(kRobotFolder / name, folder_ / name);
    }
    actions::JumpLibrary library(solver, folder_ / "jumps");
    library.Save(library.FindOrSolve(kTask), kTask);
    file_ = library.folder() / "jump_10_0.json";
    loaded_ = LoadJump(file_, {});
    data_ = testing::EmbeddedData(JumpPage(loaded_));
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  /// The error message of LoadJump, "" if it succeeds. It must be one line that names a file of the
  /// folder.
  static std::string Complaint(const fs::path& file, const fs::path& robot) {
    try {
      LoadJump(file, robot);
      return "";
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      EXPECT_NE(message.find(folder_.string()), std::string::npos) << message;
      return message;
    }
  }

  /// The jump with a part of its text replaced, in a separate file.
  static fs::path Changed(const std::string& part, const std::string& by) {
    std::ostringstream text;
    text << std::ifstream(file_).rdbuf();
    std::string changed = text.str();
    changed.replace(changed.find(part), part.size(), by);
    std::ofstream(folder_ / "changed.json") << changed;
    return folder_ / "changed.json";
  }

  static const fs::path folder_;
  static fs::path file_;
  static LoadedJump loaded_;
  static Json data_;
};

const fs::path JumpPageTest::folder_ =
    fs::temp_directory_path() / ("possibility_jump_" + std::to_string(::getpid()));
fs::path JumpPageTest::file_;
LoadedJump JumpPageTest::loaded_;
Json JumpPageTest::data_;

TEST_F(JumpPageTest, FindsTheRobotBesideTheLibrary) {
  EXPECT_EQ(loaded_.robot.content_hash, actions::DrcHubo1().content_hash);
  EXPECT_TRUE(loaded_.is_current);
  EXPECT_DOUBLE_EQ(loaded_.jump->task.distance, kTask.distance);
}

TEST_F(JumpPageTest, ShowsOneSegmentWithItsPhasesAndPlots) {
  ASSERT_EQ(data_["segments"].size(), 1u);
  EXPECT_EQ(data_["segments"][0]["action"], "jump");
  std::vector<std::string> names;
  for (const Json& phase : data_["segments"][0]["phases"]) names.push_back(phase["name"]);
  EXPECT_EQ(names, (std::vector<std::string>{"preparation", "crouch", "toes", "flight", "settle",
                                             "landing"}));
  EXPECT_TRUE(data_["plots_first"]);
  EXPECT_EQ(data_["facts"][0], (std::vector<std::string>{"Jump", "0.50 m"}));
}

TEST_F(JumpPageTest, ImpulsesStopTheFallOfTheCentreOfMass) {
  const Json& settle = data_["segments"][0]["phases"][4];
  const std::vector<double> impulses = settle["impulses"];
  ASSERT_EQ(impulses.size(), 24u);
  double sum[3] = {};
  for (std::size_t i = 0; i < impulses.size(); ++i) sum[i % 3] += impulses[i];
  // The flight's last knot is the one before the first knot of the settle phase.
  const std::vector<float> momenta = testing::PageMotion(data_).momenta;
  const auto after = momenta.begin() + 6 * settle["first"].get<int>();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(after[axis] - after[axis - 6], sum[axis], 2e-4) << axis;
  }
  EXPECT_GT(sum[2], 1);
}

TEST_F(JumpPageTest, FloorsEndAtTheContactsOfTheStances) {
  const models::RobotModel& robot = actions::DrcHubo1();
  double toes = -INFINITY;
  double first_landed = INFINITY;
  for (const auto& patch :
       actions::SolveNominalStance(robot, robot.GaitNamed("walk")).bearing_points) {
    for (const Eigen::Vector2d& point : patch) toes = std::max(toes, point.x());
  }
  for (const auto& patch :
       actions::SolveNominalStance(robot, robot.GaitNamed("crawl")).bearing_points) {
    for (const Eigen::Vector2d& point : patch) first_landed = std::min(first_landed, point.x());
  }
  ASSERT_EQ(data_["obstacles"].size(), 2u);
  const auto edge = [&](int floor, int side) {
    const Json& obstacle = data_["obstacles"][floor];
    return obstacle["pose"][4].get<double>() +
           side * obstacle["shape"]["size"][0].get<double>() / 2;
  };
  EXPECT_NEAR(edge(0, 1), toes, 1e-4);
  EXPECT_NEAR(edge(1, -1), kTask.distance + first_landed, 1e-4);
  EXPECT_LT(edge(0, -1), -0.3);
  EXPECT_GT(edge(1, 1), kTask.distance + 0.3);
}

TEST_F(JumpPageTest, UsesTheGivenRobot) {
  const fs::path elsewhere = folder_ / "alone.json";
  fs::copy_file(file_, elsewhere, fs::copy_options::overwrite_existing);
  EXPECT_NE(Complaint(elsewhere, {}).find("expected --robot ROBOT.yaml"), std::string::npos);
  EXPECT_EQ(JumpPage(LoadJump(elsewhere, folder_ / "drchubo1.yaml")), JumpPage(loaded_));
}

TEST_F(JumpPageTest, SeveralRobotFilesAreRefused) {
  std::ofstream(folder_ / "other.yaml") << "name: other\n";
  EXPECT_NE(Complaint(file_, {}).find("several YAMLs"), std::string::npos);
  fs::remove(folder_ / "other.yaml");
  EXPECT_EQ(Complaint(file_, {}), "");
}

TEST_F(JumpPageTest, AJumpOfAnOldLibraryIsNotCurrent) {
  const fs::path stale = folder_ / "jumps/0123456789abcdef/jump_10_0.json";
  fs::create_directories(stale.parent_path());
  fs::copy_file(file_, stale);
  EXPECT_FALSE(LoadJump(stale, {}).is_current);
}

TEST_F(JumpPageTest, RefusesFilesThatAreNoJumpOfTheRobot) {
  const fs::path robot = folder_ / "drchubo1.yaml";
  EXPECT_NE(Complaint(folder_ / "none.json", robot), "");
  EXPECT_NE(Complaint(file_, folder_ / "none.yaml"), "");
  EXPECT_NE(Complaint(robot, robot), "");
  EXPECT_NE(Complaint(Changed("jump of", "dance of"), robot), "");
  EXPECT_NE(Complaint(Changed("jump of 0.500 m", "jump of 0.5.0 m"), robot), "");
  EXPECT_NE(Complaint(Changed("\"LKP\"", "\"XYZ\""), robot), "");
}

}  // namespace
}  // namespace possibility::experiments
