#include "experiments/regression_problems.h"

namespace possibility::experiments {

std::vector<RegressionProblem> RegressionProblems() {
  std::vector<RegressionProblem> all = ClosedFormProblems();
  for (auto&& more : {TextbookProblems(), SwingUpProblems(), WalkingProblems()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

std::vector<RegressionProblem> RegressionProblems(const models::RobotModel& humanoid) {
  std::vector<RegressionProblem> all = RegressionProblems();
  for (RegressionProblem& problem : RobotProblems(humanoid)) all.push_back(std::move(problem));
  return all;
}

}  // namespace possibility::experiments
