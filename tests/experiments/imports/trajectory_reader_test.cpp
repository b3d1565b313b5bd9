#include "experiments/imports/trajectory_reader.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "experiments/exports/csv_tables.h"
#include "experiments/exports/npz_export.h"
#include "models/archive/zip_file.h"
#include "models/input/input_error.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class TrajectoryReader : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string Table() const {
    const TrajectoryTable table(plan_, robot_);
    std::string text = table.Header();
    VisitKnots(plan_, [&](const PlanSample& sample) { text += table.Rows(sample); });
    return text;
  }

  ImportedTrajectory Read(const std::string& text) const {
    const std::filesystem::path file = folder_ / "motion.csv";
    std::ofstream(file) << text;
    return ReadTrajectory(file, robot_);
  }

  void ExpectRefused(const std::string& text, const std::string& message) const {
    try {
      Read(text);
      ADD_FAILURE() << "accepted, expected: " << message;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), (folder_ / "motion.csv").string() + message);
    }
  }

  /// Of the sample plan.
  void ExpectThePlan(const ImportedTrajectory& trajectory) const {
    ASSERT_EQ(trajectory.samples.size(), 18u);
    for (int i = 0; i < 18; ++i) {
      const ImportedSample& sample = trajectory.samples[i];
      const actions::Knot& knot = plan_.segments[i / 9].phases[0].knots[i % 9];
      EXPECT_EQ(sample.t, knot.t);
      EXPECT_LT((sample.q - knot.q).norm(), 1e-15);
      EXPECT_EQ(sample.v, knot.v);
      EXPECT_EQ(sample.a, knot.a);
      EXPECT_EQ(sample.segment, i / 9);
      EXPECT_EQ(sample.bears, std::vector<bool>({true, true, true, true, i >= 9}));
    }
    EXPECT_EQ(trajectory.actions, std::vector<std::string>({"walk", "walk->crawl"}));
  }

  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
  const models::Scenario scenario_ = testing::SampleScenario();
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("trajectory_" + std::to_string(::getpid()));
  static constexpr const char* kHead =
      "t,q_root_qw,q_root_qx,q_root_qy,q_root_qz,q_root_x,q_root_y,q_root_z,q_hip,contact_sole\n";
};

TEST_F(TrajectoryReader, ReadsTheTableThatExportWrites) { ExpectThePlan(Read(Table())); }

TEST_F(TrajectoryReader, ReadsTheArraysThatExportWrites) {
  WriteNpz({plan_, robot_, scenario_}, {}, folder_ / "motion.npz");
  ExpectThePlan(ReadTrajectory(folder_ / "motion.npz", robot_));
}

TEST_F(TrajectoryReader, FindsComponentsOfArraysByTheirNames) {
  std::map<std::string, NpyArray> arrays = TrajectoryArrays({plan_, robot_, scenario_}, {});
  const std::vector<std::string> names = Texts(arrays.at("v_names"), "v_names");
  const std::vector<double> v = Numbers(arrays.at("v"), "v");
  NpyArray reversed = EmptyRows("<f8", {7});
  for (int row = 0; row < 18; ++row) {
    AppendRow(Eigen::Map<const Eigen::VectorXd>(v.data() + 7 * row, 7).reverse().eval(), &reversed);
  }
  arrays["v"] = reversed;
  arrays["v_names"] = TextArray({names.rbegin(), names.rend()});
  models::ZipWriter archive(folder_ / "motion.npz");
  for (const auto& [name, array] : arrays) archive.Add(name + ".npy", NpyFile(array));
  archive.Commit();
  ExpectThePlan(ReadTrajectory(folder_ / "motion.npz", robot_));
}

TEST_F(TrajectoryReader, PositionsAndContactsAreEnough) {
  const ImportedTrajectory trajectory =
      Read(std::string(kHead) + "5,1,0,0,0,0,0,0,0.1,1\n6,-1.0005,0,0,0,0,0,0,0.2,0\n");
  EXPECT_FALSE(trajectory.has_velocities());
  EXPECT_FALSE(trajectory.has_accelerations());
  EXPECT_EQ(trajectory.samples[1].t, 1) << "time begins at 0";
  EXPECT_EQ(trajectory.samples[1].q[0], -1) << "the quaternion gets length 1";
  EXPECT_EQ(trajectory.samples[0].bears, std::vector<bool>({true, true, true, true, false}));
  EXPECT_TRUE(trajectory.actions.empty());
}

TEST_F(TrajectoryReader, TimesThatDifferByRoundingAreOne) {
  const std::string rest = ",1,0,0,0,0,0,0,0.1,1\n";
  const ImportedTrajectory trajectory =
      Read(std::string(kHead) + "0" + rest + "1.0000000000000002" + rest + "1" + rest + "2" + rest);
  EXPECT_GE(trajectory.samples[2].t, trajectory.samples[1].t);
  EXPECT_TRUE(SharesTime(trajectory, 1));
}

TEST_F(TrajectoryReader, MistakesAreNamedWithTheirPlace) {
  const std::string head = kHead;
  const std::string row = "0,1,0,0,0,0,0,0,0.1,1\n";
  const std::string next = "1,1,0,0,0,0,0,0,0.1,1\n";
  ExpectRefused("", ": empty, expected a header and rows");
  ExpectRefused(head + row, ": expected at least two samples");
  ExpectRefused(head + row + row, ": t: expected a motion that lasts");
  ExpectRefused(head + next + row, ": sample 1: t: 0 comes after 1, expected times in order");
  ExpectRefused(head + row + "1,1,0,0\n", ":3: expected 10 fields, got 4");
  ExpectRefused(head + row + "1,1,0,0,0,0,0,x,0.1,1\n", ":3: q_root_z: expected a number, got 'x'");
  ExpectRefused(head + row + "1,1,0,0,0,0,0,0,0.1,2\n", ":3: contact: expected 0 or 1, got 2");
  ExpectRefused(head + row + "1,1,1,0,0,0,0,0,0.1,1\n",
                ": sample 1: root orientation: expected a unit quaternion, got length "
                "1.4142135623730951");
  ExpectRefused(head + row + "1,1,0,0,0,0,0,0,2e6,1\n",
                ": sample 1: expected numbers up to 1000000");
  ExpectRefused("t,q_root_qw\n", ":1: no column 'q_root_qx' (did you mean 'q_root_qw'?)");
  ExpectRefused("t,t\n", ":1: two columns 't'");
  std::string without = head;
  without.resize(without.rfind(','));
  ExpectRefused(without + "\n", ":1: no column of contacts, expected for instance 'contact_sole'");
}

}  // namespace
}  // namespace possibility::experiments
