// Legged motion with rigid impacts: a periodic step of a biped and a hop from rest to rest. The
// trees' roots are at the standing feet (legged_models.h), so that coordinates hold a foot.
#include "experiments/problems/walking_problems.h"

#include <string>
#include <vector>

#include "experiments/legged/biped_step.h"
#include "experiments/legged/hop_problem.h"

namespace possibility::experiments {

std::vector<RegressionProblem> WalkingProblems() {
  // Kelly's guess (his angles have the opposite sign), and one that bends the knees the other way.
  const BipedStep::Angles kelly(0.3, -1.0, 0.7, 0.5, 0.1);
  const BipedStep::Angles forward(-0.4, 0.5, 0, 0.3, 0);
  // The logs of Ipopt and SNOPT end at different extremals of one problem.
  const std::string logs = "OptimTraj, demo/fiveLinkBiped at 8c43235: logs of GPOPS-II";
  const std::vector<KnownOptimum> extremals = {{"knees forward", 263.69884582, 1e-6},
                                               {"knees backward", 302.25469438, 1e-6},
                                               {"knees straight", 338.994818, 3e-6}};
  return {
      {"five_link_step",
       "Kelly 2017, five-link biped; optimum ours: both linear solvers, and a mesh of 160 "
       "intervals",
       {{"global", 469.6501, 1e-5}},
       [=] {
         return FiveLinkStep({0.5, 0.7, true, kelly});
       },
       30},
      {"five_link_step_short", logs, extremals,
       [=] {
         return FiveLinkStep({0.4, 0.6, false, kelly});
       },
       30},
      {"five_link_step_forward", logs, extremals,
       [=] {
         return FiveLinkStep({0.4, 0.6, false, forward});
       },
       30},
      {"planar_hop",
       "ours: both linear solvers, and a mesh of 240 intervals per phase",
       {{"global", 305.2258, 1e-5}},
       [] { return Hop(0.4); },
       60},
  };
}

}  // namespace possibility::experiments
