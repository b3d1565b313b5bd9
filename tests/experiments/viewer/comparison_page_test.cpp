// Two plans in one page.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "experiments/viewer/viewer_page.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/viewer/browser.h"
#include "tests/experiments/viewer/page_data.h"

namespace possibility::experiments {
namespace {

/// Plans of 4 and 2.5 s, of robots with one and two joints.
std::string Comparison(const std::string& name_of_second = "cellar") {
  const models::RobotModel robot = testing::SampleRobot();
  models::RobotModel other = robot;
  other.links.push_back(other.links[1]);
  other.joints.push_back(other.joints[0]);
  other.joints[1].name = "knee";
  models::Scenario scenario = testing::SampleScenario();
  models::Scenario cellar = scenario;
  cellar.name = name_of_second;
  const actions::Plan first = testing::SamplePlan(robot, 4, 9);
  const actions::Plan second = testing::SamplePlan(other, 2.5, 9);
  return ComparisonPage({first, robot, scenario}, {second, other, cellar});
}

nlohmann::json SecondData(const std::string& page) {
  const std::string opening = "<script type=\"application/json\" id=\"plan-data-b\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST(ComparisonPageTest, HoldsBothPlans) {
  const std::string page = Comparison();
  const nlohmann::json first = testing::EmbeddedData(page);
  const nlohmann::json second = SecondData(page);
  EXPECT_EQ(first["joints"].size(), 1u);
  EXPECT_EQ(second["joints"].size(), 2u);
  EXPECT_EQ(testing::PageMotion(first).knots.size(), 18u * 9);
  EXPECT_EQ(testing::PageMotion(second).knots.size(), 18u * 10);
  EXPECT_NE(page.find("<title>yard and cellar – possibility</title>"), std::string::npos);
}

TEST(ComparisonPageTest, NamesOfTheSecondCannotBecomeMarkup) {
  const std::string nasty = "</script><img src=x onerror=alert(1)>{{data}}";
  const std::string page = Comparison(nasty);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(SecondData(page)["facts"][0][1], nasty);
}

class ComparisonInBrowser : public testing::BrowserTest {};

TEST_F(ComparisonInBrowser, BothPlansHaveOneTime) {
  WritePage(Comparison());
  const std::string document = Opened("#t=3");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "<output id=\"clock\" aria-live=\"off\">", "<"), "3.00 / 4.00 s");
  EXPECT_EQ(Between(document, "id=\"contacts\" class=\"contacts\" title=\"", "\""), "sole, peg");
  EXPECT_EQ(Between(document, "id=\"contacts-b\" class=\"contacts\" title=\"", "\""),
            "ended at 2.50 s");
}

TEST_F(ComparisonInBrowser, APlanBesideNoneHasItsPlots) {
  const models::RobotModel robot = testing::SampleRobot();
  const models::Scenario yard = testing::SampleScenario();
  actions::Plan none;
  none.no = {"exhausted", "", {}};
  const actions::Plan plan = testing::SamplePlan(robot, 4, 9);
  WritePage(ComparisonPage({none, robot, yard}, {plan, robot, yard}));
  const std::string document = Opened("#t=3&plots=1");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "<b id=\"plots-title\">", "<"),
            "walk-&gt;crawl, segment 2 of 2: 2.00 to 4.00 s");
  EXPECT_EQ(Between(document, "id=\"contacts\" class=\"contacts\">", "<"), "no motion");
}

/// The worlds are one, so a place in the one is the same place in the other.
TEST_F(ComparisonInBrowser, BothAreSeenFromTheSamePlace) {
  WritePage(Comparison());
  const std::string show =
      "document.body.setAttribute('data-places', page.views.map(({drawing}) => "
      "drawing.place().map((x) => x.toFixed(2)).join(' ')).join('; '))";
  const std::string document = Opened("#camera=3,-2,1.5,0.5,0.25,0.75", show);
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "data-places=\"", "\""),
            "3.00 -2.00 1.50 0.50 0.25 0.75; 3.00 -2.00 1.50 0.50 0.25 0.75");
}

}  // namespace
}  // namespace possibility::experiments
