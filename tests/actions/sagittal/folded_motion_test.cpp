#include "actions/sagittal/folded_motion.h"

#include <gtest/gtest.h>

#include "actions/jump/jump_library.h"
#include "actions/jump/jump_solver.h"
#include "actions/rollout/dynamic_stretch.h"
#include "actions/rollout/perturbed_rollout.h"
#include "actions/sagittal/bare_ground.h"
#include "models/world/ground_map.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {
namespace {

/// The stretch of one of DRC-HUBO1's shipped jumps that is simulated.
class ShippedJump {
 public:
  ShippedJump()
      : walk_(SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"))),
        crawl_(SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("crawl"))),
        solver_(DrcHubo1(), walk_, crawl_),
        jump_(JumpLibrary(solver_, DrcHubo1().file.parent_path() / "jumps").Find(kTask).value()),
        ground_(BareGround(solver_.model(), kTask.distance, kTask.height, 0.01),
                DrcHubo1().friction) {
    Plan plan;
    plan.segments = {{"jump", jump_.jump->phases}};
    motion_ = DynamicStretches(plan).front().motion;
  }

  const dynamics::SagittalReduction& reduction() const { return solver_.model().reduction(); }
  const Segment& motion() const { return motion_; }
  const models::GroundMap& ground() const { return ground_; }

 private:
  static constexpr JumpTask kTask = {0.5, 0};

  NominalStance walk_, crawl_;
  JumpSolver solver_;
  JumpAnswer jump_;
  models::GroundMap ground_;
  Segment motion_;
};

const ShippedJump& Jump() {
  static const ShippedJump jump;
  return jump;
}

FoldedMotion Folded() { return FoldMotion(Jump().reduction(), Jump().motion()).value(); }

RolloutDrift RollOutWhole(const Perturbation& perturbation,
                          const PerturbedRolloutSettings& settings = {}) {
  return RollOutPerturbed(Jump().motion(), DrcHubo1(), Jump().ground(), perturbation, settings);
}

RolloutDrift RollOutFolded(const Perturbation& perturbation,
                           PerturbedRolloutSettings settings = {}) {
  const FoldedMotion folded = Folded();
  settings.gains = folded.gains;
  return RollOutPerturbed(folded.motion, folded.robot, Jump().ground(), perturbation, settings);
}

TEST(FoldedMotionTest, FoldedRobotHasTheMassAndTheContactsOfTheWholeOne) {
  const FoldedMotion folded = Folded();
  EXPECT_NEAR(folded.robot.TotalMass(), DrcHubo1().TotalMass(), 1e-9);
  ASSERT_EQ(folded.robot.contacts.size(), DrcHubo1().contacts.size());
  EXPECT_LT(folded.robot.num_joints(), DrcHubo1().num_joints() / 2);
}

TEST(FoldedMotionTest, FoldedJumpDriftsFromItsPlanAsTheWholeOneDoes) {
  // With the tolerances of a check, the integrator's own errors are a tenth of the drift.
  PerturbedRolloutSettings accurate;
  accurate.tolerance = 1e-8;
  accurate.velocity_tolerance = 1e-8;
  for (const double mass : {0.97, 1.0, 1.02}) {
    Perturbation perturbation;
    perturbation.mass = mass;
    const RolloutDrift whole = RollOutWhole(perturbation, accurate);
    const RolloutDrift folded = RollOutFolded(perturbation, accurate);
    EXPECT_TRUE(whole.survives()) << mass;
    EXPECT_TRUE(folded.survives()) << mass;
    // The published masses of the two sides differ a little.
    EXPECT_NEAR(folded.worst_position, whole.worst_position, 0.02 * whole.worst_position) << mass;
    EXPECT_NEAR(folded.worst_joint, whole.worst_joint, 0.02 * whole.worst_joint) << mass;
    EXPECT_NEAR(folded.torque_used, whole.torque_used, 0.01) << mass;
  }
}

TEST(FoldedMotionTest, FoldedRobotFallsWhenTheWholeOneDoes) {
  Perturbation weak;
  weak.torque = 0.4;
  const RolloutDrift whole = RollOutWhole(weak);
  const RolloutDrift folded = RollOutFolded(weak);
  ASSERT_TRUE(whole.fell_at.has_value());
  ASSERT_TRUE(folded.fell_at.has_value());
  EXPECT_NEAR(*folded.fell_at, *whole.fell_at, 0.02);
}

TEST(FoldedMotionTest, MotionThatIsNotSymmetricIsNotFolded) {
  Segment turned = Jump().motion();
  turned.phases.back().knots.back().q[7] += 0.2;
  EXPECT_FALSE(FoldMotion(Jump().reduction(), turned));
  Segment aside = Jump().motion();
  aside.phases.front().knots.front().q[5] = 0.1;
  EXPECT_FALSE(FoldMotion(Jump().reduction(), aside));
}

}  // namespace
}  // namespace possibility::actions
