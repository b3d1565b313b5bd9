#include "actions/jump/jump_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "actions/jump/jump_library.h"
#include "actions/jump/jump_reach.h"
#include "actions/plan/interpolation.h"
#include "actions/rollout/dynamic_stretch.h"
#include "actions/rollout/perturbed_rollout.h"
#include "actions/sagittal/bare_ground.h"
#include "dynamics/simbody/simbody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/input/input_error.h"
#include "models/world/ground_map.h"
#include "tests/actions/geared_drchubo1.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// What the optimiser's constraint tolerance leaves in the plan's own velocities.
constexpr double kMesh = 1e-6;

// Phases in the order of JumpMotion: a preparation comes before the phases of the problem, and rise
// and descent are one phase.
enum MotionPhaseIndex { kPreparation, kCrouch, kToes, kFlight, kSettle, kLanding };

const NominalStance& Stance(const std::string& gait) {
  static const NominalStance walk = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("walk"));
  static const NominalStance crawl = SolveNominalStance(DrcHubo1(), DrcHubo1().GaitNamed("crawl"));
  return gait == "walk" ? walk : crawl;
}

const JumpSolver& Solver() {
  static const JumpSolver solver(DrcHubo1(), Stance("walk"), Stance("crawl"));
  return solver;
}

const JumpTask kTask = {0.5, 0};

/// Solved once per test program.
const JumpAnswer& Answer() {
  static const JumpAnswer answer = Solver().Solve(kTask);
  return answer;
}

const Phase& MotionPhaseOf(int index) { return Answer().jump->phases.at(index); }

/// Calls `look` at the knots and midway between them.
template <typename Look>
void AtSamples(const Phase& phase, const Look& look) {
  for (std::size_t i = 0; i + 1 < phase.knots.size(); ++i) {
    look(phase.knots[i]);
    look(Interpolate(phase.knots[i], phase.knots[i + 1],
                     (phase.knots[i].t + phase.knots[i + 1].t) / 2));
  }
  look(phase.knots.back());
}

/// The points of a phase's forces.
std::vector<dynamics::ContactPoint> Points(const std::vector<std::string>& patches) {
  std::vector<dynamics::ContactPoint> points;
  for (const std::string& name : patches) {
    const models::ContactPatch& patch = DrcHubo1().contacts[DrcHubo1().ContactIndex(name)];
    for (const Vector3d& p : patch.points) points.push_back({patch.link, p});
  }
  return points;
}

double Weight() { return DrcHubo1().TotalMass() * dynamics::kGravity; }

double Pitch(const VectorXd& q) { return 2 * std::atan2(q[2], q[0]); }

TEST(JumpSolverTest, FindsAJumpOfTheWholeRobot) {
  ASSERT_TRUE(Answer().jump) << Answer().reason;
  EXPECT_FALSE(Answer().cancelled);
  ASSERT_EQ(Answer().jump->phases.size(), 6u);
  EXPECT_TRUE(MotionPhaseOf(kFlight).contacts.empty());
  EXPECT_EQ(MotionPhaseOf(kToes).contacts,
            (std::vector<std::string>{"left_sole[0,3]", "right_sole[0,3]"}));
}

TEST(JumpSolverTest, LeadsFromStanceToStanceAtRest) {
  const Knot& first = MotionPhaseOf(kPreparation).knots.front();
  const Knot& last = MotionPhaseOf(kLanding).knots.back();
  EXPECT_LT((first.q - Stance("walk").q).norm(), 1e-9);
  VectorXd landed = Stance("crawl").q;
  landed[4] += kTask.distance;
  EXPECT_LT((last.q - landed).norm(), 1e-8);
  EXPECT_LT(first.v.norm() + last.v.norm(), kMesh);
}

/// A jump that lands on its feet: there are no hands to set down. Solve verifies and simulates it.
TEST(LeapSolverTest, LeadsFromWalkingStanceToWalkingStanceAtRest) {
  const JumpSolver solver(DrcHubo1(), Stance("walk"), Stance("walk"));
  for (const JumpTask& task : {JumpTask{0.4, 0}, JumpTask{0.75, 0}, JumpTask{0.6, -0.1}}) {
    const JumpAnswer answer = solver.Solve(task);
    ASSERT_TRUE(answer.jump) << answer.reason;
    const std::vector<Phase>& phases = answer.jump->phases;
    EXPECT_LT((phases.front().knots.front().q - Stance("walk").q).norm(), 1e-9);
    VectorXd landed = Stance("walk").q;
    landed[4] += task.distance;
    landed[6] += task.height;
    EXPECT_LT((phases.back().knots.back().q - landed).norm(), 1e-7);
    EXPECT_LT(phases.back().knots.back().v.norm(), kMesh);
    // No joint turns before the crouch.
    EXPECT_EQ(answer.jump->preparation, 0);
    ASSERT_EQ(phases.size(), 5u);
    EXPECT_TRUE(phases.at(kFlight - 1).contacts.empty());
    for (const int phase : {kSettle, kLanding}) {
      EXPECT_EQ(phases.at(phase - 1).contacts, phases.at(kCrouch - 1).contacts);
    }
  }
}

TEST(LeapSolverTest, JumpsOfOtherGaitsHaveAnotherIdentity) {
  const JumpSolver leap(DrcHubo1(), Stance("walk"), Stance("walk"));
  EXPECT_NE(leap.Identity(), Solver().Identity());
}

TEST(JumpSolverTest, PhasesAreContinuousExceptForTheImpact) {
  const std::vector<Phase>& phases = Answer().jump->phases;
  for (std::size_t i = 1; i < phases.size(); ++i) {
    const Knot& before = phases[i - 1].knots.back();
    const Knot& after = phases[i].knots.front();
    EXPECT_NEAR(before.t, after.t, 1e-12) << i;
    EXPECT_LT((before.q - after.q).norm(), 1e-8) << i;
    if (phases[i].impulses.cols() == 0) {
      EXPECT_LT((before.v - after.v).norm(), 1e-8) << i;
    }
  }
  EXPECT_GT(phases[kSettle].impulses.cols(), 0);
}

TEST(JumpSolverTest, TheImpactBalancesMomentumBySimbodysMassMatrix) {
  const Phase& settle = MotionPhaseOf(kSettle);
  const Knot& before = MotionPhaseOf(kFlight).knots.back();
  const Knot& after = settle.knots.front();
  dynamics::SimbodyDynamics simbody(DrcHubo1());
  simbody.SetState(before.q, before.v);
  VectorXd change = simbody.MassMatrix() * (after.v - before.v);
  const auto points = Points(settle.contacts);
  ASSERT_EQ(static_cast<Eigen::Index>(points.size()), settle.impulses.cols());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3d impulse = settle.impulses.col(static_cast<int>(i));
    change -= simbody.PointJacobian(points[i].link, points[i].p_L).transpose() * impulse;
    EXPECT_GE(impulse.z(), 0);
    EXPECT_LE(impulse.head<2>().norm(), DrcHubo1().friction * impulse.z() + 1e-9);
  }
  EXPECT_LT(change.cwiseAbs().maxCoeff(), 1e-9 * Weight());
}

TEST(JumpSolverTest, ForcesAndTorquesAgreeWithSimbody) {
  dynamics::SimbodyDynamics simbody(DrcHubo1());
  for (const int index : {kPreparation, kCrouch, kFlight, kSettle, kLanding}) {
    const Phase& phase = MotionPhaseOf(index);
    const auto points = Points(phase.contacts);
    for (const Knot& knot : phase.knots) {
      simbody.SetState(knot.q, knot.v);
      VectorXd forces = simbody.InverseDynamics(knot.a);
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Vector3d force = knot.forces.col(static_cast<int>(i));
        forces -= simbody.PointJacobian(points[i].link, points[i].p_L).transpose() * force;
        EXPECT_GE(force.z(), -1e-9);
        EXPECT_LE(force.head<2>().norm(), DrcHubo1().friction * force.z() + 1e-6);
      }
      EXPECT_LT(forces.head<6>().cwiseAbs().maxCoeff(), 1e-6 * Weight()) << index << " " << knot.t;
      EXPECT_LT((forces.tail(DrcHubo1().num_joints()) - knot.tau).cwiseAbs().maxCoeff(),
                1e-6 * Weight());
    }
  }
}

TEST(JumpSolverTest, KeepsJointLimits) {
  for (const Phase& phase : Answer().jump->phases) {
    AtSamples(phase, [](const Knot& knot) {
      for (int j = 0; j < DrcHubo1().num_joints(); ++j) {
        const models::Joint& joint = DrcHubo1().joints[j];
        EXPECT_GE(knot.q[7 + j], joint.lower) << joint.name << knot.t;
        EXPECT_LE(knot.q[7 + j], joint.upper) << joint.name << knot.t;
        EXPECT_LE(std::abs(knot.v[6 + j]), joint.velocity) << joint.name << knot.t;
        EXPECT_LE(std::abs(knot.tau[j]), joint.effort) << joint.name << knot.t;
      }
    });
  }
}

// Ways in which an optimiser has exploited gaps in this problem before.

TEST(JumpSolverLoopholes, PitchBeforeTakeOffStaysWithinItsBounds) {
  for (const int index : {kCrouch, kToes}) {
    AtSamples(MotionPhaseOf(index), [](const Knot& knot) {
      EXPECT_GT(Pitch(knot.q), Solver().settings().min_stance_pitch - 0.01) << knot.t;
      EXPECT_LT(Pitch(knot.q), Solver().settings().max_stance_pitch + 0.01) << knot.t;
    });
  }
}

TEST(JumpSolverLoopholes, BodyStaysAboveTheGround) {
  dynamics::TreeKinematics kinematics(DrcHubo1());
  for (const Phase& phase : Answer().jump->phases) {
    AtSamples(phase, [&](const Knot& knot) {
      kinematics.SetPosition(knot.q);
      for (const char* link : {"Body_LKP", "Body_LHP", "Body_LEP", "Body_LSP", "Body_Torso"}) {
        EXPECT_GT(kinematics.X_WL()[DrcHubo1().LinkIndex(link)].translation().z(), 0.04)
            << link << knot.t;
      }
    });
  }
}

TEST(JumpSolverLoopholes, ForcesDoNotChatter) {
  for (const int index : {kCrouch, kToes, kSettle, kLanding}) {
    const Phase& phase = MotionPhaseOf(index);
    int turns = 0;
    double last_change = 0;
    for (std::size_t i = 1; i < phase.knots.size(); ++i) {
      const double change =
          phase.knots[i].forces.row(2).sum() - phase.knots[i - 1].forces.row(2).sum();
      EXPECT_LT(phase.knots[i].forces.row(2).sum(), 3 * Weight());
      if (std::abs(change) < 0.01 * Weight()) continue;
      turns += change * last_change < 0 ? 1 : 0;
      last_change = change;
    }
    // Chatter changes direction at every node of the mesh. The shortest of these phases has nine
    // nodes.
    EXPECT_LE(turns, 6) << index;
  }
}

TEST(JumpSolverLoopholes, FeetTouchDownSlowly) {
  const Knot& touchdown = MotionPhaseOf(kFlight).knots.back();
  dynamics::SimbodyDynamics simbody(DrcHubo1());
  simbody.SetState(touchdown.q, touchdown.v);
  for (const dynamics::ContactPoint& point : Points({"left_sole", "right_sole"})) {
    const Vector3d v = simbody.PointVelocity(point.link, point.p_L);
    EXPECT_LT(std::hypot(v.x(), v.z()),
              1.5 * Solver().settings().max_contact_speed * Solver().model().units().speed());
    EXPECT_LT(v.z(), 0.05);
  }
}

TEST(JumpSolverLoopholes, TheCentreOfMassTravelsInFlight) {
  dynamics::SimbodyDynamics simbody(DrcHubo1());
  const auto com = [&](const Knot& knot) {
    simbody.SetState(knot.q, knot.v);
    return simbody.CentreOfMass();
  };
  const Phase& flight = MotionPhaseOf(kFlight);
  EXPECT_GT((com(flight.knots.back()) - com(flight.knots.front())).x(), 0.15);
}

TEST(JumpSolverTest, RefusesARootThatIsTooFast) {
  // The root flies at 2 m/s.
  JumpSettings slow = Solver().settings();
  slow.limits.max_base_speed = 1;
  const JumpSolver solver(DrcHubo1(), Stance("walk"), Stance("crawl"), slow);
  const JumpAnswer answer = solver.Realise(kTask, *Answer().solution);
  EXPECT_FALSE(answer.jump);
  EXPECT_NE(answer.reason.find("the root flies at"), std::string::npos) << answer.reason;
}

// On the first mesh a jump up this far is solved, but the whole robot cannot follow it.
TEST(JumpSolverTest, FinerMeshesStartFromTheCoarserSolution) {
  std::vector<int> solves;
  const JumpAnswer answer =
      Solver().Solve({0.7, 0.2}, {}, [&solves](const collocation::SolverIteration& iteration) {
        if (iteration.number == 0) solves.push_back(0);
        solves.back() = iteration.number;
      });
  ASSERT_TRUE(answer.jump) << answer.reason;
  ASSERT_GE(solves.size(), 2U);
  EXPECT_EQ(answer.effort.attempts, std::ssize(solves));
  for (std::size_t i = 1; i < solves.size(); ++i) EXPECT_LT(solves[i], solves[0]);
}

TEST(JumpSolverTest, ACancelledSolveGivesNoJump) {
  const JumpAnswer answer = Solver().Solve(kTask, CancellationToken([] { return false; }));
  EXPECT_TRUE(answer.cancelled);
  EXPECT_FALSE(answer.jump);
}

TEST(JumpSolverTest, AnInfeasibleJumpIsRefusedWithAReason) {
  JumpSettings weak;
  weak.limits.torque_fraction = 0.05;
  const JumpSolver solver(DrcHubo1(), Stance("walk"), Stance("crawl"), weak);
  const JumpAnswer answer = solver.Solve({0.9, 0.3});
  EXPECT_FALSE(answer.jump);
  EXPECT_FALSE(answer.cancelled);
  EXPECT_NE(answer.reason.find("0.900"), std::string::npos) << answer.reason;
}

class JumpLibraryTest : public ::testing::Test {
 protected:
  JumpLibraryTest() : folder_(std::filesystem::temp_directory_path() / Name()) {
    std::filesystem::remove_all(folder_);
  }
  ~JumpLibraryTest() override { std::filesystem::remove_all(folder_); }

  static std::string Name() {
    return std::string("possibility_jumps_") +
           ::testing::UnitTest::GetInstance()->current_test_info()->name();
  }
  JumpLibrary Library() const { return JumpLibrary(Solver(), folder_); }
  void Fill() const {
    const JumpLibrary library = Library();
    library.Save(Answer(), kTask);
    library.SaveReach({{{0, 0.4, 0.6}}});
  }

  std::filesystem::path folder_;
};

TEST_F(JumpLibraryTest, WithoutAFolderTheReachIsOptimistic) {
  JumpLibrary library(Solver(), {});
  EXPECT_FALSE(library.reach_is_derived());
  EXPECT_TRUE(library.reach().Allows({0.95, 0}));
  EXPECT_FALSE(library.Find(kTask));
}

TEST_F(JumpLibraryTest, SavedJumpsAndReachAreReadBack) {
  Fill();
  JumpLibrary library = Library();
  EXPECT_TRUE(library.reach_is_derived());
  EXPECT_TRUE(library.reach().Allows({0.6, 0}));
  EXPECT_FALSE(library.reach().Allows({0.65, 0}));
  EXPECT_FALSE(library.reach().Allows({0.5, 0.1}));
  const auto known = library.Find(kTask);
  ASSERT_TRUE(known && known->jump);
  ASSERT_EQ(known->jump->phases.size(), Answer().jump->phases.size());
  EXPECT_LT(
      (known->jump->phases.back().knots.back().q - MotionPhaseOf(kLanding).knots.back().q).norm(),
      1e-9);
  EXPECT_EQ(known->effort.iterations, 0);
  EXPECT_FALSE(library.Find({0.55, 0}));
}

TEST_F(JumpLibraryTest, TheReachIsReadWithoutTheJumps) {
  Fill();
  JumpLibrary library(Solver(), folder_, JumpLibrary::Use::kReachAlone);
  EXPECT_TRUE(library.reach_is_derived());
  EXPECT_FALSE(library.reach().Allows({0.65, 0}));
  EXPECT_FALSE(library.Find(kTask));
}

TEST_F(JumpLibraryTest, AnotherRobotsFolderIsIgnored) {
  Fill();
  models::RobotModel other = DrcHubo1();
  other.content_hash = "another";
  const NominalStance launch = SolveNominalStance(other, other.GaitNamed("walk"));
  const NominalStance landing = SolveNominalStance(other, other.GaitNamed("crawl"));
  const JumpSolver solver(other, launch, landing);
  JumpLibrary library(solver, folder_);
  EXPECT_FALSE(library.reach_is_derived());
  EXPECT_FALSE(library.Find(kTask));
}

TEST_F(JumpLibraryTest, UnreadableJumpsAreNotFound) {
  Fill();
  for (const auto& entry : std::filesystem::directory_iterator(Library().folder())) {
    if (entry.path().filename().string().starts_with("jump_")) {
      std::ofstream(entry.path()) << "{ truncated";
    }
  }
  JumpLibrary library = Library();
  EXPECT_FALSE(library.Find(kTask));
}

TEST_F(JumpLibraryTest, MalformedTableIsAnInputError) {
  Fill();
  std::ofstream(Library().folder() / "reach.json") << "{\"format\": \"possibility-jumps/1\"}";
  EXPECT_THROW(Library(), InputError);
}

/// All jumps that the reach table promises to ground of a height.
std::vector<std::shared_ptr<const SolvedJump>> ShippedJumps(double height = 0) {
  JumpLibrary library(Solver(), DrcHubo1().file.parent_path() / "jumps");
  EXPECT_TRUE(library.reach_is_derived());
  const auto [shortest, farthest] = library.reach().Distances(height).value();
  const auto first = std::lround(shortest / JumpLibrary::kDistanceStep);
  const auto last = std::lround(farthest / JumpLibrary::kDistanceStep);
  std::vector<std::shared_ptr<const SolvedJump>> jumps;
  for (auto step = first; step <= last; ++step) {
    const JumpTask task = JumpLibrary::OnGrid({step * JumpLibrary::kDistanceStep, height});
    const auto answer = library.Find(task);
    if (answer && answer->jump) jumps.push_back(answer->jump);
    EXPECT_TRUE(answer && answer->jump) << task.distance << " m by " << height << " m";
  }
  return jumps;
}

constexpr double kShippedHeights[] = {-0.2, -0.1, 0, 0.1, 0.2};  // m

std::string FaultOf(const SolvedJump& jump, bool simulates) {
  return FaultOnBareGround(DrcHubo1(), Solver().model(), Stance("walk"), Stance("crawl"),
                           jump.task.distance, jump.task.height, jump.phases, simulates);
}

TEST_F(JumpLibraryTest, TheVerifierAcceptsEveryShippedJump) {
  for (const double height : kShippedHeights) {
    for (const auto& jump : ShippedJumps(height)) {
      EXPECT_EQ(FaultOf(*jump, false), "") << jump->task.distance << " m by " << height << " m";
    }
  }
}

// Their hands come down at the edge of the ground, and slide.
TEST_F(JumpLibraryTest, SimulationsFollowTheShortestShippedJumpToEachHeight) {
  for (const double height : kShippedHeights) {
    EXPECT_EQ(FaultOf(*ShippedJumps(height).front(), true), "") << height << " m";
  }
}

TEST(ShippedJumpsLong, SimulationsFollowAllOfThem) {
  for (const double height : kShippedHeights) {
    for (const auto& jump : ShippedJumps(height)) {
      EXPECT_EQ(FaultOf(*jump, true), "") << jump->task.distance << " m by " << height << " m";
    }
  }
}

TEST_F(JumpLibraryTest, NoShippedJumpFliesBeyondItsBound) {
  const FlightBounds bounds = BoundFlight(Solver().settings(), Solver().model().units());
  for (const auto& jump : ShippedJumps()) {
    const std::vector<Knot>& flight = jump->phases.at(kFlight).knots;
    const auto place = [](const Knot& knot) -> Vector3d { return knot.q.segment<3>(4); };
    for (const Knot& knot : flight) {
      const Vector3d up = place(knot) - place(flight.front());
      const Vector3d down = place(knot) - place(flight.back());
      EXPECT_LT(std::min(up.head<2>().norm(), down.head<2>().norm()), bounds.range);
      EXPECT_LT(std::min(up.z(), down.z()), bounds.rise);
    }
  }
}

/// Motors a tenth weaker, a body 5 % heavier, and ground that rises by 1 degree along the jump.
bool SurvivesAllAtOnce(const JumpSolver& solver, const JumpTask& task) {
  const JumpAnswer answer = solver.Solve(task);
  EXPECT_TRUE(answer.jump) << answer.reason;
  if (!answer.jump) return false;
  Perturbation perturbation;
  perturbation.torque = 0.9;
  perturbation.mass = 1.05;
  perturbation.slope = std::numbers::pi / 180;
  Plan plan;
  plan.segments = {{"jump", answer.jump->phases}};
  const models::GroundMap ground(BareGround(solver.model(), task.distance, task.height, 0.01),
                                 GearedDrcHubo1().friction);
  for (const DynamicStretch& stretch : DynamicStretches(plan)) {
    if (!RollOutPerturbed(stretch.motion, GearedDrcHubo1(), ground, perturbation).survives()) {
      return false;
    }
  }
  return true;
}

const JumpTask kLongJump = {0.85, 0};

TEST(GearedJumpTest, ALongJumpSurvivesWeakMotorsAHeavyBodyAndASlope) {
  const JumpSolver solver(GearedDrcHubo1(), Stance("walk"), Stance("crawl"));
  EXPECT_TRUE(SurvivesAllAtOnce(solver, kLongJump));
}

/// Greatest share of a joint's torque between the impact and the touchdown of the hands.
double TorqueToSettleWith(const JumpSettings& settings) {
  const models::RobotModel& robot = GearedDrcHubo1();
  const JumpAnswer answer =
      JumpSolver(robot, Stance("walk"), Stance("crawl"), settings).Solve(kLongJump);
  EXPECT_TRUE(answer.jump) << answer.reason;
  double share = 0;
  if (!answer.jump) return share;
  for (const Knot& knot : answer.jump->phases.at(kSettle).knots) {
    for (int j = 0; j < robot.num_joints(); ++j) {
      share = std::max(share, std::abs(knot.tau[j]) / robot.joints[j].effort);
    }
  }
  return share;
}

TEST(GearedJumpTest, ALongJumpKeepsTorqueToSettleWith) {
  JumpSettings settings = JumpSettings::For(GearedDrcHubo1(), Stance("walk"), Stance("crawl"));
  const double kept = TorqueToSettleWith(settings);
  // In the plane 0.75; the whole robot is not quite symmetric.
  EXPECT_LT(kept, 0.85);
  settings.settling_torque = 1;
  EXPECT_GT(TorqueToSettleWith(settings), kept + 0.05);
}

TEST(GearedJumpTest, TheTorqueToSettleWithBelongsToTheIdentityWhereItLimits) {
  JumpSettings settings = JumpSettings::For(GearedDrcHubo1(), Stance("walk"), Stance("crawl"));
  ASSERT_LT(settings.settling_torque, settings.limits.torque_fraction);
  const std::string identity = JumpIdentity(GearedDrcHubo1(), settings, "walk", "crawl");
  settings.settling_torque *= 0.9;
  EXPECT_NE(JumpIdentity(GearedDrcHubo1(), settings, "walk", "crawl"), identity);
  EXPECT_EQ(JumpSettings::For(DrcHubo1(), Stance("walk"), Stance("crawl")).settling_torque, 1);
}

TEST(BareGroundTest, LandingGroundReachesFartherButNotIntoTheLaunchGround) {
  const auto begin = [](double distance, double farther) {
    const models::Obstacle landing =
        BareGround(Solver().model(), distance, 0.1, farther).obstacles.at(1);
    return landing.X_WO.translation().x() - 10;  // m: floors are 20 m long
  };
  const double launch_end =
      BareGround(Solver().model(), 0.6, 0.1).obstacles.at(0).X_WO.translation().x() + 10;
  EXPECT_NEAR(begin(0.6, 0.01), begin(0.6, 0) - 0.01, 1e-12);
  EXPECT_GT(begin(0.6, 0.01), launch_end);
  EXPECT_NEAR(begin(0.6, 1), launch_end, 1e-12);
}

TEST(JumpReachTest, BetweenTwoHeightsTheReachOfEitherIsAllowed) {
  const JumpReach reach{{{-0.1, 0.3, 0.8}, {0.1, 0.4, 0.9}, {0.2, 1, 0}}};
  EXPECT_TRUE(reach.Allows({0.3, 0}));
  EXPECT_TRUE(reach.Allows({0.9, 0}));
  EXPECT_FALSE(reach.Allows({0.95, 0}));
  EXPECT_TRUE(reach.Allows({0.9, 0.15}));
  EXPECT_FALSE(reach.Allows({0.5, 0.2}));
  EXPECT_FALSE(reach.Allows({0.5, 0.3}));
  EXPECT_FALSE(reach.Allows({0.5, -0.2}));
}

}  // namespace
}  // namespace possibility::actions
