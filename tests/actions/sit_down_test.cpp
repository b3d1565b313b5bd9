#include <gtest/gtest.h>

#include "actions/interpolation.h"
#include "actions/sit_down_problem.h"
#include "actions/stance_motion.h"
#include "collocation/optimal_control.h"
#include "dynamics/simbody_dynamics.h"
#include "dynamics/tree_kinematics.h"
#include "models/collision.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The transition, solved once per test program.
class SitDownTest : public testing::Test {
 protected:
  struct Solved {
    NominalStance walk = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
    NominalStance crawl = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("crawl"));
    JumpModel model{DrcHubo1(), walk, crawl};
    double displacement = SitDownProblem::Displacement(model);
    collocation::OptimalControlResult result;
    std::vector<Phase> motion;

    Solved() {
      const SitDownProblem problem(model, {});
      collocation::OptimalControlOptions options;
      options.intervals = {14, 8};
      options.solver.tolerance = 1e-5;
      options.solver.constraint_tolerance = 1e-7;
      result = collocation::SolveOptimalControl(problem.problem(), options);
      const auto& plans = result.trajectory.phases;
      StanceMotion stance(DrcHubo1(), model, walk, crawl);
      const Support all = stance.LandingAll(displacement, 0);
      Append(stance.Prepare(), &motion);
      Append(stance.FollowUntilPlaced(plans[0], stance.PlannedKnot(plans[0], 0),
                                      stance.LaunchFeet(), all),
             &motion);
      Append(stance.Follow(plans[1], motion.back().knots.back(), all), &motion);
    }
  };

  static const Solved& Sitting() {
    static const Solved solved;
    return solved;
  }
};

TEST_F(SitDownTest, ConvergesOnACoarseMesh) {
  EXPECT_TRUE(Sitting().result.succeeded()) << Sitting().result.message;
  EXPECT_LT(Sitting().result.mesh_error, 1e-4);
}

TEST_F(SitDownTest, LeadsFromStanceToStanceAtRest) {
  const Knot& first = Sitting().motion.front().knots.front();
  const Knot& last = Sitting().motion.back().knots.back();
  EXPECT_LT((first.q - Sitting().walk.q).norm(), 1e-9);
  VectorXd landed = Sitting().crawl.q;
  landed[4] += Sitting().displacement;
  EXPECT_LT((last.q - landed).norm(), 1e-8);
  // What the optimiser's constraint tolerance leaves of the plan's own velocities.
  EXPECT_LT(first.v.norm() + last.v.norm(), 1e-6);
}

TEST_F(SitDownTest, FeetStayAndHandsArriveAtRest) {
  dynamics::TreeKinematics kinematics(DrcHubo1());
  const models::ContactPatch& sole = DrcHubo1().contacts[DrcHubo1().ContactIndex("left_sole")];
  const models::ContactPatch& peg = DrcHubo1().contacts[DrcHubo1().ContactIndex("left_peg")];
  kinematics.SetPosition(Sitting().walk.q);
  const Vector3d foot = kinematics.Position(sole.link, sole.points[0]);
  for (const Phase& phase : Sitting().motion) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      EXPECT_LT((kinematics.Position(sole.link, sole.points[0]) - foot).norm(), 1e-8) << knot.t;
    }
  }
  const Knot& touch = Sitting().motion[1].knots.back();
  kinematics.SetPosition(touch.q);
  kinematics.SetVelocity(touch.v);
  EXPECT_LT(kinematics.Velocity(peg.link, peg.points[0]).norm(), 1e-8);
  EXPECT_NEAR(kinematics.Position(peg.link, peg.points[0]).z(), 0, 1e-8);
}

TEST_F(SitDownTest, ForcesAndTorquesAreThoseOfSimbody) {
  const models::RobotModel& robot = DrcHubo1();
  const double weight = robot.TotalMass() * dynamics::kGravity;
  dynamics::SimbodyDynamics simbody(robot);
  for (const Phase& phase : Sitting().motion) {
    for (const Knot& knot : phase.knots) {
      simbody.SetState(knot.q, knot.v);
      VectorXd forces = simbody.InverseDynamics(knot.a);
      int column = 0;
      for (const std::string& name : phase.contacts) {
        const models::ContactPatch& patch = robot.contacts[robot.ContactIndex(name)];
        for (const Vector3d& p : patch.points) {
          const Vector3d force = knot.forces.col(column++);
          forces -= simbody.PointJacobian(patch.link, p).transpose() * force;
          EXPECT_GE(force.z(), -1e-9);
          EXPECT_LE(force.head<2>().norm(), robot.friction * force.z() + 1e-6);
        }
      }
      EXPECT_LT(forces.head<6>().cwiseAbs().maxCoeff(), 1e-6 * weight) << knot.t;
      for (int j = 0; j < robot.num_joints(); ++j) {
        EXPECT_NEAR(forces[6 + j], knot.tau[j], 1e-6 * weight);
        EXPECT_LE(std::abs(knot.tau[j]), robot.joints[j].effort);
        EXPECT_LE(std::abs(knot.v[6 + j]), robot.joints[j].velocity);
      }
    }
  }
}

TEST_F(SitDownTest, DoesNotRunIntoItself) {
  const models::CollisionChecker checker(DrcHubo1(), models::Environment());
  dynamics::TreeKinematics kinematics(DrcHubo1());
  for (const Phase& phase : Sitting().motion) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      EXPECT_TRUE(checker.SelfProximities(kinematics.X_WL(), 0).empty()) << knot.t;
    }
  }
}

}  // namespace
}  // namespace possibility::actions
