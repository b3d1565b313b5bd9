// Any file is either used or refused by an InputError of one line. Meant to run under the
// sanitizers (docs/development.md).

#include <gtest/gtest.h>

#include <ostream>

#include "tests/fuzz/case_runner.h"
#include "tests/fuzz/onboarding_subjects.h"
#include "tests/fuzz/subjects.h"
#include "tests/models/temporary_folder.h"

namespace possibility::fuzz {
namespace {

using Make = Subject (*)(const std::filesystem::path&);

struct ReadingKind {
  const char* name;
  Make make;
};

void PrintTo(const ReadingKind& kind, std::ostream* out) { *out << kind.name; }

const ReadingKind kReadingKinds[] = {{"Scenario", &ScenarioSubject},
                                     {"Robot", &RobotSubject},
                                     {"Urdf", &UrdfSubject},
                                     {"Plan", &PlanSubject},
                                     {"PackedPlan", &PackedPlanSubject},
                                     {"Solution", &SolutionSubject},
                                     {"Library", &LibrarySubject},
                                     {"Mesh", &MeshSubject},
                                     {"HeightMap", &HeightMapSubject},
                                     {"Trajectory", &TrajectorySubject},
                                     {"InitUrdf", &InitUrdfSubject},
                                     {"InitSrdf", &InitSrdfSubject},
                                     {"InitMesh", &InitMeshSubject}};

class ReadingFuzz : public ::testing::TestWithParam<ReadingKind> {};

TEST_P(ReadingFuzz, SpoiltFilesAreUsedOrRefused) {
  const models::TemporaryFolder folder;
  RunCases(GetParam().make(folder.path()), 0, 150);
}

class ReadingFuzzLong : public ReadingFuzz {};

TEST_P(ReadingFuzzLong, SpoiltFilesAreUsedOrRefused) {
  const models::TemporaryFolder folder;
  RunCases(GetParam().make(folder.path()), 1000, 10000);
}

std::string NameOfReading(const ::testing::TestParamInfo<ReadingKind>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Kinds, ReadingFuzz, ::testing::ValuesIn(kReadingKinds), &NameOfReading);
INSTANTIATE_TEST_SUITE_P(Kinds, ReadingFuzzLong, ::testing::ValuesIn(kReadingKinds),
                         &NameOfReading);

}  // namespace
}  // namespace possibility::fuzz
