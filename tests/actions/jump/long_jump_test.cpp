#include "actions/jump/long_jump.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <optional>
#include <stop_token>
#include <thread>
#include <vector>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/searched_manoeuvre.h"
#include "actions/jump/jump_reach.h"
#include "graph/confirmation/confirmation_queue.h"
#include "models/world/ground_map.h"
#include "tests/actions/geared_drchubo1.h"

namespace possibility::actions {
namespace {

/// Two floors with a gap between x = 0 and `gap`, and the obstacles on them.
models::Environment TwoFloors(double gap, const std::vector<models::Obstacle>& obstacles = {}) {
  models::Environment environment;
  environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-4, -3), Eigen::Vector2d(4, 3));
  for (const double side : {-1.0, 1.0}) {
    models::Obstacle floor;
    floor.name = side < 0 ? "near" : "far";
    floor.shape = models::Shape::Box({4, 6, 0.5});
    floor.X_WO.translation() << 2 * side + (side > 0 ? gap : 0), 0, -0.25;
    floor.is_ground = true;
    environment.obstacles.push_back(floor);
  }
  environment.obstacles.insert(environment.obstacles.end(), obstacles.begin(), obstacles.end());
  return environment;
}

/// A beam above the head of a walking robot, but not of a jumping one.
models::Obstacle Beam() {
  models::Obstacle beam;
  beam.name = "beam";
  beam.shape = models::Shape::Box({0.04, 6, 0.04});
  beam.X_WO.translation() << 0.1, 0, 1.2;
  return beam;
}

models::Obstacle Wall(double x, double height) {
  models::Obstacle wall;
  wall.name = "wall";
  wall.shape = models::Shape::Box({0.05, 6, height});
  wall.X_WO.translation() << x, 0, height / 2;
  return wall;
}

class JumpScene {
 public:
  /// `jump`: of the robot's file.
  explicit JumpScene(models::Environment environment, int jump = 0,
                     const LocomotionModel& model = Model())
      : environment_(std::move(environment)),
        ground_(environment_),
        world_{&environment_, &ground_},
        space_(std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_.levels(), 0.137)) {
    for (int gait = 0; gait < 2; ++gait) {
      gaits_.push_back(std::make_shared<QuasiStaticAction>(model, gait, world_, space_, 0.25));
    }
    PlanningContext context;
    context.model = &model;
    context.world = world_;
    context.gaits = gaits_;
    context.space = space_;
    jump_ = std::make_shared<LongJump>(context, DrcHubo1().jumps.at(jump));
    searched_ = std::make_unique<SearchedManoeuvre>(jump_);
  }

  static const LocomotionModel& Model() { return DrcHubo1Locomotion(); }

  const LongJump& jump() const { return *jump_; }
  /// The jump with its verdicts.
  const SearchedManoeuvre& searched() const { return *searched_; }
  SearchedManoeuvre* mutable_searched() { return searched_.get(); }

  static graph::Point At(int gait, double x, double y, double yaw, double z = 0) {
    return ToPoint(Model().gaits[gait]->stance.RootPose({x, y, yaw}, z));
  }
  static graph::Edge Edge(double x, double distance, double yaw = 0) {
    return {At(0, x, 0, yaw), At(1, x + distance * std::cos(yaw), distance * std::sin(yaw), yaw)};
  }

 private:
  models::Environment environment_;
  models::GroundMap ground_;
  World world_;
  std::shared_ptr<PelvisPoseSpace> space_;
  std::vector<std::shared_ptr<const QuasiStaticAction>> gaits_;
  std::shared_ptr<LongJump> jump_;
  std::unique_ptr<SearchedManoeuvre> searched_;
};

constexpr double kGap = 0.3;

TEST(LongJumpTest, NecessaryConditionsHoldAcrossAGap) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Edge edge = JumpScene::Edge(-0.2, 0.8);
  EXPECT_TRUE(scene.jump().CN(edge));
  EXPECT_TRUE(scene.jump().Explorable(edge));
  EXPECT_FALSE(scene.jump().CS(edge)) << "nobody has confirmed it";
  EXPECT_TRUE(scene.jump().CN(edge.from));
  EXPECT_TRUE(scene.jump().CN(edge.to));
}

TEST(LongJumpTest, EachUnmetNecessaryConditionRefusesTheJump) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Edge good = JumpScene::Edge(-0.2, 0.75);
  EXPECT_FALSE(scene.jump().CN(JumpScene::Edge(-0.1, 0.75))) << "toes over the edge";
  EXPECT_FALSE(scene.jump().CN(JumpScene::Edge(-0.3, 0.75))) << "pegs in the gap";
  EXPECT_FALSE(scene.jump().CN(JumpScene::Edge(-0.2, 0.76))) << "off the grid";
  EXPECT_FALSE(scene.jump().CN(JumpScene::Edge(-0.2, 1.5))) << "out of reach";
  EXPECT_FALSE(scene.jump().CN(graph::Edge{good.to, good.from})) << "backwards";
  EXPECT_FALSE(scene.jump().CN(graph::Edge{good.from, JumpScene::At(1, 0.55, 0.01, 0)}))
      << "to the side";
  EXPECT_FALSE(scene.jump().CN(graph::Edge{good.from, JumpScene::At(1, 0.55, 0, 0.1)}))
      << "turning";
}

TEST(LongJumpTest, AJumpThroughAWallIsRefused) {
  EXPECT_FALSE(JumpScene(TwoFloors(kGap, {Wall(0.15, 5)})).jump().CN(JumpScene::Edge(-0.2, 0.9)));
}

TEST(LongJumpTest, OverGroundThatCanBeWalkedNoJumpIsExplored) {
  const JumpScene scene(TwoFloors(0));
  const graph::Edge edge = JumpScene::Edge(-0.2, 0.75);
  EXPECT_TRUE(scene.jump().CN(edge));
  EXPECT_FALSE(scene.jump().Explorable(edge));
  EXPECT_FALSE(scene.jump().FindLaunchPoint(edge.from, edge.to).has_value());
}

/// From walking stance to walking stance, where walking straight on takes the leap's place.
TEST(LongJumpTest, ALeapIsExploredAcrossAGapOnly) {
  constexpr int kLeap = 1;
  const graph::Edge edge = {JumpScene::At(0, -0.3, 0, 0), JumpScene::At(0, 0.6, 0, 0)};
  const JumpScene gap(TwoFloors(0.4), kLeap);
  EXPECT_TRUE(gap.jump().Explorable(edge));
  EXPECT_FALSE(gap.jump().Explorable(graph::Edge{edge.to, edge.from})) << "backwards";
  EXPECT_TRUE(gap.jump().FindLaunchPoint(edge.from, edge.to).has_value());
  const JumpScene floor(TwoFloors(0), kLeap);
  EXPECT_TRUE(floor.jump().CN(edge));
  EXPECT_FALSE(floor.jump().Explorable(edge));
  EXPECT_FALSE(floor.jump().FindLaunchPoint(edge.from, edge.to).has_value());
}

TEST(LongJumpTest, ExtensionsFaceTheTargetAndStayOnTheGrid) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Point v = JumpScene::At(0, -0.2, 0.1, 2);
  const graph::Point target = JumpScene::At(0, 2, 0.3, 1);
  const auto launch = scene.jump().FindLaunchPoint(v, target);
  ASSERT_TRUE(launch.has_value());
  const double heading = std::atan2(0.2, 2.2);
  const Eigen::Vector2d moved = (*launch - v).head<2>();
  EXPECT_LE(moved.norm(), 0.2);
  EXPECT_NEAR(moved.y() * std::cos(heading) - moved.x() * std::sin(heading), 0, 1e-9);
  EXPECT_NEAR(Heading(ToPose(*launch).linear()), heading, 1e-9);
  const graph::Point landing = scene.jump().ExtendTowards(*launch, target);
  EXPECT_TRUE(scene.jump().CN(graph::Edge{*launch, landing}));
  const double distance = (landing - *launch).head<2>().norm();
  EXPECT_NEAR(std::remainder(distance, JumpLibrary::kDistanceStep), 0, 1e-9);
  EXPECT_EQ(scene.jump().FindLaunchPoint(*launch, target), *launch) << "lined up already";
}

TEST(LongJumpTest, ReverseExtensionsComeFromTheTarget) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Point v = JumpScene::At(1, 0.6, 0, 2);
  const graph::Point target = JumpScene::At(0, -2, 0.1, 1);
  const auto landing = scene.jump().FindLandingPoint(v, target);
  ASSERT_TRUE(landing.has_value());
  const graph::Point launch = scene.jump().ReverseExtend(*landing, target);
  EXPECT_TRUE(scene.jump().CN(graph::Edge{launch, *landing}));
}

/// m: ground around the bearing points of both ends. Their places on the way are those of the gap's
/// edges in TwoFloors.
double EdgeMargin(const graph::Edge& edge, double gap) {
  double margin = std::numeric_limits<double>::infinity();
  for (const bool launches : {true, false}) {
    const NominalStance& stance = JumpScene::Model().gaits[launches ? 0 : 1]->stance;
    const double x = (launches ? edge.from : edge.to).x() - stance.X_SR.translation().x();
    for (const auto& points : stance.bearing_points) {
      for (const Eigen::Vector2d& p : points) {
        margin = std::min(margin, launches ? -(x + p.x()) : x + p.x() - gap);
      }
    }
  }
  return margin;
}

TEST(LongJumpTest, EndsAreMovedAwayFromTheEdgesOfTheGround) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Point target = JumpScene::At(1, 1.5, 0, 0);
  // From -0.21 m no jump on the grid of 0.05 m keeps 50 mm at both ends without a move.
  for (const double x : {-0.145, -0.16, -0.18, -0.21, -0.25}) {
    const auto launch = scene.jump().FindLaunchPoint(JumpScene::At(0, x, 0, 0), target);
    ASSERT_TRUE(launch) << x;
    const graph::Edge edge{*launch, scene.jump().ExtendTowards(*launch, target)};
    EXPECT_GE(EdgeMargin(edge, kGap), 0.05 - 1e-9) << x;
    EXPECT_TRUE(scene.jump().CN(edge)) << x;
    EXPECT_TRUE(scene.jump().Explorable(edge)) << x;
    EXPECT_EQ(scene.jump().FindLaunchPoint(*launch, target), *launch) << x;
  }
}

TEST(LongJumpTest, AThinLandingIsExploredOnlyWhereReachAllowsNoWideOne) {
  const graph::Edge thin = JumpScene::Edge(-0.16, 0.75);
  EXPECT_LT(EdgeMargin(thin, kGap), 0.05);
  const JumpScene scene(TwoFloors(kGap));
  EXPECT_TRUE(scene.jump().CN(thin));
  EXPECT_FALSE(scene.jump().Explorable(thin));
  // A gap that leaves no room for 50 mm at both ends of the longest jump.
  const double farthest = scene.jump().reach().Distances(0)->second;
  const double shortest_ends = -EdgeMargin(JumpScene::Edge(0, 0), 0);
  ASSERT_GT(shortest_ends, 0);
  bool found = false;
  for (double gap = kGap; gap < farthest; gap += 0.01) {
    const JumpScene wide(TwoFloors(gap));
    for (double x = -0.3; x < -0.1; x += 0.01) {
      const graph::Edge edge = JumpScene::Edge(x, farthest);
      if (!wide.jump().CN(edge) || EdgeMargin(edge, gap) > 0.02) continue;
      found = found || wide.jump().Explorable(edge);
    }
  }
  EXPECT_TRUE(found);
}

TEST(LongJumpTest, FarFromTheGapNoLaunchIsFound) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Point far = JumpScene::At(0, -2, 0, 0);
  EXPECT_FALSE(scene.jump().FindLaunchPoint(far, JumpScene::At(0, 2, 0, 0)).has_value());
}

TEST(LongJumpTest, TheJobRefutesAJumpIntoABeamWithAReason) {
  JumpScene scene(TwoFloors(kGap, {Beam()}));
  const graph::Edge edge = JumpScene::Edge(-0.2, 0.75);
  ASSERT_TRUE(scene.jump().CN(edge));
  const auto job = scene.searched().SpawnConfirmationJob(edge);
  ASSERT_NE(job, nullptr);
  graph::JobControl control;
  EXPECT_EQ(job->Run(&control), graph::JobVerdict::kRefuted);
  EXPECT_NE(job->reason().find("hits"), std::string::npos) << job->reason();
  EXPECT_FALSE(scene.searched().CS(edge));
  EXPECT_FALSE(scene.searched().Explorable(edge));
  ASSERT_EQ(scene.searched().Refusals().size(), 1u);
  EXPECT_EQ(scene.searched().Refusals().front().reason, job->reason());
}

graph::JobVerdict VerdictOf(const JumpScene& scene, const graph::Edge& edge, std::string* reason) {
  const auto job = scene.searched().SpawnConfirmationJob(edge);
  graph::JobControl control;
  const graph::JobVerdict verdict = job->Run(&control);
  *reason = job->reason();
  return verdict;
}

/// A leap down a step of 0.1 m: its heels pass the edge of the step.
TEST(LongJumpTest, AGearedRobotLeapsOnlyWhereAShorterLeapHitsNothing) {
  constexpr int kLeap = 1;
  models::Environment step = TwoFloors(0);
  step.obstacles[1].X_WO.translation().z() -= 0.1;
  const graph::Edge near = {JumpScene::At(0, -0.15, 0, 0), JumpScene::At(0, 0.15, 0, 0, -0.1)};
  const graph::Edge far = {JumpScene::At(0, -0.15, 0, 0), JumpScene::At(0, 0.35, 0, 0, -0.1)};
  std::string reason;
  const JumpScene scene(step, kLeap);
  EXPECT_EQ(VerdictOf(scene, near, &reason), graph::JobVerdict::kConfirmed) << reason;
  const LocomotionModel geared =
      BuildLocomotionModel(GearedDrcHubo1(), {"walk", "crawl"}, {}, DrcHubo1Library());
  const JumpScene with_rotors(step, kLeap, geared);
  EXPECT_EQ(VerdictOf(with_rotors, near, &reason), graph::JobVerdict::kRefuted);
  EXPECT_NE(reason.find("0.03 m less far"), std::string::npos) << reason;
  EXPECT_EQ(VerdictOf(with_rotors, far, &reason), graph::JobVerdict::kConfirmed) << reason;
}

TEST(LongJumpTest, ACancelledJobIsUndecided) {
  const JumpScene scene(TwoFloors(kGap));
  const graph::Edge edge = JumpScene::Edge(-0.2, 0.8);
  const auto job = scene.searched().SpawnConfirmationJob(edge);
  graph::JobControl control;
  control.Cancel();
  EXPECT_EQ(job->Run(&control), graph::JobVerdict::kUndecided);
  EXPECT_TRUE(scene.searched().Refusals().empty());
  EXPECT_TRUE(scene.searched().Explorable(edge));
}

/// Number of turns of 50 checkpoints in which the jump is solved and placed. `pause`: between
/// turns.
int TurnsOfJump(double distance, std::chrono::milliseconds pause) {
  const JumpScene scene(TwoFloors(kGap));
  // Sanitizers are slow.
  graph::ConfirmationQueue queue({.checkpoints_per_turn = 50, .job_time_limit = 1000});
  queue.Insert(0, scene.jump().SpawnConfirmationJob(JumpScene::Edge(-0.2, distance)), 0);
  int turns = 1;
  for (; !queue.RunTurn(Deadline(1000)); ++turns) std::this_thread::sleep_for(pause);
  const std::vector<graph::JobResult> results = queue.DrainFinished();
  EXPECT_EQ(results.at(0).outcome, graph::JobOutcome::kConfirmed) << results.at(0).reason;
  return turns;
}

TEST(LongJumpTest, WithoutWorkersAJumpTakesTheSameNumberOfTurnsEveryTime) {
  const int turns = TurnsOfJump(0.75, std::chrono::milliseconds(0));
  EXPECT_GT(turns, 3);
  const std::jthread load([](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
    }
  });
  EXPECT_EQ(TurnsOfJump(0.75, std::chrono::milliseconds(20)), turns);
}

TEST(LongJumpTest, AForbiddenJumpIsNeitherConfirmedNorExplored) {
  JumpScene scene(TwoFloors(kGap));
  const graph::Edge edge = JumpScene::Edge(-0.2, 0.8);
  const graph::Edge same_elsewhere = JumpScene::Edge(-0.21, 0.8);
  scene.mutable_searched()->Forbid(edge, "a reason", false);
  EXPECT_FALSE(scene.searched().Explorable(edge));
  EXPECT_FALSE(scene.searched().CS(edge));
  EXPECT_TRUE(scene.searched().Explorable(same_elsewhere));
  scene.mutable_searched()->Forbid(edge, "a reason", true);
  EXPECT_FALSE(scene.searched().Explorable(same_elsewhere));
  EXPECT_TRUE(scene.searched().Explorable(JumpScene::Edge(-0.2, 0.85)));
}

TEST(JumpReachTest, GuessesLieOnTheGrid) {
  const JumpReach reach = GuessReach(JumpScene(TwoFloors(0)).jump().solver(), {-0.1, 0});
  ASSERT_EQ(reach.rows.size(), 2u);
  for (const JumpReach::Row& row : reach.rows) {
    EXPECT_GT(row.shortest, 0);
    EXPECT_GT(row.farthest, row.shortest);
    EXPECT_NEAR(std::remainder(row.farthest, JumpLibrary::kDistanceStep), 0, 1e-9);
  }
}

}  // namespace
}  // namespace possibility::actions
