// Any file is either used or refused by an InputError of one line. Meant to run under the
// sanitizers (docs/development.md).

#include <gtest/gtest.h>

#include <ostream>

#include "tests/fuzz/case_runner.h"
#include "tests/fuzz/subjects.h"
#include "tests/models/temporary_folder.h"

namespace possibility::fuzz {
namespace {

using Make = Subject (*)(const std::filesystem::path&);

struct Kind {
  const char* name;
  Make make;
};

void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }

const Kind kKinds[] = {{"Scenario", &ScenarioSubject}, {"Robot", &RobotSubject},
                       {"Urdf", &UrdfSubject},         {"Plan", &PlanSubject},
                       {"Solution", &SolutionSubject}, {"Library", &LibrarySubject}};

class ReadingFuzz : public testing::TestWithParam<Kind> {};

TEST_P(ReadingFuzz, SpoiltFilesAreUsedOrRefused) {
  const models::TemporaryFolder folder;
  RunCases(GetParam().make(folder.path()), 0, 300);
}

class ReadingFuzzLong : public ReadingFuzz {};

TEST_P(ReadingFuzzLong, SpoiltFilesAreUsedOrRefused) {
  const models::TemporaryFolder folder;
  RunCases(GetParam().make(folder.path()), 1000, 10000);
}

std::string NameOf(const testing::TestParamInfo<Kind>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Kinds, ReadingFuzz, testing::ValuesIn(kKinds), &NameOf);
INSTANTIATE_TEST_SUITE_P(Kinds, ReadingFuzzLong, testing::ValuesIn(kKinds), &NameOf);

}  // namespace
}  // namespace possibility::fuzz
