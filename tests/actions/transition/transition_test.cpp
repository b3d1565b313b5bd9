#include <gtest/gtest.h>

#include <fstream>

#include "actions/plan/interpolation.h"
#include "actions/transition/transition_motion.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/input/input_error.h"
#include "models/world/collision.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/load_steps.h"
#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The transition, solved once per test program.
class TransitionTest : public ::testing::Test {
 protected:
  struct Solved {
    NominalStance walk = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
    NominalStance crawl = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("crawl"));
    TransitionMotion transition{DrcHubo1(), walk, crawl, {}, {}};
    double displacement = transition.displacement().x;
    const std::vector<Phase>& motion = transition.phases();
  };

  static const Solved& Sitting() {
    static const Solved solved;
    return solved;
  }
};

TEST_F(TransitionTest, LeadsFromStanceToStanceAtRest) {
  const Knot& first = Sitting().motion.front().knots.front();
  const Knot& last = Sitting().motion.back().knots.back();
  EXPECT_LT((first.q - Sitting().walk.q).norm(), 1e-9);
  VectorXd landed = Sitting().crawl.q;
  landed[4] += Sitting().displacement;
  EXPECT_LT((last.q - landed).norm(), 1e-8);
  // What the optimiser's constraint tolerance leaves in the plan's own velocities.
  EXPECT_LT(first.v.norm() + last.v.norm(), 1e-6);
}

TEST_F(TransitionTest, HandsTakeUpTheirLoadGradually) {
  EXPECT_LT(testing::GreatestLoadAtContactChanges(DrcHubo1(), Sitting().motion), 0.02);
  EXPECT_LT(testing::GreatestTorqueStep(Sitting().motion), 1);
}

TEST_F(TransitionTest, FeetStayAndHandsArriveAtRest) {
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

TEST_F(TransitionTest, ForcesAndTorquesAgreeWithSimbody) {
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

TEST_F(TransitionTest, HasNoSelfCollision) {
  const models::CollisionChecker checker(DrcHubo1(), models::Environment());
  dynamics::TreeKinematics kinematics(DrcHubo1());
  for (const Phase& phase : Sitting().motion) {
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      EXPECT_TRUE(checker.SelfProximities(kinematics.X_WL(), 0).empty()) << knot.t;
    }
  }
}

TEST_F(TransitionTest, ReadsBackTheSameFromTheLibrary) {
  const models::TemporaryFolder folder;
  const Solved& solved = Sitting();
  const TransitionMotion first(DrcHubo1(), solved.walk, solved.crawl, folder.path(), {});
  EXPECT_FALSE(first.was_known());
  first.Save();
  const TransitionMotion second(DrcHubo1(), solved.walk, solved.crawl, folder.path(), {});
  EXPECT_TRUE(second.was_known());
  ASSERT_EQ(second.phases().size(), first.phases().size());
  for (std::size_t i = 0; i < first.phases().size(); ++i) {
    ASSERT_EQ(second.phases()[i].knots.size(), first.phases()[i].knots.size());
    for (std::size_t k = 0; k < first.phases()[i].knots.size(); ++k) {
      EXPECT_EQ(second.phases()[i].knots[k].q, first.phases()[i].knots[k].q);
      EXPECT_EQ(second.phases()[i].knots[k].tau, first.phases()[i].knots[k].tau);
    }
  }
}

TEST_F(TransitionTest, ADamagedLibraryIsSolvedAnew) {
  const models::TemporaryFolder folder;
  const Solved& solved = Sitting();
  TransitionMotion(DrcHubo1(), solved.walk, solved.crawl, folder.path(), {}).Save();
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file()) std::ofstream(entry.path()) << "{\"format\": 1";
  }
  const TransitionMotion again(DrcHubo1(), solved.walk, solved.crawl, folder.path(), {});
  EXPECT_FALSE(again.was_known());
  EXPECT_EQ(again.ExpectedDuration(), solved.transition.ExpectedDuration());
}

TEST_F(TransitionTest, ATransitionToFewerContactsIsRefused) {
  try {
    const TransitionMotion backwards(DrcHubo1(), Sitting().crawl, Sitting().walk, {}, {});
    FAIL() << "nothing thrown";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("crawl bears on a contact that walk does not"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(TransitionTest, IsCancelledWhenTimeIsUp) {
  EXPECT_THROW(TransitionMotion(DrcHubo1(), Sitting().walk, Sitting().crawl, {},
                                CancellationToken([] { return false; })),
               Cancelled);
}

}  // namespace
}  // namespace possibility::actions
