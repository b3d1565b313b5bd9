#include <gtest/gtest.h>

#include "experiments/problems/aerospace_problems.h"
#include "experiments/problems/chemical_problems.h"
#include "experiments/problems/constrained_problems.h"
#include "experiments/problems/linear_problems.h"
#include "experiments/problems/time_optimal_problems.h"
#include "experiments/problems/variational_problems.h"
#include "experiments/regression/regression_run.h"

namespace possibility::experiments {
namespace {

void ExpectKnownOptima(const std::vector<RegressionProblem>& problems) {
  for (const RegressionProblem& problem : problems) {
    const RegressionRecord record = RunProblem(problem, {});
    EXPECT_EQ(record.status, "solved") << problem.name << ": " << record.message;
    EXPECT_TRUE(record.within_tolerance)
        << problem.name << ": " << record.objective << ", known " << record.nearest.objective;
  }
}

TEST(PublishedProblems, EndAtAKnownOptimum) {
  ExpectKnownOptima(VariationalProblems());
  ExpectKnownOptima(LinearProblems());
  ExpectKnownOptima(TimeOptimalProblems());
  ExpectKnownOptima(AerospaceProblems());
  ExpectKnownOptima(ChemicalProblems());
  ExpectKnownOptima(ConstrainedProblems());
}

}  // namespace
}  // namespace possibility::experiments
