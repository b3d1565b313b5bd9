#include "experiments/problems/regression_problems.h"

#include "experiments/problems/aerospace_problems.h"
#include "experiments/problems/chemical_problems.h"
#include "experiments/problems/closed_form_problems.h"
#include "experiments/problems/constrained_problems.h"
#include "experiments/problems/linear_problems.h"
#include "experiments/problems/robot_problems.h"
#include "experiments/problems/swing_up_problems.h"
#include "experiments/problems/textbook_problems.h"
#include "experiments/problems/time_optimal_problems.h"
#include "experiments/problems/variational_problems.h"
#include "experiments/problems/walking_problems.h"

namespace possibility::experiments {

std::vector<RegressionProblem> RegressionProblems() {
  std::vector<RegressionProblem> all = ClosedFormProblems();
  for (auto&& more : {TextbookProblems(), SwingUpProblems(), WalkingProblems(),
                      VariationalProblems(), LinearProblems(), TimeOptimalProblems(),
                      AerospaceProblems(), ChemicalProblems(), ConstrainedProblems()}) {
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
