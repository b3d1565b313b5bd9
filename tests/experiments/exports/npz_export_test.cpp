#include "experiments/exports/npz_export.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <sstream>

#include "models/archive/zip_file.h"
#include "tests/experiments/exports/python_run.h"
#include "tests/experiments/read_text.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class NpzExport : public ::testing::Test {
 protected:
  void SetUp() override { WriteNpz({plan_, robot_, scenario_}, {std::nullopt, true}, file_); }
  void TearDown() override { std::filesystem::remove(file_); }

  NpyArray Member(const std::string& name) const {
    return ReadNpy(models::ReadZip(testing::ReadText(file_), file_).at(name + ".npy"), name);
  }

  const models::RobotModel robot_ = testing::SampleRobot();
  const actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
  const models::Scenario scenario_ = testing::SampleScenario();
  const std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / fmt::format("export_{}.npz", ::getpid());
};

TEST_F(NpzExport, KnotsReadBackToTheSameNumbers) {
  const NpyArray q = Member("q");
  EXPECT_EQ(q.shape, std::vector<std::size_t>({18, 8}));
  const std::vector<double> numbers = Numbers(q, "q");
  const actions::Knot& knot = plan_.segments[1].phases[0].knots[2];  // row 9 + 2
  for (int i = 0; i < robot_.nq(); ++i) EXPECT_EQ(numbers[11 * 8 + i], knot.q[i]);
  EXPECT_EQ(Numbers(Member("t"), "t")[11], knot.t);
  EXPECT_EQ(Numbers(Member("segment"), "segment")[11], 1);
  EXPECT_EQ(Texts(Member("q_names"), "q_names").back(), "hip");
  EXPECT_EQ(Texts(Member("q_units"), "q_units").back(), "rad");
  EXPECT_EQ(Texts(Member("actions"), "actions"), std::vector<std::string>({"walk", "walk->crawl"}));
}

TEST_F(NpzExport, ForcesStandAtTheirPointsAndAreZeroElsewhere) {
  const std::vector<double> contact = Numbers(Member("contact"), "contact");
  const std::vector<double> forces = Numbers(Member("forces"), "forces");
  ASSERT_EQ(contact.size(), 18u * 5);
  for (int row = 0; row < 18; ++row) {
    const actions::Phase& phase = plan_.segments[row / 9].phases[0];
    for (int point = 0; point < 5; ++point) {
      const bool bears = point < 4 || row >= 9;
      EXPECT_EQ(contact[5 * row + point], bears);
      const double expected = bears ? phase.knots[row % 9].forces(2, point) : 0;
      EXPECT_EQ(forces[15 * row + 3 * point + 2], expected);
    }
  }
}

TEST_F(NpzExport, OpensInNumpy) {
  if (!testing::HasNumpy()) GTEST_SKIP() << "python3-numpy is not installed";
  const testing::PythonRun run = testing::RunPython(fmt::format(
      R"(
import numpy as np
d = np.load("{}")
hip = list(d["tau_names"]).index("hip")
print(d["format"], d["t"].shape, d["forces"].shape, d["contact"].dtype, d["margins"].shape)
print(repr(float(d["tau"][11, hip])), d["tau_units"][hip], repr(float(d["q"][17].sum())))
)",
      file_.string()));
  ASSERT_EQ(run.code, 0) << run.out;
  std::istringstream lines(run.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "possibility-trajectory/1 (18,) (18, 5, 3) bool (18, 7)");
  double torque = 0;
  std::string unit[2];
  double sum = 0;
  lines >> torque >> unit[0] >> unit[1] >> sum;
  EXPECT_EQ(torque, plan_.segments[1].phases[0].knots[2].tau[0]);
  EXPECT_EQ(unit[0] + unit[1], "Nm");
  EXPECT_NEAR(sum, plan_.segments[1].phases[0].knots[8].q.sum(), 1e-14);
}

}  // namespace
}  // namespace possibility::experiments
