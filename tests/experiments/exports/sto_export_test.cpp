#include "experiments/exports/sto_export.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "experiments/exports/sto_columns.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d RotationOf(const Vector3d& angles) {
  return (AngleAxisd(angles[0], Vector3d::UnitX()) * AngleAxisd(angles[1], Vector3d::UnitY()) *
          AngleAxisd(angles[2], Vector3d::UnitZ()))
      .toRotationMatrix();
}

TEST(BodyFixedAnglesTest, TurnBackIntoTheRotationAndDoNotJump) {
  BodyFixedAngles angles;
  Vector3d last = Vector3d::Zero();
  for (double t = 0; t < 20; t += 0.01) {  // several turns, past a quarter turn about y
    const Vector3d smooth(0.7 * t, 2 * std::sin(0.3 * t), -0.4 * t);
    const Vector3d found = angles.Of(RotationOf(smooth));
    EXPECT_LT((RotationOf(found) - RotationOf(smooth)).norm(), 1e-9);
    EXPECT_LT((found - last).norm(), 0.05) << t;
    last = found;
  }
}

TEST(BodyFixedAnglesTest, RatesAreThoseOfTheAngles) {
  const auto at = [](double t) { return Vector3d(0.3 + t, -1.2 + 0.5 * t, 0.8 - 2 * t); };
  const double h = 1e-5;
  const Matrix3d W =
      (RotationOf(at(h)) - RotationOf(at(-h))) / (2 * h) * RotationOf(at(0)).transpose();
  BodyFixedAngles angles;
  angles.Of(RotationOf(at(0)));
  EXPECT_LT((angles.Rates({W(2, 1), W(0, 2), W(1, 0)}) - Vector3d(1, 0.5, -2)).norm(), 1e-8);
}

TEST(PatchLoadTest, IsTheWrenchOfThePoints) {
  Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Random(3, 4);
  Eigen::Matrix3Xd forces = 50 * Eigen::Matrix3Xd::Random(3, 4);
  const PatchLoad load = LoadOf(points, forces);
  Vector3d moment = Vector3d::Zero();
  for (int i = 0; i < 4; ++i) moment += Vector3d(points.col(i)).cross(Vector3d(forces.col(i)));
  EXPECT_LT((load.centre.cross(load.force) + load.moment - moment).norm(), 1e-12);
  EXPECT_LT((load.force - forces.rowwise().sum()).norm(), 1e-12);
  EXPECT_EQ(LoadOf(Eigen::Matrix3Xd(3, 0), Eigen::Matrix3Xd(3, 0)).force, Vector3d::Zero());
}

class StoExport : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("storage_" + std::to_string(::getpid()) + ".sto");
  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
  const models::Scenario scenario_ = testing::SampleScenario();
};

TEST_F(StoExport, HeaderTellsRowsAndColumns) {
  WriteSto({plan_, robot_, scenario_}, {0.5, false}, file_);
  std::istringstream lines(testing::ReadText(file_));
  std::map<std::string, std::string> header;
  std::string line;
  while (std::getline(lines, line) && line != "endheader") {
    const std::size_t sign = line.find('=');
    if (sign != std::string::npos) header[line.substr(0, sign)] = line.substr(sign + 1);
  }
  EXPECT_EQ(header["inDegrees"], "no");
  EXPECT_EQ(header["DataType"], "double");
  EXPECT_EQ(header["nRows"], "9");
  std::getline(lines, line);
  std::istringstream words(line);
  std::vector<std::string> labels;
  for (std::string label; std::getline(words, label, '\t');) labels.push_back(label);
  EXPECT_EQ(std::to_string(labels.size()), header["nColumns"]);
  EXPECT_EQ(labels[0], "time");
  EXPECT_EQ(std::set<std::string>(labels.begin(), labels.end()).size(), labels.size());
  const auto column = [&](const std::string& label) {
    return std::find(labels.begin(), labels.end(), label) - labels.begin();
  };
  double before = -1;
  for (int row = 0; row < 9; ++row) {
    ASSERT_TRUE(std::getline(lines, line));
    std::istringstream fields(line);
    std::vector<double> numbers;
    for (double number; fields >> number;) numbers.push_back(number);
    ASSERT_EQ(numbers.size(), labels.size());
    EXPECT_GT(numbers[0], before);
    before = numbers[0];
    const actions::Knot& knot = plan_.segments[row < 4 ? 0 : 1].phases[0].knots[2 * (row % 4)];
    if (row == 8) break;
    EXPECT_EQ(numbers[column("/jointset/hip/hip/value")], knot.q[7]);
    EXPECT_EQ(numbers[column("/jointset/root_joint/root_tz/speed")], knot.v[5]);
    EXPECT_EQ(numbers[column("/forceset/hip")], knot.tau[0]);
    EXPECT_NEAR(numbers[column("ground_force_sole_vz")], knot.forces.leftCols(4).row(2).sum(),
                1e-9);
    EXPECT_EQ(numbers[column("ground_force_peg_vz")], row < 4 ? 0 : knot.forces(2, 4));
  }
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace possibility::experiments
