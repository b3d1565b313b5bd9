#include "actions/route/route_motion.h"

#include <gtest/gtest.h>

#include "actions/motion/phase_sequence.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/actions/leap.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr double kPreparation = 0.9;  // s
const char* const kWrists[] = {"LWP", "RWP"};

/// A walk to the pit and a leap across it. The leap begins with a phase in which the robot stands
/// still and does something, and then slides.
class PreparedLeapTest : public ::testing::Test {
 protected:
  /// The first phase turns the wrists by `turn_`, and moves the root by `shift`, m.
  std::vector<Phase> Motion(const Leap& leap, double shift) const {
    std::vector<Phase> slide = leap.Slide();
    Phase standing;
    standing.contacts = slide.front().contacts;
    for (int i = 0; i <= 10; ++i) {
      const double t = kPreparation * i / 10;
      Knot knot = slide.front().knots.front();
      knot.t = t;
      Turn(RestToRest(t, kPreparation), &knot);
      knot.q[6] += shift * RestToRest(t, kPreparation).value;
      standing.knots.push_back(knot);
    }
    for (Knot& knot : slide.front().knots) {
      const double duration = slide.front().knots.back().t;
      const ScalarSignal back = RestToRest(knot.t, duration);
      Turn({1 - back.value, -back.rate, -back.acceleration}, &knot);
      knot.q[6] += shift * (1 - back.value);
    }
    std::vector<Phase> motion = {standing};
    Append(slide.front(), &motion);
    return motion;
  }

  void Turn(const ScalarSignal& share, Knot* knot) const {
    for (const char* wrist : kWrists) {
      const int joint = robot_.JointIndex(wrist);
      knot->q[7 + joint] -= turn_ * share.value;
      knot->v[6 + joint] -= turn_ * share.rate;
      knot->a[6 + joint] -= turn_ * share.acceleration;
    }
  }

  std::vector<Segment> Generate(double shift, bool walks) const {
    const Context context(scene_.environment);
    SearchedManoeuvre leap(std::make_shared<Leap>(*context, Sleeps(0),
                                                  [&](const Leap& l) { return Motion(l, shift); }));
    RouteLeg walk;
    walk.from = {-1.5, 0, 0};
    walk.to = {-Leap::kHalf, 0, 0};
    RouteLeg across;
    across.manoeuvre = &leap;
    across.from = {-Leap::kHalf, 0, 0};
    across.to = {Leap::kHalf, 0, 0};
    const Route route = walks ? Route{walk, across} : Route{across};
    return GenerateMotion(DrcHubo1Locomotion(), scene_.environment, route, 1, {});
  }

  double turn_ = 0.4;  ///< rad
  const models::RobotModel& robot_ = DrcHubo1();
  models::Scenario scene_ = PitScene(false);
};

TEST_F(PreparedLeapTest, TheRobotPreparesOnTheWay) {
  const std::vector<Segment> alone = Generate(0, false);
  const std::vector<Segment> segments = Generate(0, true);
  ASSERT_EQ(alone.at(0).phases.size(), 2u);
  ASSERT_EQ(segments.at(1).phases.size(), 1u);
  const Knot& arrived = segments[0].phases.back().knots.back();
  const Knot& leaps = segments[1].phases.front().knots.front();
  EXPECT_LT((arrived.q - leaps.q).lpNorm<Eigen::Infinity>(), 1e-6);
  EXPECT_LT(arrived.v.norm(), 1e-6);
  EXPECT_NEAR(arrived.t, leaps.t, 1e-12);
  for (const char* wrist : kWrists) {
    const int joint = robot_.JointIndex(wrist);
    EXPECT_NEAR(arrived.q[7 + joint], DrcHubo1Locomotion().gaits[0]->stance.q[7 + joint] - turn_,
                1e-9);
  }
  // The preparation takes no time of its own.
  EXPECT_NEAR(segments[1].phases.back().knots.back().t - leaps.t,
              alone[0].phases.back().knots.back().t - kPreparation, 1e-9);
}

TEST_F(PreparedLeapTest, APauseIsKept) {
  turn_ = 0;
  EXPECT_EQ(Generate(0, true).at(1).phases.size(), 2u);
}

TEST_F(PreparedLeapTest, APreparationThatMovesTheRootIsKept) {
  const std::vector<Segment> segments = Generate(-0.01, true);
  EXPECT_EQ(segments.at(1).phases.size(), 2u);
  const Knot& arrived = segments[0].phases.back().knots.back();
  for (const char* wrist : kWrists) {
    const int joint = robot_.JointIndex(wrist);
    EXPECT_NEAR(arrived.q[7 + joint], DrcHubo1Locomotion().gaits[0]->stance.q[7 + joint], 1e-9);
  }
}

}  // namespace
}  // namespace possibility::actions
