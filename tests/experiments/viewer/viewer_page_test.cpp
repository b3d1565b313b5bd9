#include "experiments/viewer/viewer_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/report/action_colors.h"
#include "experiments/viewer/viewer_packing.h"
#include "models/world/terrain.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/hop_plan.h"
#include "tests/experiments/sample_plan.h"
#include "tests/experiments/viewer/page_data.h"

namespace possibility::experiments {
namespace {

using testing::EmbeddedData;

constexpr const char* kNasty = "</script><img src=x onerror=alert(1)>&\"'{{data}}\u2028";

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
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

TEST_F(ViewerPageTest, HoldsTheColourOfEveryActionThatItShows) {
  plan_.explored.edges[0].action = "vault";
  plan_.no = {"exhausted", "", {}};
  plan_.no->barrier = {{1, 0.5}, 2, {}, {{"jump", 0, {}}, {"", 0, {}}}};
  const nlohmann::json data = EmbeddedData(Page());
  for (const std::string action : {"walk", "walk->crawl", "crawl", "vault", "jump", ""}) {
    EXPECT_EQ(data["action_colors"][action], ActionColor(action)) << action;
  }
}

TEST_F(ViewerPageTest, HoldsASurfaceOnceAndNotItsPieces) {
  const std::size_t others = EmbeddedData(Page())["obstacles"].size();
  models::TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  models::AddTerrain({"hill", mesh, true, std::nullopt}, &scenario_.environment);
  ASSERT_EQ(scenario_.environment.obstacles.size(), others + 2);
  const nlohmann::json data = EmbeddedData(Page());
  EXPECT_EQ(data["obstacles"].size(), others);
  ASSERT_EQ(data["surfaces"].size(), 1u);
  const nlohmann::json& surface = data["surfaces"][0];
  EXPECT_EQ(surface["name"], "hill");
  EXPECT_EQ(surface["ground"], true);
  const std::vector<float> vertices = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.5};
  const std::vector<std::int32_t> triangles = {0, 1, 2, 0, 2, 3};
  EXPECT_EQ(surface["vertices"], Packed(vertices));
  EXPECT_EQ(surface["triangles"], Packed(triangles));
}

TEST_F(ViewerPageTest, HoldsThePointsOfAPatchThatBear) {
  using Points = std::vector<std::vector<int>>;
  EXPECT_EQ(EmbeddedData(Page())["segments"][1]["phases"][0]["points"],
            (Points{{0, 1, 2, 3}, {0}}));
  actions::Phase& phase = plan_.segments[1].phases[0];
  phase.contacts[0] = "sole[0,3]";
  for (actions::Knot& knot : phase.knots) knot.forces.setZero(3, 3);
  plan_.segments[0].phases[0].contacts.clear();
  for (actions::Knot& knot : plan_.segments[0].phases[0].knots) knot.forces.resize(3, 0);
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
  EXPECT_EQ(facts[3][0], "Path length");
  EXPECT_EQ(facts[4][0], "Cost of transport");
  EXPECT_EQ(facts[5], (std::vector<std::string>{"Planned in", "2.00 s"}));
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

TEST_F(ViewerPageTest, InvalidUtf8IsReplacedInThePage) {
  scenario_.environment.obstacles[0].name = "wall\xff\xfe";
  EXPECT_EQ(EmbeddedData(Page())["obstacles"][0]["name"], "wall\uFFFD\uFFFD");
}

TEST_F(ViewerPageTest, ThinningOutKnotsKeepsTheEndsOfEachPhase) {
  plan_ = testing::SamplePlan(robot_, 4, 2001);
  const nlohmann::json data = EmbeddedData(Page());
  const nlohmann::json& first = data["segments"][0]["phases"][0];
  const nlohmann::json& second = data["segments"][1]["phases"][0];
  EXPECT_LE(first["count"], 52);
  EXPECT_GE(first["count"], 45);
  const std::size_t num_knots = first["count"].get<int>() + second["count"].get<int>();
  EXPECT_EQ(testing::PageMotion(data).knots.size(), num_knots * (1 + robot_.nq()));
}

TEST_F(ViewerPageTest, RepeatedStepsAddLittleToTheSize) {
  plan_ = testing::SamplePlan(robot_, 4, 40);
  const std::size_t one = Page().size();
  const actions::Segment step = plan_.segments[0];
  for (int i = 1; i < 100; ++i) {
    actions::Segment next = step;
    for (actions::Knot& knot : next.phases[0].knots) {
      knot.t += 2 * i + 2;
      knot.q[4] += i;
    }
    plan_.segments.push_back(next);
  }
  // Time, place, balance, margins and indices of every step, in base64.
  const std::size_t each = 4 * (40 * 7 + 73) * 4 / 3 + 200;
  EXPECT_LT(Page().size(), one + 100 * each);
}

TEST_F(ViewerPageTest, EveryElementThatScriptsUseExists) {
  const std::string page = Page();
  const std::regex asked("(?:element|part)\\('([a-z-]+)'\\)");
  std::set<std::string> names;
  for (std::sregex_iterator it(page.begin(), page.end(), asked), end; it != end; ++it) {
    names.insert((*it)[1]);
  }
  EXPECT_GT(names.size(), 15u);
  for (const std::string& name : names) {
    EXPECT_EQ(Count(page, "id=\"" + name + "\""), 1u) << name;
  }
}

TEST_F(ViewerPageTest, InfiniteLimitsAreNull) {
  robot_.joints[0].lower = -1.5;
  robot_.joints[0].upper = 2;
  robot_.joints[0].velocity = 3;
  robot_.joints[0].effort = INFINITY;
  const nlohmann::json joint = EmbeddedData(Page())["joints"][0];
  EXPECT_EQ(joint["range"], (std::vector<double>{-1.5, 2}));
  EXPECT_EQ(joint["speed"], 3);
  EXPECT_TRUE(joint["effort"].is_null());
  robot_.joints[0].upper = INFINITY;
  EXPECT_TRUE(EmbeddedData(Page())["joints"][0]["range"].is_null());
}

TEST_F(ViewerPageTest, TablesHoldRatesAndTorquesOfTheKnots) {
  const nlohmann::json data = EmbeddedData(Page());
  const testing::PageMotion motion(data);
  const std::vector<float>& rates = motion.rates;
  const std::vector<float>& torques = motion.torques;
  ASSERT_EQ(rates.size(), 18u);  // one joint, two phases of nine knots
  ASSERT_EQ(torques.size(), 18u);
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const actions::Knot& knot = plan_.segments[i / 9].phases[0].knots[i % 9];
    EXPECT_NEAR(rates[i], knot.v[6], 1e-7) << i;
    EXPECT_NEAR(torques[i], knot.tau[0], 1e-5) << i;
  }
}

/// A hop of the shipped robot, with a flight and an impact.
class ViewerHopTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const models::RobotModel& robot = actions::DrcHubo1();
    plan_.segments = {actions::testing::Hop(robot).Build()};
    data_ = EmbeddedData(ViewerPage(plan_, robot, testing::SampleScenario()));
    const testing::PageMotion motion(data_);
    knots_ = motion.knots;
    centres_ = motion.centres;
    momenta_ = motion.momenta;
    balance_ = motion.balance;
    forces_ = motion.forces;
    stride_ = 1 + robot.nq();
  }

  static const nlohmann::json& Phases() { return data_["segments"][0]["phases"]; }
  static int First(const nlohmann::json& phase) { return phase["first"]; }
  static int Last(const nlohmann::json& phase) {
    return First(phase) + phase["count"].get<int>() - 1;
  }
  static double Time(int knot) { return knots_[stride_ * knot]; }
  static Eigen::Vector3d Centre(int knot) {
    return Eigen::Vector3f(&centres_[3 * knot]).cast<double>();
  }

  static actions::Plan plan_;
  static nlohmann::json data_;
  static int stride_;
  static std::vector<float> knots_;
  static std::vector<float> centres_;
  static std::vector<float> momenta_;
  static std::vector<float> balance_;
  static std::vector<float> forces_;
};

actions::Plan ViewerHopTest::plan_;
nlohmann::json ViewerHopTest::data_;
int ViewerHopTest::stride_ = 0;
std::vector<float> ViewerHopTest::knots_;
std::vector<float> ViewerHopTest::centres_;
std::vector<float> ViewerHopTest::momenta_;
std::vector<float> ViewerHopTest::balance_;
std::vector<float> ViewerHopTest::forces_;

TEST_F(ViewerHopTest, TheFlightOfTheCentreOfMassIsTheParabolaBetweenItsEnds) {
  const nlohmann::json& flight = Phases()[1];
  ASSERT_EQ(flight["name"], "flight");
  ASSERT_GT(flight["count"], 5);
  const int first = First(flight);
  const int last = Last(flight);
  const double duration = Time(last) - Time(first);
  const double g = data_["gravity"];
  EXPECT_NEAR(g, 9.80665, 1e-12);
  for (int knot = first; knot <= last; ++knot) {
    const double s = (Time(knot) - Time(first)) / duration;
    Eigen::Vector3d expected = (1 - s) * Centre(first) + s * Centre(last);
    expected.z() += g / 2 * duration * duration * s * (1 - s);
    EXPECT_LT((Centre(knot) - expected).norm(), 1e-6) << knot;
  }
}

TEST_F(ViewerHopTest, PhasesCoverTheSegmentWithoutGaps) {
  ASSERT_EQ(Phases().size(), plan_.segments[0].phases.size());
  EXPECT_EQ(First(Phases()[0]), 0);
  EXPECT_EQ(Time(0), 0);
  for (std::size_t i = 1; i < Phases().size(); ++i) {
    EXPECT_EQ(First(Phases()[i]), Last(Phases()[i - 1]) + 1);
    EXPECT_EQ(Time(First(Phases()[i])), Time(Last(Phases()[i - 1])));
  }
  const int last = Last(Phases().back());
  EXPECT_EQ(stride_ * (last + 1), static_cast<int>(knots_.size()));
  EXPECT_NEAR(Time(last), plan_.segments[0].phases.back().knots.back().t, 1e-6);
  for (const nlohmann::json& phase : Phases())
    EXPECT_FALSE(phase["name"].get<std::string>().empty());
}

TEST_F(ViewerHopTest, ListsImpulsesExactlyWhereThePlanHasThem) {
  for (std::size_t i = 0; i < Phases().size(); ++i) {
    const Eigen::Matrix3Xd& impulses = plan_.segments[0].phases[i].impulses;
    ASSERT_EQ(Phases()[i].contains("impulses"), impulses.cols() > 0) << i;
    if (impulses.cols() == 0) continue;
    const std::vector<double> listed = Phases()[i]["impulses"];
    ASSERT_EQ(listed.size(), static_cast<std::size_t>(impulses.size()));
    for (std::size_t k = 0; k < listed.size(); ++k) {
      EXPECT_NEAR(listed[k], impulses.reshaped()[k], 1e-5);
    }
  }
  EXPECT_TRUE(Phases()[2].contains("impulses"));
}

TEST_F(ViewerHopTest, InTheAirOnlyWeightChangesMomentum) {
  const int first = First(Phases()[1]);
  for (int knot = first; knot <= Last(Phases()[1]); ++knot) {
    const double lost = data_["weight"].get<double>() * (Time(knot) - Time(first));
    for (int i = 0; i < 6; ++i) {
      const double expected = momenta_[6 * first + i] - (i == 2 ? lost : 0);
      EXPECT_NEAR(momenta_[6 * knot + i], expected, 2e-4) << knot << " " << i;
    }
  }
}

TEST_F(ViewerHopTest, TheZeroMomentPointIsTheMeanOfThePointsWeightedByTheirForces) {
  const models::RobotModel& robot = actions::DrcHubo1();
  dynamics::TreeKinematics kinematics(robot);
  for (const nlohmann::json& phase : Phases()) {
    std::size_t next = phase["forces"];
    for (int knot = First(phase); knot <= Last(phase); ++knot) {
      kinematics.SetPosition(
          Eigen::Map<Eigen::VectorXf>(&knots_[stride_ * knot + 1], stride_ - 1).cast<double>());
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double load = 0;
      for (std::size_t i = 0; i < phase["contacts"].size(); ++i) {
        const models::ContactPatch& patch = robot.contacts[phase["contacts"][i].get<int>()];
        for (const int point : phase["points"][i]) {
          sum += forces_[next + 2] * kinematics.Position(patch.link, patch.points[point]);
          load += forces_[next + 2];
          next += 3;
        }
      }
      const Eigen::Vector3d zmp = Eigen::Vector3f(&balance_[6 * knot]).cast<double>();
      ASSERT_EQ(std::isnan(zmp.x()), load == 0) << knot;
      if (load == 0) continue;
      EXPECT_LT((zmp - sum / load).norm(), 2e-5) << knot;
    }
  }
}

TEST_F(ViewerHopTest, FlightHasNoBalance) {
  const nlohmann::json& flight = Phases()[1];
  for (int i = 6 * First(flight); i < 6 * (Last(flight) + 1); ++i) {
    EXPECT_TRUE(std::isnan(balance_[i]));
  }
}

TEST_F(ViewerPageTest, APlanWithoutSegmentsGivesAPage) {
  plan_.segments.clear();
  EXPECT_TRUE(EmbeddedData(Page())["segments"].empty());
}

TEST_F(ViewerPageTest, HoldsTheBarrierAndItsReason) {
  EXPECT_TRUE(EmbeddedData(Page())["no"].is_null());
  plan_.segments.clear();
  plan_.no = {"exhausted", kNasty, {}};
  EXPECT_TRUE(EmbeddedData(Page())["no"]["barrier"].is_null());
  plan_.no->barrier = {{1, 0.5}, 2, {"bar", kNasty}, {{"walk", 0.25, {{{0, 0}, {1, 0}, {1, 1}}}}}};
  const nlohmann::json data = EmbeddedData(Page());
  EXPECT_EQ(data["facts"][2], (std::vector<std::string>{"Answer", "no plan (exhausted)"}));
  EXPECT_EQ(data["no"]["explanation"], kNasty);
  const nlohmann::json& barrier = data["no"]["barrier"];
  EXPECT_EQ(barrier["closest"], (std::vector<double>{1, 0.5}));
  EXPECT_EQ(barrier["closed_by"], (std::vector<std::string>{"bar", kNasty}));
  EXPECT_EQ(barrier["reached"][0]["action"], "walk");
  EXPECT_EQ(barrier["reached"][0]["z"], 0.25);
  EXPECT_EQ(barrier["reached"][0]["outlines"][0].size(), 3u);
}

TEST_F(ViewerPageTest, HoldsTheNarrowestPlace) {
  plan_.segments.clear();
  plan_.no = {"time_limit", "why", {}};
  EXPECT_TRUE(EmbeddedData(Page())["no"]["passage"].is_null());
  plan_.no->passage = {.place = {2, 0.5},
                       .missing = 0.09,
                       .needs = {{"walk", actions::PassageDimension::kWidth, 0.5, 0.59}}};
  const nlohmann::json passage = EmbeddedData(Page())["no"]["passage"];
  EXPECT_EQ(passage["place"], (std::vector<double>{2, 0.5}));
  EXPECT_EQ(passage["needs"][0]["available"], 0.5);
  EXPECT_EQ(passage["needs"][0]["needed"], 0.59);
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
