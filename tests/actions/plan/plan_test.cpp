#include "actions/plan/plan.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_rounding.h"
#include "actions/plan/plan_writer.h"
#include "models/input/input_error.h"
#include "tests/actions/plan/random_plan.h"

namespace possibility::actions {
namespace {

using nlohmann::json;
using testing::RandomPlan;

/// Expects agreement to half of the last digit.
void ExpectNear(const Eigen::MatrixXd& read, const Eigen::MatrixXd& written, double digit) {
  ASSERT_EQ(read.size(), written.size());
  if (read.size() == 0) return;
  EXPECT_LE((read - written).cwiseAbs().maxCoeff(), 0.51 * digit);
}

void ExpectSameSchedule(const models::ContactSchedule& schedule,
                        const models::ContactSchedule& expected) {
  EXPECT_EQ(schedule.contacts, expected.contacts);
  ASSERT_EQ(schedule.intervals.size(), expected.intervals.size());
  for (std::size_t k = 0; k < expected.intervals.size(); ++k) {
    EXPECT_EQ(schedule.intervals[k].duration, expected.intervals[k].duration);
    ASSERT_EQ(schedule.intervals[k].bearing.size(), expected.intervals[k].bearing.size());
    for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
      const auto& pose = schedule.intervals[k].bearing[i];
      const auto& expected_pose = expected.intervals[k].bearing[i];
      ASSERT_EQ(pose.has_value(), expected_pose.has_value());
      if (pose) ExpectNear(pose->matrix(), expected_pose->matrix(), 1e-9);
    }
  }
}

class PlanFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("possibility_plan_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::mt19937 generator(11);
    plan_ = RandomPlan(&generator);
    plan_.robot_file = folder_ / "robots" / "robot.yaml";
    plan_.scenario_file = folder_ / ".." / "scenario.yaml";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / "plan.json"; }

  std::string Written(const Plan& plan) const {
    WritePlan(plan, file());
    std::ifstream stream(file(), std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  /// The message of the InputError that reading `text` throws; empty if the text is accepted.
  std::string Refusal(const std::string& text) const {
    try {
      ParsePlan(text, file());
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  /// Expects that the plan changed by `change` is refused with one line that holds `words`.
  void ExpectRefused(const std::function<void(json*)>& change, const std::string& words) const {
    json document = json::parse(Written(plan_));
    change(&document);
    const std::string message = Refusal(document.dump());
    EXPECT_NE(message.find(words), std::string::npos) << "got: " << message;
    EXPECT_NE(message.find(file().string()), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  std::filesystem::path folder_;
  Plan plan_;
};

TEST_F(PlanFile, ReadsBackAsWritten) {
  WritePlan(plan_, file());
  const Plan read = ReadPlan(folder_);
  EXPECT_EQ(read.robot_file, std::filesystem::weakly_canonical(plan_.robot_file));
  EXPECT_EQ(read.scenario_file, std::filesystem::weakly_canonical(plan_.scenario_file));
  EXPECT_EQ(read.robot_hash, plan_.robot_hash);
  EXPECT_EQ(read.scenario_hash, plan_.scenario_hash);
  EXPECT_EQ(read.seed, plan_.seed);
  EXPECT_EQ(read.goal, plan_.goal);
  EXPECT_EQ(read.statistics, plan_.statistics);
  EXPECT_EQ(read.joints, plan_.joints);
  EXPECT_EQ(read.timings.motion_s, plan_.timings.motion_s);
  EXPECT_EQ(read.duration(), plan_.duration());
  ASSERT_EQ(read.segments.size(), plan_.segments.size());
  for (std::size_t s = 0; s < plan_.segments.size(); ++s) {
    EXPECT_EQ(read.segments[s].action, plan_.segments[s].action);
    ASSERT_EQ(read.segments[s].phases.size(), plan_.segments[s].phases.size());
    for (std::size_t p = 0; p < plan_.segments[s].phases.size(); ++p) {
      const Phase& expected = plan_.segments[s].phases[p];
      const Phase& phase = read.segments[s].phases[p];
      EXPECT_EQ(phase.contacts, expected.contacts);
      ASSERT_EQ(phase.impulses.cols(), expected.impulses.cols());
      ExpectNear(phase.impulses, expected.impulses, 1e-7);
      ASSERT_EQ(phase.knots.size(), expected.knots.size());
      for (std::size_t k = 0; k < expected.knots.size(); ++k) {
        EXPECT_EQ(phase.knots[k].t, expected.knots[k].t);
        ExpectNear(phase.knots[k].q, expected.knots[k].q, 1e-10);
        ExpectNear(phase.knots[k].v, expected.knots[k].v, 1e-9);
        ExpectNear(phase.knots[k].a, expected.knots[k].a, 1e-8);
        ExpectNear(phase.knots[k].tau, expected.knots[k].tau, 1e-7);
        ExpectNear(phase.knots[k].forces, expected.knots[k].forces, 1e-7);
      }
    }
  }
  ExpectSameSchedule(*read.schedule, *plan_.schedule);
  ASSERT_EQ(read.explored.vertices.size(), 2u);
  EXPECT_EQ(read.explored.vertices[1].position, plan_.explored.vertices[1].position);
  EXPECT_EQ(read.explored.vertices[1].yaw, plan_.explored.vertices[1].yaw);
  ASSERT_EQ(read.explored.edges.size(), 1u);
  EXPECT_EQ(read.explored.edges[0].action, "walk");
}

TEST_F(PlanFile, ReadsBackToTheSameBitsIfItWasRounded) {
  std::mt19937 generator(12);
  for (int trial = 0; trial < 100; ++trial) {
    Plan plan = RandomPlan(&generator);
    const double large = std::pow(10, trial % 8);
    for (Phase& phase : plan.segments[0].phases) {
      for (Knot& knot : phase.knots) knot.tau *= large;
    }
    RoundToPlanDigits(&plan);
    WritePlan(plan, file());
    const Plan read = ReadPlan(folder_);
    for (std::size_t s = 0; s < plan.segments.size(); ++s) {
      for (std::size_t p = 0; p < plan.segments[s].phases.size(); ++p) {
        const Phase& expected = plan.segments[s].phases[p];
        const Phase& phase = read.segments[s].phases[p];
        EXPECT_EQ(phase.impulses, expected.impulses);
        for (std::size_t k = 0; k < expected.knots.size(); ++k) {
          EXPECT_EQ(phase.knots[k].q, expected.knots[k].q);
          EXPECT_EQ(phase.knots[k].v, expected.knots[k].v);
          EXPECT_EQ(phase.knots[k].a, expected.knots[k].a);
          EXPECT_EQ(phase.knots[k].tau, expected.knots[k].tau);
          EXPECT_EQ(phase.knots[k].forces, expected.knots[k].forces);
        }
      }
    }
  }
}

/// Motion of other programs may be malformed. The verifier says so, not the rounding.
TEST_F(PlanFile, RoundingLeavesNumbersThatAreNotFinite) {
  Knot& knot = plan_.segments[0].phases[0].knots[1];
  knot.q[8] = std::nan("");
  knot.tau[0] = INFINITY;
  knot.v[0] = 0.1234567890123;
  RoundToPlanDigits(&plan_);
  EXPECT_TRUE(std::isnan(knot.q[8]));
  EXPECT_EQ(knot.tau[0], INFINITY);
  EXPECT_EQ(knot.v[0], 0.123456789);
}

TEST_F(PlanFile, WritesTheSameBytesEachTimeAndAfterReading) {
  const std::string first = Written(plan_);
  EXPECT_EQ(Written(plan_), first);
  EXPECT_EQ(Written(ReadPlan(file())), first);
}

/// The rounding error of a place must not depend on where the place is.
TEST_F(PlanFile, PlacesFarFromTheOriginKeepTheirDecimals) {
  for (const double x : {0.0, -3.25, 9.87654321, 1e4 / 3, -1e5 / 7, 1e5 / 3}) {
    Knot& knot = plan_.segments[0].phases[0].knots[0];
    knot.q.segment<3>(4) << x, 2 * x, x / 3;
    const std::string text = Written(plan_);
    const Eigen::VectorXd q = ParsePlan(text, file()).segments[0].phases[0].knots[0].q;
    EXPECT_LT((q - knot.q).lpNorm<Eigen::Infinity>(), 6e-11) << x;
    EXPECT_EQ(Written(ParsePlan(text, file())), text);
  }
}

TEST_F(PlanFile, NamesFilesRelativeToItsFolder) {
  const json document = json::parse(Written(plan_));
  EXPECT_EQ(document["robot"]["file"], "robots/robot.yaml");
  EXPECT_EQ(document["scenario"]["file"], "../scenario.yaml");
}

TEST_F(PlanFile, RealTimeRatioIsMotionTimeOverPlanningTime) {
  const json timings = json::parse(Written(plan_))["timings"];
  EXPECT_NEAR(timings["plan_duration_s"].get<double>(), 0.8, 1e-12);
  EXPECT_NEAR(timings["real_time_ratio"].get<double>(), 0.8 / 1.6, 1e-12);
}

TEST_F(PlanFile, MayHoldNoMotion) {
  Plan plan;
  const Plan read = ParsePlan(Written(plan), file());
  EXPECT_TRUE(read.segments.empty());
  EXPECT_EQ(read.duration(), 0);
}

NoPlan ClosedRoom() {
  Barrier barrier;
  barrier.closest = {4.9, 1.0 / 3};
  barrier.distance = 4.1;
  barrier.closed_by = {"wall", "no ground"};
  barrier.reached = {{"walk", 0.1, {{{0, 0}, {4.9, 0}, {4.9, 2}, {0, 2}}}}, {"", 0, {}}};
  return {"proven_infeasible", "no route exists: \"wall\"", barrier};
}

TEST_F(PlanFile, ANoReadsBackAsWritten) {
  plan_.segments.clear();
  plan_.no = ClosedRoom();
  const Plan read = ParsePlan(Written(plan_), file());
  ASSERT_TRUE(read.no.has_value());
  EXPECT_EQ(read.no->status, plan_.no->status);
  EXPECT_EQ(read.no->explanation, plan_.no->explanation);
  ASSERT_TRUE(read.no->barrier.has_value());
  EXPECT_TRUE(read.no->barrier->closest.isApprox(plan_.no->barrier->closest, 1e-11));
  EXPECT_EQ(read.no->barrier->distance, 4.1);
  EXPECT_EQ(read.no->barrier->closed_by, plan_.no->barrier->closed_by);
  ASSERT_EQ(read.no->barrier->reached.size(), 2u);
  EXPECT_EQ(read.no->barrier->reached[0].action, "walk");
  EXPECT_EQ(read.no->barrier->reached[0].z, 0.1);
  EXPECT_EQ(read.no->barrier->reached[0].outlines, plan_.no->barrier->reached[0].outlines);
  EXPECT_TRUE(read.no->barrier->reached[1].outlines.empty());
  const std::string first = Written(read);
  EXPECT_EQ(Written(ReadPlan(file())), first);

  plan_.no->barrier.reset();
  EXPECT_FALSE(ParsePlan(Written(plan_), file()).no->barrier.has_value());
  plan_.no.reset();
  EXPECT_EQ(Written(plan_).find("\"no\""), std::string::npos);
}

TEST_F(PlanFile, ANarrowPassageReadsBackAsWritten) {
  plan_.segments.clear();
  plan_.no = ClosedRoom();
  for (const bool has_barrier : {true, false}) {
    if (!has_barrier) plan_.no->barrier.reset();
    NarrowPassage& passage = plan_.no->passage.emplace();
    passage.place = {4.5, -2};
    passage.missing = 0.125;
    passage.between = {"left", "right"};
    passage.needs = {{"walk", PassageDimension::kWidth, 0.75, 0.875},
                     {"crawl", PassageDimension::kHeight, 0.5, 0.625},
                     {"jump", PassageDimension::kGap, 1, 0.5}};
    const std::optional<NoPlan> read = ParsePlan(Written(plan_), file()).no;
    ASSERT_TRUE(read && read->passage);
    EXPECT_EQ(read->barrier.has_value(), has_barrier);
    EXPECT_EQ(read->passage->place, passage.place);
    EXPECT_EQ(read->passage->missing, 0.125);
    EXPECT_EQ(read->passage->between, passage.between);
    ASSERT_EQ(read->passage->needs.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(read->passage->needs[i].action, passage.needs[i].action);
      EXPECT_EQ(read->passage->needs[i].dimension, passage.needs[i].dimension);
      EXPECT_EQ(read->passage->needs[i].available, passage.needs[i].available);
      EXPECT_EQ(read->passage->needs[i].needed, passage.needs[i].needed);
    }
    ExpectRefused([](json* d) { (*d)["no"]["passage"].erase("missing"); }, "no.passage");
    ExpectRefused([](json* d) { (*d)["no"]["passage"]["needs"][0]["dimension"] = "depth"; },
                  "no.passage.needs[0].dimension");
  }
}

TEST_F(PlanFile, RefusesAMalformedNo) {
  ExpectRefused(
      [](json* d) {
        (*d)["no"] = {{"status", "exhausted"}, {"explanation", ""}};
      },
      "no: expected none where there are segments");
  plan_.segments.clear();
  plan_.no = ClosedRoom();
  ExpectRefused([](json* d) { (*d)["no"] = 1; }, "no");
  ExpectRefused([](json* d) { (*d)["no"].erase("status"); }, "no");
  ExpectRefused([](json* d) { (*d)["no"]["reason"] = ""; }, "no");
  ExpectRefused([](json* d) { (*d)["no"]["barrier"] = nullptr; }, "no.barrier");
  ExpectRefused(
      [](json* d) {
        (*d)["no"]["barrier"]["closest"] = {1, 2, 3};
      },
      "no.barrier.closest: expected 2 numbers");
  ExpectRefused([](json* d) { (*d)["no"]["barrier"]["closed_by"] = {1}; },
                "no.barrier.closed_by[0]");
  ExpectRefused([](json* d) { (*d)["no"]["barrier"]["reached"][0].erase("z"); },
                "no.barrier.reached[0]");
  ExpectRefused(
      [](json* d) {
        (*d)["no"]["barrier"]["reached"][0]["outlines"][0] = {{1, 2}};
      },
      "no.barrier.reached[0].outlines[0]: expected at least 3 corners");
}

TEST_F(PlanFile, LeavesNoOtherFileInTheFolder) {
  WritePlan(plan_, file());
  const auto files = std::filesystem::directory_iterator(folder_);
  EXPECT_EQ(std::distance(begin(files), end(files)), 1);
}

TEST_F(PlanFile, RefusesUnwritablePathsAndNonFiniteNumbers) {
  EXPECT_THROW(WritePlan(plan_, folder_ / "missing" / "plan.json"), InputError);
  std::filesystem::create_directories(folder_ / "taken" / "plan.json" / "x");
  EXPECT_THROW(WritePlan(plan_, folder_ / "taken" / "plan.json"), InputError);
  const auto left = std::filesystem::directory_iterator(folder_ / "taken");
  EXPECT_EQ(std::distance(begin(left), end(left)), 1);
  plan_.segments[0].phases[0].knots[1].v[2] = std::nan("");
  EXPECT_THROW(WritePlan(plan_, file()), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(file()));
}

TEST_F(PlanFile, RefusesNamesThatAreNotUtf8) {
  plan_.segments[0].action = "\xff\xfe";
  EXPECT_THROW(WritePlan(plan_, file()), InputError);
}

TEST_F(PlanFile, RefusesAMissingFile) {
  EXPECT_THROW(ReadPlan(folder_), InputError);
  EXPECT_THROW(ReadPlan(folder_ / "nothing.json"), InputError);
}

TEST_F(PlanFile, RefusesEveryTruncation) {
  const std::string text = Written(plan_);
  for (std::size_t size = 0; size + 2 < text.size(); size += 97) {
    const std::string message = Refusal(text.substr(0, size));
    EXPECT_NE(message.find("not valid JSON"), std::string::npos) << size << ": " << message;
  }
}

TEST_F(PlanFile, NamesTheKeyThatIsWrong) {
  ExpectRefused([](json* d) { (*d)["format"] = "possibility-plan/2"; }, "format: \"possibility-");
  ExpectRefused([](json* d) { d->erase("format"); }, "no \"format\"");
  ExpectRefused([](json* d) { *d = json::array(); }, "no \"format\"");
  ExpectRefused([](json* d) { d->erase("seed"); }, "missing key \"seed\"");
  ExpectRefused([](json* d) { (*d)["sead"] = 1; }, "unknown key \"sead\"");
  ExpectRefused([](json* d) { (*d)["seed"] = -1; }, "seed: expected an integer");
  ExpectRefused([](json* d) { (*d)["goal"] = 0.5; }, "goal: expected an integer");
  ExpectRefused([](json* d) { (*d)["goal"] = 1e10; }, "goal: expected an integer");
  ExpectRefused([](json* d) { (*d)["robot"]["file"] = 3; }, "robot.file: expected a string");
  ExpectRefused([](json* d) { (*d)["robot"]["file"] = std::string("a\0b", 3); },
                "robot.file: expected a path");
  ExpectRefused([](json* d) { (*d)["timings"]["graph_s"] = -1; }, "timings.graph_s: -1 s");
  ExpectRefused([](json* d) { (*d)["timings"]["plan_duration_s"] = 7; },
                "timings.plan_duration_s: 7 s, expected 0.8 s");
  ExpectRefused([](json* d) { (*d)["statistics"]["vertices"] = "many"; },
                "statistics.vertices: expected an integer");
  ExpectRefused([](json* d) { (*d)["joints"].push_back("LAR"); },
                "segments[0].phases[0].q[0]: expected 11 numbers, got 10");
  ExpectRefused([](json* d) { (*d)["segments"][1]["phases"] = json::array(); },
                "segments[1].phases: expected at least one phase");
  ExpectRefused([](json* d) { (*d)["segments"][1]["start_s"] = 0; },
                "segments[1].start_s: 0 s, expected 0.4 s");
  ExpectRefused([](json* d) { (*d)["explored"]["edges"][0][1] = 2; },
                "explored.edges[0][1]: expected an integer from 0 to 1");
}

TEST_F(PlanFile, NamesTheKnotThatIsWrong) {
  const auto phase = [](json* d) -> json& { return (*d)["segments"][1]["phases"][0]; };
  const std::string at = "segments[1].phases[0].";
  ExpectRefused([&](json* d) { phase(d)["q"][1].push_back(0); }, at + "q[1]: expected 10 numbers");
  ExpectRefused([&](json* d) { phase(d)["v"][2][4] = nullptr; }, at + "v[2][4]: expected a number");
  ExpectRefused([&](json* d) { phase(d)["a"].erase(2); }, at + "a: expected 3 knots as in t");
  ExpectRefused([&](json* d) { phase(d)["tau"][0] = "x"; }, at + "tau[0]: expected an array");
  ExpectRefused([&](json* d) { phase(d)["forces"][1].erase(0); },
                at + "forces[1]: expected 3 numbers per contact point, got 23");
  ExpectRefused(
      [&](json* d) {
        phase(d)["forces"][1] = json::array({1, 2, 3});
      },
      at + "forces[1]: expected 24 numbers as in the first knot, got 3");
  ExpectRefused([&](json* d) { phase(d)["t"][1] = phase(d)["t"][0]; }, at + "t[1]: 0.4 s");
  ExpectRefused([&](json* d) { phase(d)["q"][0][0] = 5; }, at + "q[0]: expected a unit quaternion");
  ExpectRefused([&](json* d) { phase(d)["contacts"][0] = 7; }, at + "contacts[0]: expected a str");
  ExpectRefused([&](json* d) { phase(d).erase("contacts"); }, "missing key \"contacts\"");
}

TEST_F(PlanFile, NamesThePartOfTheScheduleThatIsWrong) {
  const auto interval = [](json* d) -> json& { return (*d)["schedule"]["intervals"][1]; };
  const std::string at = "schedule.intervals[1].";
  ExpectRefused([&](json* d) { interval(d)["bearing"].push_back(nullptr); },
                at + "bearing: expected 3 entries, one per contact, got 4");
  ExpectRefused([&](json* d) { interval(d)["bearing"][0].erase(0); },
                at + "bearing[0]: expected [x, y, z, qw, qx, qy, qz] or null");
  ExpectRefused([&](json* d) { interval(d)["bearing"][0][3] = 7; },
                at + "bearing[0]: expected a unit quaternion");
  ExpectRefused([&](json* d) { interval(d)["duration_s"] = 0; },
                "schedule: contact schedule: interval 1 lasts 0 s, expected more than 0");
  ExpectRefused([&](json* d) { interval(d)["bearing"][0][1] = 7; },
                "schedule: contact schedule: left_sole moves at the start of interval 1");
  ExpectRefused([](json* d) { (*d)["schedule"]["contacts"][1] = "peg[1,0]"; },
                "schedule.contacts[1]: contact \"peg[1,0]\"");
  ExpectRefused([](json* d) { (*d)["schedule"]["contacts"][1] = "left_sole"; },
                "schedule: contact schedule: left_sole is listed twice");
  ExpectRefused([](json* d) { (*d)["schedule"].erase("intervals"); },
                "schedule: missing key \"intervals\"");
}

TEST_F(PlanFile, MayHoldNoSchedule) {
  plan_.schedule.reset();
  EXPECT_FALSE(ParsePlan(Written(plan_), file()).schedule);
}

TEST_F(PlanFile, NamesTheContactThatIsWrong) {
  const auto contacts = [](json* d) -> json& {
    return (*d)["segments"][1]["phases"][1]["contacts"];
  };
  const std::string at = "segments[1].phases[1].contacts";
  for (const char* name : {"", "]", "[0]", "sole[]", "sole[,]", "sole[0,]", "sole[,0]", "sole[3,0]",
                           "sole[0,0]", "sole[-1]", "sole[+1]", "sole[00]", "sole[0, 3]",
                           "sole[0;3]", "sole[x]", "sole[99999999999]", "sole0]", "so\nle[x]"}) {
    ExpectRefused([&](json* d) { contacts(d)[0] = name; }, at + "[0]: contact \"");
  }
  ExpectRefused([&](json* d) { contacts(d)[1] = "left_sole"; },
                at + "[1]: patch \"left_sole\" stands twice in a phase");
  ExpectRefused([&](json* d) { contacts(d)[1] = "left_sole[1,2]"; },
                at + "[1]: patch \"left_sole\" stands twice in a phase");
}

TEST_F(PlanFile, NamesTheImpulseThatIsWrong) {
  const auto phase = [](json* d) -> json& { return (*d)["segments"][1]["phases"][1]; };
  const std::string at = "segments[1].phases[1].";
  ExpectRefused([&](json* d) { phase(d)["impulses"].push_back(0); },
                at + "impulses: expected 9 numbers, got 10");
  ExpectRefused([&](json* d) { phase(d)["impulses"] = json::array(); },
                at + "impulses: expected 9 numbers, got 0");
  ExpectRefused([&](json* d) { phase(d)["impulses"] = nullptr; },
                at + "impulses: expected an array");
  ExpectRefused([&](json* d) { phase(d)["impulses"][4] = "x"; },
                at + "impulses[4]: expected a number");
  ExpectRefused([&](json* d) { (*d)["segments"][0]["phases"][1]["impulses"] = json::array(); },
                "segments[0].phases[1].impulses: expected none where nothing touches the ground");
  ExpectRefused([&](json* d) { phase(d)["impulse"] = json::array(); }, "impulse");
}

TEST_F(PlanFile, WritesImpulsesOnlyForPhasesThatHaveThem) {
  const json document = json::parse(Written(plan_));
  EXPECT_FALSE(document["segments"][0]["phases"][0].contains("impulses"));
  EXPECT_TRUE(document["segments"][1]["phases"][1].contains("impulses"));
}

TEST_F(PlanFile, RefusesMalformedJson) {
  EXPECT_NE(Refusal("{\"format\": \"a\", \"format\": \"b\"}").find("twice"), std::string::npos);
  EXPECT_NE(Refusal("").find("not valid JSON at byte"), std::string::npos);
  EXPECT_NE(Refusal("{\"format\": 1e999}").find("out of range"), std::string::npos);
  EXPECT_NE(Refusal("{\"format\": \"\xff\"}").find("not valid JSON"), std::string::npos);
  EXPECT_NE(Refusal(std::string(1000000, '[')).find("not valid JSON"), std::string::npos);
  EXPECT_NE(Refusal(std::string(100000, '[') + std::string(100000, ']')).find("no \"format\""),
            std::string::npos);
}

TEST_F(PlanFile, NeverCrashesOnMutatedText) {
  const std::string text = Written(plan_);
  const std::string alphabet = "{}[],:\"0123456789-.eE\\ntrufalse \xc3\xff";
  std::mt19937 generator(12);
  std::uniform_int_distribution<std::size_t> place(0, text.size() - 1);
  std::uniform_int_distribution<std::size_t> letter(0, alphabet.size() - 1);
  std::uniform_int_distribution<int> kind(0, 2);
  int refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string mutated = text;
    for (int change = 0; change <= trial % 3; ++change) {
      const std::size_t at = std::min(place(generator), mutated.size() - 1);
      const std::size_t length = std::min<std::size_t>(place(generator) % 40, mutated.size() - at);
      switch (kind(generator)) {
        case 0:
          mutated[at] = alphabet[letter(generator)];
          break;
        case 1:
          mutated.erase(at, length);
          break;
        default:
          mutated.insert(place(generator) % mutated.size(), mutated.substr(at, length));
      }
    }
    const std::string message =
        Refusal(mutated);  // anything other than an InputError fails the test
    refused += message.empty() ? 0 : 1;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_GT(refused, 1000);
}

/// Values of the document, each replaced by one of another kind.
TEST_F(PlanFile, NeverCrashesOnMutatedValues) {
  const json valid = json::parse(Written(plan_));
  const json flat = valid.flatten();
  const std::vector<json> replacements = {nullptr, -1,  1e300,         "text",
                                          true,    0.5, json::array(), json::object()};
  std::mt19937 generator(13);
  for (const auto& [pointer, value] : flat.items()) {
    if (generator() % 3 != 0) continue;
    json document = valid;
    for (json::json_pointer at(pointer); !at.empty(); at = at.parent_pointer()) {
      document[at] = replacements[generator() % replacements.size()];
      const std::string message = Refusal(document.dump());
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(HasFlightOrImpactTest, IsTrueWithoutContactsOrWithImpulses) {
  Segment segment{"walk", {Phase{{"left_sole"}, {}}}};
  EXPECT_FALSE(HasFlightOrImpact(segment));
  segment.phases[0].impulses.resize(3, 4);
  EXPECT_TRUE(HasFlightOrImpact(segment));
  EXPECT_TRUE(HasFlightOrImpact({"jump", {Phase{{"left_sole"}, {}}, Phase{}}}));
}

}  // namespace
}  // namespace possibility::actions
