#include "experiments/viewer_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>

#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

constexpr const char* kNasty = "</script><img src=x onerror=alert(1)>&\"'{{data}}\u2028";

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

nlohmann::json EmbeddedData(const std::string& page) {
  const std::string opening = "<script type=\"application/json\" id=\"plan-data\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

class ViewerPageTest : public ::testing::Test {
 protected:
  std::string Page() const { return ViewerPage(plan_, robot_, scenario_); }

  models::RobotModel robot_ = testing::SampleRobot();
  models::Scenario scenario_ = testing::SampleScenario();
  actions::Plan plan_ = testing::SamplePlan(robot_, 4, 9);
};

TEST_F(ViewerPageTest, HoldsEveryName) {
  const nlohmann::json data = EmbeddedData(Page());
  EXPECT_EQ(data["links"][1]["name"], "leg");
  EXPECT_EQ(data["joints"][0]["name"], "hip");
  EXPECT_EQ(data["contacts"][0]["name"], "sole");
  EXPECT_EQ(data["obstacles"][1]["name"], "bar");
  EXPECT_EQ(data["segments"][1]["action"], "walk->crawl");
  EXPECT_EQ(data["segments"][1]["phases"][0]["contacts"], (std::vector<int>{0, 1}));
  EXPECT_EQ(data["explored"]["actions"], (std::vector<std::string>{"walk", "crawl"}));
}

TEST_F(ViewerPageTest, SaysWhichPointsOfAPatchBear) {
  using Points = std::vector<std::vector<int>>;
  EXPECT_EQ(EmbeddedData(Page())["segments"][1]["phases"][0]["points"],
            (Points{{0, 1, 2, 3}, {0}}));
  actions::Phase& phase = plan_.segments[1].phases[0];
  phase.contacts[0] = "sole[0,3]";
  for (actions::Knot& knot : phase.knots) knot.forces.setZero(3, 3);
  plan_.segments[0].phases[0].contacts.clear();
  const nlohmann::json data = EmbeddedData(Page());
  EXPECT_EQ(data["segments"][1]["phases"][0]["contacts"], (std::vector<int>{0, 1}));
  EXPECT_EQ(data["segments"][1]["phases"][0]["points"], (Points{{0, 3}, {0}}));
  EXPECT_TRUE(data["segments"][0]["phases"][0]["points"].empty());
}

TEST_F(ViewerPageTest, FactsArePairsInOrder) {
  const nlohmann::json facts = EmbeddedData(Page())["facts"];
  ASSERT_TRUE(facts.is_array());
  EXPECT_EQ(facts[0], (std::vector<std::string>{"Scenario", "yard"}));
  EXPECT_EQ(facts[2], (std::vector<std::string>{"Duration", "4.0 s"}));
  EXPECT_EQ(facts[3], (std::vector<std::string>{"Planned in", "2.00 s"}));
}

TEST_F(ViewerPageTest, LoadsNothingFromOutside) {
  const std::string page = Page();
  EXPECT_NE(page.find("Content-Security-Policy\" content=\"default-src 'none'"), std::string::npos);
  EXPECT_FALSE(std::regex_search(page, std::regex("<script[^>]*\\ssrc")));
  EXPECT_EQ(Count(page, "<link"), 0u);
  EXPECT_EQ(Count(page, "<iframe"), 0u);
  EXPECT_EQ(Count(page, "@import"), 0u);
  EXPECT_EQ(Count(page, "{{"), 0u) << "a part of the template was not filled in";
}

TEST_F(ViewerPageTest, NamesCannotBecomeMarkupOrCode) {
  const std::string harmless = Page();
  scenario_.name = robot_.name = kNasty;
  robot_.links[0].name = robot_.joints[0].name = robot_.contacts[1].name = kNasty;
  scenario_.environment.obstacles[0].name = kNasty;
  plan_.segments[0].action = plan_.explored.edges[0].action = kNasty;
  plan_.segments[1].phases[0].contacts[1] = kNasty;
  const std::string page = Page();
  for (const char* part : {"<script", "</script>", "<img", "<title"}) {
    EXPECT_EQ(Count(page, part), Count(harmless, part)) << part;
  }
  EXPECT_EQ(EmbeddedData(page)["links"][0]["name"], kNasty);
  EXPECT_EQ(EmbeddedData(page)["segments"][0]["action"], kNasty);
}

TEST_F(ViewerPageTest, TextThatIsNotUtf8DoesNotBreakThePage) {
  scenario_.environment.obstacles[0].name = "wall\xff\xfe";
  EXPECT_EQ(EmbeddedData(Page())["obstacles"][0]["name"], "wall\uFFFD\uFFFD");
}

TEST_F(ViewerPageTest, KeepsTheEndsOfEveryPhaseWhenItThinsOutKnots) {
  plan_ = testing::SamplePlan(robot_, 4, 2001);
  const nlohmann::json data = EmbeddedData(Page());
  const nlohmann::json& first = data["segments"][0]["phases"][0];
  const nlohmann::json& second = data["segments"][1]["phases"][0];
  EXPECT_LE(first["count"], 52);
  EXPECT_GE(first["count"], 45);
  EXPECT_EQ(second["first"], first["count"]);
  EXPECT_EQ(second["forces"], 12 * first["count"].get<int>());
  const std::size_t num_knots = first["count"].get<int>() + second["count"].get<int>();
  const std::size_t bytes = 4 * num_knots * (1 + robot_.nq());
  EXPECT_EQ(data["knots"].get<std::string>().size(), (bytes + 2) / 3 * 4);
}

TEST_F(ViewerPageTest, DrawsAPlanWithoutSegments) {
  plan_.segments.clear();
  EXPECT_TRUE(EmbeddedData(Page())["segments"].empty());
}

TEST_F(ViewerPageTest, FiveMinutesOfAHumanoidStayUnderSixMegabytes) {
  const models::Joint hinge = robot_.joints[0];
  for (int i = 0; i < 26; ++i) {
    robot_.joints.push_back(hinge);
    robot_.links.push_back(robot_.links[1]);
  }
  plan_ = testing::SamplePlan(robot_, 300, 15001);
  EXPECT_LT(Page().size(), 6u << 20);
}

}  // namespace
}  // namespace possibility::experiments
