#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "actions/plan/packed_phase.h"
#include "actions/plan/packed_writer.h"
#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "models/archive/zip_file.h"
#include "models/input/atomic_file.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "tests/actions/plan/random_plan.h"

namespace possibility::actions {
namespace {

using nlohmann::json;
using testing::RandomPlan;

std::vector<Phase> PhasesIn(const Plan& plan) {
  std::vector<Phase> phases;
  for (const Segment& segment : plan.segments) {
    phases.insert(phases.end(), segment.phases.begin(), segment.phases.end());
  }
  return phases;
}

void ExpectSameKnot(const Knot& a, const Knot& b) {
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v, b.v);
  EXPECT_EQ(a.a, b.a);
  EXPECT_EQ(a.tau, b.tau);
  EXPECT_EQ(a.forces, b.forces);
}

double Largest(const Eigen::MatrixXd& difference) {
  return difference.size() > 0 ? difference.cwiseAbs().maxCoeff() : 0;
}

double Turned(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) {
  return Eigen::Quaterniond(q0[0], q0[1], q0[2], q0[3])
      .angularDistance(Eigen::Quaterniond(q1[0], q1[1], q1[2], q1[3]));
}

class PackedPlan : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("possibility_packed_plan_test_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    std::mt19937 generator(3);
    plan_ = RandomPlan(&generator);
    plan_.robot_file = folder_ / "robots" / "robot.yaml";
    plan_.scenario_file = folder_ / "scenario.yaml";
    plan_.version = 2;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / "plan.zip"; }

  std::string Written(const Plan& plan) const {
    WritePackedPlan(plan, file());
    return models::ReadFileContents(file());
  }

  Plan ReadBack(const Plan& plan) const { return ParsePlan(Written(plan), file()); }

  /// The line with which the bytes are refused; empty if they are accepted.
  std::string RefusalOf(const std::string& bytes) const {
    try {
      ParsePlan(bytes, file());
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find(file().string()), 0u) << error.what();
      return error.what();
    }
    return "";
  }

  /// The archive with another document, or with another block.
  std::string Repacked(const std::function<void(json*)>& change,
                       const std::function<void(std::string*)>& change_block = {}) const {
    auto members = models::ReadZip(Written(plan_), file());
    json document = json::parse(members.at("plan.json"));
    if (change) change(&document);
    members["plan.json"] = document.dump();
    if (change_block) change_block(&members.at("motion/0"));
    models::ZipWriter archive(folder_ / "changed.zip");
    for (const auto& [name, content] : members) archive.Add(name, content);
    archive.Commit();
    return models::ReadFileContents(folder_ / "changed.zip");
  }

  void ExpectDocumentRefused(const std::function<void(json*)>& change, const std::string& words) {
    const std::string line = RefusalOf(Repacked(change));
    EXPECT_NE(line.find(words), std::string::npos) << "got: " << line;
  }

  std::filesystem::path folder_;
  Plan plan_;
};

TEST_F(PackedPlan, ReadsBackWithinItsSteps) {
  const Plan read = ReadBack(plan_);
  EXPECT_EQ(read.version, 2);
  EXPECT_EQ(read.force_bits, plan_.force_bits);
  EXPECT_EQ(read.joints, plan_.joints);
  EXPECT_EQ(read.seed, plan_.seed);
  EXPECT_EQ(read.robot_file, plan_.robot_file);
  ASSERT_TRUE(read.schedule);
  EXPECT_EQ(read.schedule->contacts, plan_.schedule->contacts);
  const std::vector<Phase> expected = PhasesIn(plan_);
  const std::vector<Phase> phases = PhasesIn(read);
  ASSERT_EQ(phases.size(), expected.size());
  for (std::size_t i = 0; i < phases.size(); ++i) {
    EXPECT_EQ(phases[i].contacts, expected[i].contacts);
    EXPECT_LE(Largest(phases[i].impulses - expected[i].impulses), 5.1e-8);
    ASSERT_EQ(phases[i].knots.size(), expected[i].knots.size());
    for (std::size_t k = 0; k < phases[i].knots.size(); ++k) {
      const Knot& knot = phases[i].knots[k];
      const Knot& original = expected[i].knots[k];
      EXPECT_LE(std::abs(knot.t - original.t), std::ldexp(0.51, -40));
      EXPECT_LE(Largest(knot.q.tail(6) - original.q.tail(6)), std::ldexp(0.51, -30));
      EXPECT_LE(Turned(knot.q, original.q), 1e-9);
      EXPECT_LE(Largest(knot.v - original.v), std::ldexp(0.51, -21));
      EXPECT_LE(Largest(knot.a - original.a), std::ldexp(0.51, -12));
      EXPECT_LE(Largest(knot.tau - original.tau), std::ldexp(0.51, -12));
      EXPECT_LE(Largest(knot.forces - original.forces), std::ldexp(0.51, -14));
    }
  }
}

TEST_F(PackedPlan, WrittenAgainItHasTheSameBytes) {
  EXPECT_TRUE(Written(plan_) == Written(plan_));
  Plan read = ReadBack(plan_);
  const std::string first = Written(read);
  for (int round = 0; round < 3; ++round) {
    read = ReadBack(read);
    EXPECT_TRUE(Written(read) == first) << "round " << round;
  }
}

TEST_F(PackedPlan, ARoundedPlanReadsBackToTheSameBits) {
  const Phase* before = nullptr;
  for (Segment& segment : plan_.segments) {
    for (Phase& phase : segment.phases) {
      RoundToPackedSteps(plan_.force_bits, before, &phase);
      before = &phase;
    }
  }
  const std::vector<Phase> expected = PhasesIn(plan_);
  const std::vector<Phase> phases = PhasesIn(ReadBack(plan_));
  for (std::size_t i = 0; i < phases.size(); ++i) {
    for (std::size_t k = 0; k < phases[i].knots.size(); ++k) {
      ExpectSameKnot(phases[i].knots[k], expected[i].knots[k]);
    }
  }
}

TEST_F(PackedPlan, PhasesThatFollowEachOtherShareTheirKnot) {
  std::vector<Phase>& phases = plan_.segments[0].phases;
  phases[1].knots[0].q = phases[0].knots[2].q;
  phases[1].knots[0].v = phases[0].knots[2].v;
  Plan read = ReadBack(plan_);
  EXPECT_EQ(read.segments[0].phases[1].knots[0].q, read.segments[0].phases[0].knots[2].q);
  EXPECT_EQ(read.segments[0].phases[1].knots[0].v, read.segments[0].phases[0].knots[2].v);

  // A jump stays one, however small it would be to the eye.
  phases[1].knots[0].v[4] += 1e-5;
  read = ReadBack(plan_);
  EXPECT_NEAR(read.segments[0].phases[1].knots[0].v[4] - read.segments[0].phases[0].knots[2].v[4],
              1e-5, 5e-7);
}

TEST_F(PackedPlan, ManyKnotsTakeSeveralBlocks) {
  std::mt19937 generator(5);
  for (int i = 0; i < 4; ++i) {
    Phase phase;
    double t = plan_.segments.back().phases.back().knots.back().t;
    for (int k = 0; k < 2100; ++k) {
      phase.knots.push_back(testing::RandomKnot(t + 0.01 * k, 3, 0, &generator));
    }
    plan_.segments.back().phases.push_back(phase);
  }
  const auto members = models::ReadZip(Written(plan_), file());
  EXPECT_EQ(json::parse(members.at("plan.json"))["blocks"], json::parse("[6, 2]"));
  const std::vector<Phase> phases = PhasesIn(ReadPlan(file()));
  ASSERT_EQ(phases.size(), 8u);
  const Knot& last = plan_.segments.back().phases.back().knots.back();
  EXPECT_LE(Largest(phases.back().knots.back().q.tail(6) - last.q.tail(6)), 1e-9);
  const Plan read = ReadBack(plan_);
  EXPECT_TRUE(Written(ReadBack(read)) == Written(read));
}

TEST_F(PackedPlan, TorquesMayBeLeftOut) {
  WritePackedPlan(plan_, file(), PackedTorques::kLeftOut);
  const std::string bytes = models::ReadFileContents(file());
  EXPECT_LT(bytes.size(), Written(plan_).size());
  const Plan read = ParsePlan(bytes, file());
  const std::vector<Phase> expected = PhasesIn(ReadBack(plan_));
  const std::vector<Phase> phases = PhasesIn(read);
  ASSERT_EQ(phases.size(), expected.size());
  for (std::size_t i = 0; i < phases.size(); ++i) {
    ASSERT_EQ(phases[i].knots.size(), expected[i].knots.size());
    for (std::size_t k = 0; k < phases[i].knots.size(); ++k) {
      Knot without = expected[i].knots[k];
      without.tau.resize(0);
      ExpectSameKnot(phases[i].knots[k], without);
    }
  }
  EXPECT_TRUE(Written(ReadBack(read)) == Written(read));
  EXPECT_EQ(ReadBack(read).segments[0].phases[0].knots[0].tau.size(), 0) << "stays without";
  EXPECT_THROW(WritePlan(read, folder_ / "plan.json"), std::invalid_argument);
}

TEST_F(PackedPlan, AFolderMeansItsPlanWhicheverItIs) {
  WritePackedPlan(plan_, file());
  EXPECT_EQ(PlanFileOf(folder_), file());
  EXPECT_EQ(ReadPlan(folder_).version, 2);
  WritePlan(plan_, folder_ / "plan.json");
  EXPECT_EQ(PlanFileOf(folder_), folder_ / "plan.json");
  EXPECT_EQ(ReadPlan(folder_).version, 1);
  // Told apart by content, not by name.
  std::filesystem::rename(file(), folder_ / "plan.json");
  EXPECT_EQ(ReadPlan(folder_).version, 2);
}

TEST_F(PackedPlan, TheNameChoosesTheFormat) {
  WritePlanAs(plan_, folder_ / "a.json");
  WritePlanAs(plan_, folder_ / "a.zip");
  EXPECT_EQ(ReadPlan(folder_ / "a.json").version, 1);
  EXPECT_EQ(ReadPlan(folder_ / "a.zip").version, 2);
  EXPECT_THROW(WritePlanAs(plan_, folder_ / "a.txt"), InputError);
}

TEST_F(PackedPlan, APlanWithoutMotionHasNoBlocks) {
  plan_.segments.clear();
  plan_.no = NoPlan{"exhausted", "why not", {}};
  const Plan read = ReadBack(plan_);
  ASSERT_TRUE(read.no);
  EXPECT_EQ(read.no->explanation, "why not");
  EXPECT_TRUE(read.segments.empty());
}

TEST_F(PackedPlan, SpoiltBytesAreRefusedInOneLine) {
  const std::string bytes = Written(plan_);
  for (std::size_t length = 0; length < bytes.size(); length += 3) {
    EXPECT_NE(RefusalOf(bytes.substr(0, length)), "") << length;
  }
  // What the CRCs cover: the members' bytes. 40 of the first one, 40 of the second.
  for (const std::string& name : {std::string("motion/0"), std::string("plan.json")}) {
    const std::size_t begin = bytes.find(name) + name.size();
    for (std::size_t i = 0; i < 40; ++i) {
      std::string spoilt = bytes;
      spoilt[begin + 3 * i] ^= 0x40;
      EXPECT_NE(RefusalOf(spoilt), "") << name << " " << i;
    }
  }
}

TEST_F(PackedPlan, SpoiltDocumentsAreRefused) {
  const auto phase = [](json* plan) -> json& { return (*plan)["segments"][0]["phases"][0]; };
  EXPECT_EQ(RefusalOf(Repacked({})), "");
  ExpectDocumentRefused([](json* plan) { (*plan)["format"] = "possibility-plan/3"; }, "format");
  ExpectDocumentRefused([](json* plan) { plan->erase("blocks"); }, "blocks");
  ExpectDocumentRefused([](json* plan) { (*plan)["series"] = json::array(); }, "series");
  ExpectDocumentRefused([](json* plan) { (*plan)["blocks"] = {3}; }, "expected the 4");
  ExpectDocumentRefused([](json* plan) { (*plan)["blocks"] = {3, 1}; }, "motion/0");
  ExpectDocumentRefused([](json* plan) { (*plan)["blocks"] = {0, 4}; }, "blocks[0]");
  ExpectDocumentRefused([](json* plan) { (*plan)["force_bits"] = 99; }, "force_bits");
  ExpectDocumentRefused([](json* plan) { (*plan)["torques"] = 0; }, "torques");
  ExpectDocumentRefused([](json* plan) { (*plan)["torques"] = false; }, "motion/0");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["knots"] = 1; }, "knots");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["knots"] = 4; }, "motion/0");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["knots"] = 90'000'000; }, "at most 2e+08");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["points"] = 7; }, "motion/0");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["bits"] = {12, 21}; }, "bits");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["bits"][0] = -20; }, "up to 1e+06");
  ExpectDocumentRefused([&](json* plan) { phase(plan).erase("start"); }, "start");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["start"]["q"][0] = 3; }, "unit quaternion");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["start"]["v"].erase(0); }, "expected 9");
  ExpectDocumentRefused([&](json* plan) { phase(plan)["t"] = json::array({0, 1}); }, "\"t\"");
  ExpectDocumentRefused([&](json* plan) { (*plan)["segments"][0]["duration_s"] = 9; }, "9 s");
}

TEST_F(PackedPlan, SpoiltBlocksAreRefused) {
  const auto refusal = [&](const std::function<void(std::string*)>& change) {
    return RefusalOf(Repacked({}, change));
  };
  EXPECT_EQ(refusal([](std::string*) {}), "");
  EXPECT_NE(refusal([](std::string* block) { block->pop_back(); }).find("truncated"),
            std::string::npos);
  EXPECT_NE(refusal([](std::string* block) { *block += '\0'; }).find("1 bytes more"),
            std::string::npos);
  EXPECT_NE(refusal([](std::string* block) { (*block)[0] = 9; }).find("expected at most 8"),
            std::string::npos);
  EXPECT_NE(refusal([](std::string* block) { block->clear(); }).find("truncated"),
            std::string::npos);
  // The first number is the first interval of time, 0.1 s; -1 of its steps is no interval.
  EXPECT_NE(refusal([](std::string* block) {
              const int planes = (*block)[0];
              for (int plane = 0; plane < planes; ++plane) (*block)[1 + 8 * plane] = plane == 0;
            }).find("the time of the knot before"),
            std::string::npos);
}

TEST_F(PackedPlan, WhatCannotBeHeldIsNotWritten) {
  const auto expect_refused = [&](const std::function<void(Phase*)>& change) {
    Plan plan = plan_;
    change(&plan.segments[1].phases[0]);
    EXPECT_THROW(WritePackedPlan(plan, file()), std::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(file()));
  };
  expect_refused([](Phase* phase) { phase->knots[1].q[8] = NAN; });
  expect_refused([](Phase* phase) { phase->knots[1].forces(2, 0) = INFINITY; });
  expect_refused([](Phase* phase) { phase->knots[1].a[2] = 1e16; });
  expect_refused([](Phase* phase) { phase->knots.resize(1); });
  expect_refused([](Phase* phase) { phase->knots.clear(); });
  expect_refused([](Phase* phase) { std::swap(phase->knots[0].t, phase->knots[1].t); });
  expect_refused([](Phase* phase) { phase->knots[1].tau.conservativeResize(2); });
  expect_refused([](Phase* phase) { phase->knots[1].tau.resize(0); });
  EXPECT_THROW(WritePackedPlan(plan_, folder_ / "missing" / "plan.zip"), InputError);
}

}  // namespace
}  // namespace possibility::actions
