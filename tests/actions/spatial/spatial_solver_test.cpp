#include "actions/spatial/spatial_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "actions/verify/verifier.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/self_clearance.h"
#include "common/cancellation_token.h"
#include "dynamics/tree/tree_kinematics.h"
#include "tests/actions/plan_mutations.h"
#include "tests/actions/spatial/walk_by_collocation.h"
#include "tests/message_of.h"

namespace possibility::actions {
namespace {

/// One step and the other foot beside it, solved once per test program.
struct OneStep {
  OneStep() {
    walk.settings.interval = 0.1;  // coarse, to be quick
    solution = walk.Solve();
  }

  WalkByCollocation walk{0.25, 0.25};
  SpatialSolution solution;

  static const OneStep& Get() {
    static const OneStep step;
    return step;
  }
};

double SmallestSelfDistance(const std::vector<Phase>& phases) {
  const models::CollisionChecker checker(DrcHubo1(), models::Environment());
  dynamics::TreeKinematics kinematics(DrcHubo1());
  double smallest = 1;
  for (const Phase& phase : phases) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      for (const auto& pair : checker.SelfProximities(kinematics.X_WL(), 0.05)) {
        smallest = std::min(smallest, pair.distance);
      }
    }
  }
  return smallest;
}

void ExpectVerifiedWithin(const testing::VerifierSubject& subject, double drift) {
  const VerificationReport report = Verify(subject.plan, subject.robot, subject.scenario);
  for (const Violation& violation : report.violations) {
    ADD_FAILURE() << ToString(violation.kind) << ": " << violation.quantity << ", "
                  << violation.value << " (limit " << violation.limit << ") at " << violation.time;
  }
  ASSERT_FALSE(report.rollouts.empty());
  for (const StretchRollout& rollout : report.rollouts) {
    EXPECT_LT(rollout.drift.worst_position, drift);
  }
}

TEST(SpatialSolver, AStepIsAcceptedByTheVerifier) {
  ExpectVerifiedWithin(OneStep::Get().walk.PlanOf(OneStep::Get().solution), 0.01);
}

TEST(SpatialSolver, LinksKeepTheirClearance) {
  EXPECT_GT(SmallestSelfDistance(OneStep::Get().solution.phases),
            OneStep::Get().walk.settings.clearance);
}

TEST(SpatialSolver, TheMotionFollowsTheSchedule) {
  const models::ContactSchedule& wanted = OneStep::Get().walk.schedule;
  const models::ContactSchedule followed =
      ScheduleOfMotion(DrcHubo1(), {{"walk", OneStep::Get().solution.phases}});
  ASSERT_EQ(followed.intervals.size(), wanted.intervals.size());
  for (std::size_t k = 0; k < wanted.intervals.size(); ++k) {
    for (std::size_t i = 0; i < wanted.contacts.size(); ++i) {
      const auto same =
          std::find(followed.contacts.begin(), followed.contacts.end(), wanted.contacts[i]);
      ASSERT_NE(same, followed.contacts.end());
      const auto& place = followed.intervals[k].bearing[same - followed.contacts.begin()];
      ASSERT_EQ(place.has_value(), wanted.intervals[k].bearing[i].has_value());
      if (place) {
        EXPECT_LT((place->matrix() - wanted.intervals[k].bearing[i]->matrix()).norm(), 1e-9);
      }
    }
  }
}

TEST(SpatialSolver, DurationsStayWithinTheirBounds) {
  const OneStep& step = OneStep::Get();
  for (std::size_t k = 0; k < step.walk.schedule.intervals.size(); ++k) {
    const double share = step.solution.result.trajectory.phases[k].duration /
                         step.walk.schedule.intervals[k].duration;
    EXPECT_GT(share, step.walk.settings.problem.sequence.quickest - 1e-9);
    EXPECT_LT(share, step.walk.settings.problem.sequence.slowest + 1e-9);
  }
}

TEST(SpatialSolver, FeetUnloadBeforeTheyLiftAndLoadAfterTheyLand) {
  const std::vector<Phase>& phases = OneStep::Get().solution.phases;
  const double weight = DrcHubo1().TotalMass() * dynamics::kGravity;
  for (std::size_t k = 1; k < phases.size(); ++k) {
    for (const bool lands : {true, false}) {
      const Phase& with = lands ? phases[k] : phases[k - 1];
      const Phase& without = lands ? phases[k - 1] : phases[k];
      const Knot& knot = lands ? with.knots.front() : with.knots.back();
      for (std::size_t i = 0; i < with.contacts.size(); ++i) {
        if (std::count(without.contacts.begin(), without.contacts.end(), with.contacts[i]) > 0) {
          continue;
        }
        const double load = knot.forces.middleCols(4 * static_cast<int>(i), 4).row(2).sum();
        EXPECT_LT(load, 0.02 * weight);
      }
    }
  }
}

TEST(SpatialSolver, BeginsWithTheSolutionOfANeighbouringProblem) {
  const OneStep& step = OneStep::Get();
  WalkByCollocation again(0.26, 0.26);
  again.settings.interval = step.walk.settings.interval;
  const SpatialSolution from_line = again.Solve();
  again.settings.start = step.solution.solution;
  const SpatialSolution from_step = again.Solve();
  EXPECT_LT(from_step.iterations, from_line.iterations);
  EXPECT_NEAR(from_step.result.objective, from_line.result.objective,
              1e-5 * from_line.result.objective);
}

TEST(SpatialSolver, AStartWithOtherQuantitiesIsNotUsed) {
  WalkByCollocation again = OneStep::Get().walk;
  again.settings.start = OneStep::Get().solution.solution;
  again.settings.start->phases.front().coordinates.front() = "other";
  EXPECT_EQ(again.Solve().iterations, OneStep::Get().solution.iterations);
}

TEST(SpatialSolver, AStepOutOfReachIsRefused) {
  const WalkByCollocation walk(1.2, 1.2);
  EXPECT_THROW(
      {
        WalkByCollocation far = walk;
        far.settings.solver.max_iterations = 15;
        far.settings.interval = 0.2;
        far.Solve();
      },
      MotionError);
}

TEST(SpatialSolver, CancelsBeforeItBegins) {
  const CancellationToken cancelled([] { return false; });
  EXPECT_THROW(OneStep::Get().walk.Solve(cancelled), Cancelled);
}

TEST(SpatialSolver, AContactThatTheRobotLacksIsNamed) {
  WalkByCollocation walk(0.25, 0.25);
  walk.schedule.contacts[0] = "third_sole";
  EXPECT_EQ(MessageOf([&] { walk.Solve(); }),
            "contact sequence: the robot has no contact 'third_sole'");
}

TEST(SpatialSolver, ARestOfAnotherSizeIsRefused) {
  WalkByCollocation walk(0.25, 0.25);
  walk.to.conservativeResize(walk.to.size() - 1);
  EXPECT_THROW(walk.Solve(), std::invalid_argument);
}

TEST(SpatialSolverLong, AWalkOf280CentimetresIsVerified) {
  const WalkByCollocation walk(2.8, 0.4);
  const SpatialSolution solution = walk.Solve();
  EXPECT_GT(SmallestSelfDistance(solution.phases), walk.settings.clearance);
  ExpectVerifiedWithin(walk.PlanOf(solution), 0.01);
}

}  // namespace
}  // namespace possibility::actions
