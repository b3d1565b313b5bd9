#include "experiments/problems/regression_problems.h"

#include "experiments/problems/closed_form_problems.h"
#include "experiments/problems/robot_problems.h"
#include "experiments/problems/swing_up_problems.h"
#include "experiments/problems/textbook_problems.h"
#include "experiments/problems/walking_problems.h"

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
