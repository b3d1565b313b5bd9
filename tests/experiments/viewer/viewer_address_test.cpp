// The page in a browser: what its address asks for, and the address that it offers.
#include <gtest/gtest.h>

#include <string>

#include "experiments/viewer/viewer_page.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/viewer/browser.h"

namespace possibility::experiments {
namespace {

class ViewerAddress : public testing::BrowserTest {
 protected:
  void SetUp() override {
    BrowserTest::SetUp();
    if (IsSkipped()) return;
    const models::RobotModel robot = testing::SampleRobot();
    WritePage(ViewerPage(testing::SamplePlan(robot, 4, 9), robot, testing::SampleScenario()));
  }
};

TEST_F(ViewerAddress, TheLinkLeadsToTheTimeAndViewThatAreShown) {
  const std::string document = Opened("#t=1.5&camera=3,-2,1.5,0.5,0.25,0.75&graph=0");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "<output id=\"clock\" aria-live=\"off\">", "<"), "1.50 / 4.00 s");
  EXPECT_EQ(Between(document, "<a id=\"link\" href=\"", "\""),
            "#t=1.500&amp;camera=3.000,-2.000,1.500,0.500,0.250,0.750&amp;graph=0");
}

TEST_F(ViewerAddress, ACameraThatIsNoPlaceIsIgnored) {
  const std::string document = Opened("#t=9&camera=1,2,x&view=top");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "<output id=\"clock\" aria-live=\"off\">", "<"), "4.00 / 4.00 s");
  const std::string link = Between(document, "<a id=\"link\" href=\"", "\"");
  EXPECT_TRUE(link.starts_with("#t=4.000&amp;camera=")) << link;
  EXPECT_EQ(link.find("nan"), std::string::npos);
  EXPECT_EQ(link.find("x"), std::string::npos);
}

}  // namespace
}  // namespace possibility::experiments
