#include "actions/onboarding/robot_report.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "actions/gait/pace_library.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

TEST(RobotReport, TheSpeedIsThatOfTheLibrarysPaces) {
  models::RobotModel robot = DrcHubo1();
  robot.gaits = {robot.GaitNamed("walk")};
  const Pace slow = DrcHubo1Flowing("walk").motion().paces().back();
  ASSERT_LT(slow.speed(), DrcHubo1Flowing("walk").motion().paces().front().speed());
  const models::TemporaryFolder library;
  PaceLibrary(robot, library.path()).Save(robot.gaits.front(), {slow});
  const std::vector<RobotFinding> findings = ReportOn(robot, library.path());
  const auto speed =
      std::find_if(findings.begin(), findings.end(),
                   [](const RobotFinding& finding) { return finding.subject == "walk: speed"; });
  ASSERT_NE(speed, findings.end());
  const std::string expected = fmt::format("{:.2f} m/s. ", slow.speed());
  EXPECT_EQ(speed->text.substr(0, expected.size()), expected) << speed->text;
}

}  // namespace
}  // namespace possibility::actions
