#include "experiments/imports/contact_phases.h"

#include <gtest/gtest.h>

#include <string>

namespace possibility::experiments {
namespace {

/// One sample per word "01@2.5": flags of the points, time.
ImportedTrajectory Stepping(const std::vector<std::string>& words) {
  ImportedTrajectory trajectory;
  for (const std::string& word : words) {
    ImportedSample sample;
    const std::size_t at = word.find('@');
    for (const char flag : word.substr(0, at)) sample.bears.push_back(flag == '1');
    sample.t = std::stod(word.substr(at + 1));
    trajectory.samples.push_back(sample);
  }
  return trajectory;
}

/// "01:0,1,2 11:2,3": flags and samples of every phase.
std::string Text(const std::vector<ImportedPhase>& phases) {
  std::string text;
  for (const ImportedPhase& phase : phases) {
    if (!text.empty()) text += " ";
    for (const bool bears : phase.bears) text += bears ? '1' : '0';
    for (std::size_t i = 0; i < phase.samples.size(); ++i) {
      text += (i == 0 ? ":" : ",") + std::to_string(phase.samples[i]);
    }
  }
  return text;
}

TEST(ContactPhasesTest, TwoSamplesAtOneTimeEndAndBegin) {
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"10@0", "10@1", "01@1", "01@2"}))), "10:0,1 01:2,3");
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"10@0", "10@1", "10@1", "10@2"}))), "10:0,1 10:2,3");
}

TEST(ContactPhasesTest, OnlyWhatBearsAtBothSamplesBearsBetween) {
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"10@0", "10@1", "11@2", "11@3"}))), "10:0,1,2 11:2,3");
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"11@0", "11@1", "01@2", "01@3"}))), "11:0,1 01:1,2,3");
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"110@0", "110@1", "011@2", "011@3"}))),
            "110:0,1 010:1,2 011:2,3");
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"10@0", "10@1", "01@2", "01@3"}))), "10:0,1,2 01:2,3");
}

TEST(ContactPhasesTest, FlightLastsFromTheLastContactToTheNext) {
  EXPECT_EQ(Text(CutIntoPhases(Stepping({"1@0", "1@1", "0@2", "0@3", "1@4", "1@5"}))),
            "1:0,1 0:1,2,3,4 1:4,5");
}

TEST(ContactPhasesTest, ASegmentIsAPhaseOfItsOwn) {
  ImportedTrajectory trajectory = Stepping({"1@0", "1@1", "1@2"});
  trajectory.samples[2].segment = 1;
  const std::vector<ImportedPhase> phases = CutIntoPhases(trajectory);
  EXPECT_EQ(Text(phases), "1:0,1 1:1,2");
  EXPECT_EQ(phases[1].segment, 1);
}

}  // namespace
}  // namespace possibility::experiments
