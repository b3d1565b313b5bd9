#include "actions/jump/long_jump.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "actions/conditions/exploration_pose.h"
#include "actions/jump/jump_reach.h"
#include "actions/jump/shared_jump_solve.h"
#include "actions/motion/phase_sequence.h"
#include "actions/wholebody/motion_error.h"
#include "models/robot/rotors.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;

/// Headings agree when closer than this, rad.
constexpr double kSameHeading = 1e-6;

/// Spacing of apexes and of points of parabolas that C_N tests, m.
constexpr double kRiseSpacing = 0.05;
constexpr double kArcSpacing = 0.05;

/// Ground that the bearing points at both ends of a jump keep around them where the robot's reach
/// allows, m; how far and how finely ends are moved for that, m.
constexpr double kWideEnds = 0.05;
constexpr double kFarthestMove = 0.2;
constexpr int kMoves = 10;

/// A jump of a robot whose rotors are known may be so much shorter without hitting anything, m: on
/// ground that rises by 1 degree a flight of 0.4 s ends 16 mm early, and 10 mm beyond an edge a
/// sole still catches on it.
constexpr double kShorter = 0.03;

/// Ground that extends this far to all sides of the stance's frame is wide enough for it, m.
double WideGround(const NominalStance& stance) {
  double farthest = 0;
  for (const std::vector<Vector2d>& points : stance.bearing_points) {
    for (const Vector2d& point : points) farthest = std::max(farthest, point.norm());
  }
  return farthest + kWideEnds;
}

bool SameTask(const JumpTask& a, const JumpTask& b) {
  return std::abs(a.distance - b.distance) < kSamePose && std::abs(a.height - b.height) < kSamePose;
}

std::vector<Phase> InTheAir(const std::vector<Phase>& motion) {
  std::vector<Phase> flight;
  std::copy_if(motion.begin(), motion.end(), std::back_inserter(flight),
               [](const Phase& phase) { return phase.contacts.empty(); });
  return flight;
}

/// Rises from any level to any other, on the library's grid, ascending.
std::vector<double> RisesOf(const std::vector<double>& levels) {
  std::vector<double> rises;
  for (const double from : levels) {
    for (const double to : levels) rises.push_back(JumpLibrary::OnGrid({0, to - from}).height);
  }
  std::sort(rises.begin(), rises.end());
  rises.erase(std::unique(rises.begin(), rises.end()), rises.end());
  return rises;
}

}  // namespace

LongJump::~LongJump() = default;

/// Solves the jump unless it is known, then checks it for collisions at its place.
class LongJump::Job : public graph::ConfirmationJob {
 public:
  Job(const LongJump& action, const Leap& leap) : action_(action), leap_(leap) {}

  graph::JobVerdict Run(graph::JobControl* control) override {
    const std::optional<JumpAnswer> answer = action_.SolveOf(leap_.task)->Await(control);
    if (!answer || answer->cancelled) return graph::JobVerdict::kUndecided;
    if (answer->jump) return Place(answer->jump, control);
    action_.RecordImpossible(leap_.task);
    return Decide(false, answer->reason);
  }

  std::string reason() const override { return reason_; }

 private:
  graph::JobVerdict Place(std::shared_ptr<const SolvedJump> jump, graph::JobControl* control) {
    const Solved solved = action_.Examined(std::move(jump));
    std::string hit =
        FirstHit(*action_.model().robot, *action_.world().environment, *action_.checker(),
                 *solved.poses, leap_.launch.pose.At(leap_.launch.z), control->token());
    if (hit.empty()) hit = HitIfShorter(solved, control->token());
    if (!control->Checkpoint()) return graph::JobVerdict::kUndecided;
    if (!hit.empty()) action_.RecordRefuted(leap_);
    return Decide(hit.empty(), hit);
  }

  /// Of a robot whose rotors are known: what it hits if it flies less far than planned.
  std::string HitIfShorter(const Solved& solved, const CancellationToken& cancellation) const {
    const models::RobotModel& robot = *action_.model().robot;
    if (!models::HasRotors(robot)) return {};
    const PlanarPose behind = leap_.launch.pose * PlanarPose{-kShorter, 0, 0};
    std::string hit = FirstHit(robot, *action_.world().environment, *action_.checker(),
                               *solved.flight, behind.At(leap_.launch.z), cancellation);
    return hit.empty() ? hit : fmt::format("if it flies {} m less far, {}", kShorter, hit);
  }

  graph::JobVerdict Decide(bool possible, const std::string& reason) {
    reason_ = reason;
    return possible ? graph::JobVerdict::kConfirmed : graph::JobVerdict::kRefuted;
  }

  const LongJump& action_;
  Leap leap_;
  std::string reason_;
};

LongJump::LongJump(const PlanningContext& context, const models::Jump& jump)
    : Manoeuvre(context, jump.name, context.model->GaitIndex(jump.from),
                context.model->GaitIndex(jump.to)),
      solver_(std::make_unique<JumpSolver>(*model().robot, model().gaits[from()]->stance,
                                           model().gaits[to()]->stance)),
      library_(std::make_unique<JumpLibrary>(
          *solver_, context.library,
          context.solved_motions ? JumpLibrary::Use::kAll : JumpLibrary::Use::kReachAlone)),
      reach_(library_->reach_is_derived()
                 ? library_->reach()
                 : GuessReach(*solver_, RisesOf(world().ground->levels()))),
      wide_ground_(std::max(WideGround(model().gaits[from()]->stance),
                            WideGround(model().gaits[to()]->stance))),
      highest_rise_(BoundFlight(solver_->settings(), solver_->model().units()).rise),
      pelvis_checker_(*world().environment),
      pelvis_(*model().robot, pelvis_checker_) {
  for (const LocomotionModel::TransitionEntry& transition : model().transitions) {
    if (transition.from == from() && transition.to == to()) transition_ = &transition;
  }
  const auto add = [this](const std::vector<Eigen::AlignedBox3d>& boxes, double x) {
    for (const Eigen::AlignedBox3d& box : boxes) {
      room_.extend(box.translated(Eigen::Vector3d(x, 0, 0)));
    }
  };
  add(model().gaits[from()]->volumes.sweep(StrideClass::kStraight), 0);
  add(model().gaits[to()]->volumes.sweep(StrideClass::kStraight), 0);
  if (transition_ != nullptr) add(transition_->sweep, -transition_->displacement.x);
}

bool LongJump::GroundIsWide(const GroundedStance& launch, double begin, double end) const {
  const Vector2d middle = launch.pose * Vector2d((begin + end) / 2, 0);
  const std::optional<int> level = world().ground->LevelAt(middle, launch.z, kSamePose);
  if (!level) return false;
  const double half = (end - begin) / 2;
  const double clearance = world().ground->Clearance(*level, middle);
  if (clearance >= half + wide_ground_) return true;
  // Halving would never end along a boundary exactly at the limit.
  if (clearance < wide_ground_ || half < kSamePose) return false;
  return GroundIsWide(launch, begin, begin + half) && GroundIsWide(launch, begin + half, end);
}

bool LongJump::WayIsOpen(const GroundedStance& launch, double distance) const {
  const double begin = -wide_ground_;
  const double end = distance + wide_ground_;
  const std::optional<int> level =
      world().ground->LevelAt(launch.pose.position(), launch.z, kSamePose);
  if (!level) return false;
  const bool one_face_holds = world().ground->OneFaceHolds(
      *level, launch.pose * Vector2d(begin, 0), launch.pose * Vector2d(end, 0), wide_ground_);
  if (!one_face_holds && !GroundIsWide(launch, begin, end)) return false;
  Eigen::AlignedBox3d box = room_;
  box.extend(room_.translated(Eigen::Vector3d(distance, 0, 0)));
  Isometry3d X_SB = Isometry3d::Identity();
  X_SB.translation() = box.center();
  return pelvis_checker_.IsFree(models::Shape::Box(box.sizes()), launch.pose.At(launch.z) * X_SB,
                                0);
}

bool LongJump::IsNeedless(const GroundedStance& launch, const GroundedStance& landing) const {
  if (std::abs(launch.z - landing.z) > kSamePose) return false;
  if (from() == to()) return launch_gait().CS(launch, landing);
  if (transition_ == nullptr) return false;
  const double distance = (landing.pose.position() - launch.pose.position()).norm();
  if (WayIsOpen(launch, distance)) return true;
  const PlanarPose& displacement = transition_->displacement;
  GroundedStance standing = launch;
  standing.pose = landing.pose * displacement.Inverse();
  GroundedStance sitting = landing;
  sitting.pose = launch.pose * displacement;
  const graph::Point a = PointOf(launch);
  const graph::Point b = PointOf(landing);
  const auto way = [&](const QuasiStaticAction& first, const graph::Point& via,
                       const QuasiStaticAction& second) {
    return first.CS(graph::Edge{a, via}) && second.CS(graph::Edge{via, b});
  };
  return way(launch_gait(), PointOf(standing), landing_gait()) ||
         way(landing_gait(), PointOf(sitting), landing_gait());
}

std::optional<GroundedStance> LongJump::OtherEnd(const GroundedStance& stance, double distance,
                                                 bool forward) const {
  const QuasiStaticAction& gait = forward ? landing_gait() : launch_gait();
  std::optional<GroundedStance> best;
  double longest = 0;
  bool is_wide = false;
  for (const double level : world().ground->levels()) {
    const double height = forward ? level - stance.z : stance.z - level;
    const auto reach = reach_.Distances(JumpLibrary::OnGrid({0, height}).height);
    if (!reach) continue;
    const double limit = std::min(distance, reach->second) + kSamePose;
    for (int i = static_cast<int>(limit / JumpLibrary::kDistanceStep);; --i) {
      const double d = i * JumpLibrary::kDistanceStep;
      if (d < reach->first - kSamePose || (is_wide && d <= longest)) break;
      const GroundedStance end{forward ? to() : from(),
                               stance.pose * PlanarPose{forward ? d : -d, 0, 0}, level};
      const bool counts = d > longest && !is_wide;
      if (!gait.GroundHolds(end, 0) || IsImpossible(JumpLibrary::OnGrid({d, height}))) continue;
      const bool wide = gait.GroundHolds(end, kWideEnds);
      if (!wide && !counts) continue;
      best = end;
      longest = d;
      is_wide = wide;
      if (wide) break;
    }
  }
  return best;
}

graph::Point LongJump::ExtendTowards(const graph::Point& v0, const graph::Point& v1) const {
  const std::optional<GroundedStance> launch = LaunchStance(v0);
  if (!launch) return v0;
  const Vector2d ahead = launch->pose.Inverse() * Vector2d(v1.head<2>());
  const std::optional<GroundedStance> landing = OtherEnd(*launch, ahead.x(), true);
  return landing ? PointOf(*landing) : v0;
}

graph::Point LongJump::ReverseExtend(const graph::Point& v0, const graph::Point& v1) const {
  const std::optional<GroundedStance> landing = LandingStance(v0);
  if (!landing) return v0;
  const Vector2d ahead = landing->pose.Inverse() * Vector2d(v1.head<2>());
  const std::optional<GroundedStance> launch = OtherEnd(*landing, -ahead.x(), false);
  return launch ? PointOf(*launch) : v0;
}

std::optional<graph::Point> LongJump::FindLaunchPoint(const graph::Point& v,
                                                      const graph::Point& v1) const {
  return LinedUp(v, (v1 - v).head<2>(), true);
}

std::optional<graph::Point> LongJump::FindLandingPoint(const graph::Point& v,
                                                       const graph::Point& v1) const {
  return LinedUp(v, (v - v1).head<2>(), false);
}

std::optional<graph::Point> LongJump::LinedUp(const graph::Point& v, const Vector2d& way,
                                              bool launches) const {
  std::optional<GroundedStance> stance = launches ? LaunchStance(v) : LandingStance(v);
  if (!stance || way.norm() < JumpLibrary::kDistanceStep) return std::nullopt;
  const double heading = std::atan2(way.y(), way.x());
  const bool is_lined_up = std::abs(WrapAngle(heading - stance->pose.yaw)) < kSameHeading;
  if (!is_lined_up) stance->pose.yaw = heading;
  // Algorithm 4 asks this for every vertex, so the cheapest test comes first.
  const std::optional<GroundedStance> other = OtherEnd(*stance, way.norm(), launches);
  if (!other) return std::nullopt;
  const GroundedStance& launch = launches ? *stance : *other;
  const GroundedStance& landing = launches ? *other : *stance;
  if (IsNeedless(launch, landing)) return std::nullopt;
  const double distance = (landing.pose.position() - launch.pose.position()).norm();
  if (const std::optional<Leap> wide =
          Widened({launch, landing, JumpLibrary::OnGrid({distance, landing.z - launch.z})})) {
    const GroundedStance& moved = launches ? wide->launch : wide->landing;
    // Not to be moved: then the other end of the wide jump lies beyond the way.
    if ((moved.pose.position() - stance->pose.position()).norm() < kSamePose) return std::nullopt;
    return PointOf(moved);
  }
  return is_lined_up ? v : PointOf(*stance);
}

GroundedStance LongJump::Moved(GroundedStance stance, int move) {
  stance.pose = stance.pose * PlanarPose{move * kFarthestMove / kMoves, 0, 0};
  return stance;
}

std::optional<LongJump::Leap> LongJump::Widened(const Leap& leap) const {
  if (launch_gait().GroundHolds(leap.launch, kWideEnds) &&
      landing_gait().GroundHolds(leap.landing, kWideEnds)) {
    return std::nullopt;
  }
  std::vector<int> moves;
  for (int move = -kMoves; move <= kMoves; ++move) {
    const GroundedStance launch = Moved(leap.launch, move);
    if (launch_gait().GroundHolds(launch, kWideEnds) && launch_gait().CS(leap.launch, launch)) {
      moves.push_back(move);
    }
  }
  const auto steps = static_cast<int>(2 * kFarthestMove / JumpLibrary::kDistanceStep);
  for (int i = 0; i <= 2 * steps && !moves.empty(); ++i) {
    // Similar distances first, longer before shorter ones.
    const int change = i % 2 == 0 ? -i / 2 : (i + 1) / 2;
    const JumpTask task = JumpLibrary::OnGrid(
        {leap.task.distance + change * JumpLibrary::kDistanceStep, leap.task.height});
    if (!reach_.Allows(task) || IsImpossible(task)) continue;
    if (std::optional<Leap> wide = WidenedTo(leap, task, moves)) return wide;
  }
  return std::nullopt;
}

/// The middle of the first run of moves that are wide enough.
std::optional<LongJump::Leap> LongJump::WidenedTo(const Leap& leap, const JumpTask& task,
                                                  const std::vector<int>& moves) const {
  const auto moved = [&](int move) {
    Leap wide = leap;
    wide.task = task;
    wide.launch = Moved(leap.launch, move);
    wide.landing.pose = wide.launch.pose * PlanarPose{task.distance, 0, 0};
    return wide;
  };
  std::vector<int> run;
  for (const int move : moves) {
    const Leap wide = moved(move);
    const bool serves = landing_gait().GroundHolds(wide.landing, kWideEnds) && !IsRefuted(wide) &&
                        LandingsConnect(wide.landing, leap.landing);
    if (!run.empty() && (!serves || move > run.back() + 1)) break;
    if (serves) run.push_back(move);
  }
  if (run.empty()) return std::nullopt;
  Leap wide = moved(run[run.size() / 2]);
  if (!SomeParabolaIsFree({PointOf(wide.launch), PointOf(wide.landing)})) return std::nullopt;
  return wide;
}

bool LongJump::LandingsConnect(const GroundedStance& from, const GroundedStance& to) const {
  if (landing_gait().CS(from, to)) return true;
  if (transition_ == nullptr) return false;
  const auto standing = [this](GroundedStance landing) {
    landing.gait = this->from();
    landing.pose = landing.pose * transition_->displacement.Inverse();
    return landing;
  };
  const GroundedStance stand = standing(from);
  return landing_gait().CS(graph::Edge{PointOf(from), PointOf(stand)}) &&
         launch_gait().CS(stand, standing(to));
}

std::optional<LongJump::Leap> LongJump::AsLeap(const graph::Edge& edge) const {
  const std::optional<GroundedStance> launch = LaunchStance(edge.from);
  const std::optional<GroundedStance> landing = LandingStance(edge.to);
  if (!launch || !landing) return std::nullopt;
  const PlanarPose ahead = launch->pose.Inverse() * landing->pose;
  const JumpTask exact{ahead.x, landing->z - launch->z};
  const JumpTask task = JumpLibrary::OnGrid(exact);
  if (!SameTask(task, exact) || std::abs(ahead.y) > kSamePose ||
      std::abs(WrapAngle(ahead.yaw)) > kSameHeading) {
    return std::nullopt;
  }
  return Leap{*launch, *landing, task};
}

bool LongJump::CN(const graph::Edge& edge) const {
  const std::optional<Leap> leap = AsLeap(edge);
  return leap && reach_.Allows(leap->task) && landing_gait().CS(edge.to) &&
         launch_gait().CS(edge.from) && SomeParabolaIsFree(edge);
}

bool LongJump::SomeParabolaIsFree(const graph::Edge& edge) const {
  const int steps = static_cast<int>(highest_rise_ / kRiseSpacing);
  for (int i = 0; i <= steps; ++i) {
    if (ParabolaIsFree(edge, i * kRiseSpacing)) return true;
  }
  return false;
}

bool LongJump::ParabolaIsFree(const graph::Edge& edge, double rise) const {
  const Isometry3d from = ToPose(edge.from);
  const Isometry3d to = ToPose(edge.to);
  const double length = (to.translation() - from.translation()).norm() + 2 * rise;
  const int samples = 1 + static_cast<int>(length / kArcSpacing);
  for (int i = 1; i < samples; ++i) {
    const double s = static_cast<double>(i) / samples;
    Isometry3d X_WR = Interpolate(from, to, s);
    X_WR.translation().z() += 4 * rise * s * (1 - s);
    if (!pelvis_.IsFree(X_WR)) return false;
  }
  return true;
}

bool LongJump::Explorable(const graph::Edge& edge) const {
  const std::optional<Leap> leap = AsLeap(edge);
  if (!leap || IsImpossible(leap->task) || IsNeedless(leap->launch, leap->landing)) return false;
  return Manoeuvre::Explorable(edge) && !Widened(*leap);
}

double LongJump::ExpectedDuration(const graph::Edge& edge) const {
  const std::optional<Leap> leap = AsLeap(edge);
  const double rest_time = model().gaits[from()]->motion->RestTime();
  const std::lock_guard lock(mutex_);
  for (const Solved& solved : solved_) {
    if (leap && SameTask(solved.jump->task, leap->task)) {
      return rest_time + solved.jump->duration() - solved.jump->preparation;
    }
  }
  return rest_time + kNominalDuration;
}

double LongJump::GreatestSpeed() const {
  const double beyond = transition_ ? transition_->displacement.position().norm() : 0;
  double greatest = 0;
  for (const double height : RisesOf(world().ground->levels())) {
    const auto distances = reach_.Distances(height);
    if (!distances) continue;
    for (double distance = distances->first;
         distance < distances->second + JumpLibrary::kDistanceStep / 2;
         distance += JumpLibrary::kDistanceStep) {
      const std::optional<JumpAnswer> answer =
          library_->Find(JumpLibrary::OnGrid({distance, height}));
      if (!answer || !answer->jump) continue;
      const double seconds = answer->jump->duration() - answer->jump->preparation;
      greatest = std::max(greatest, (distance + beyond) / seconds);
    }
  }
  return greatest;
}

std::unique_ptr<graph::ConfirmationJob> LongJump::SpawnConfirmationJob(
    const graph::Edge& edge) const {
  const std::optional<Leap> leap = AsLeap(edge);
  if (!leap || !CN(edge)) return nullptr;
  return std::make_unique<Job>(*this, *leap);
}

std::vector<Phase> LongJump::Motion(const graph::Edge& edge, const CancellationToken&) const {
  const std::optional<Leap> leap = AsLeap(edge);
  if (!leap) throw MotionError("not a jump between nominal stances");
  const std::optional<JumpAnswer> answer = library_->Find(leap->task);
  if (!answer || !answer->jump) throw MotionError("the jump is not in the library");
  return Placed(answer->jump->phases, leap->launch.pose, leap->launch.z);
}

ManoeuvreBounds LongJump::Bounds() const {
  ManoeuvreBounds bounds;
  bounds.landings = [reach = reach_](double rise) -> std::optional<LandingRange> {
    const auto distances = reach.Distances(JumpLibrary::OnGrid({0, rise}).height);
    if (!distances) return std::nullopt;
    // The lower bound is 0: shorter jumps connect only what walking connects.
    return LandingRange{{Vector2d::Zero(), Vector2d(distances->second, 0)}};
  };
  bounds.flight = BoundFlight(solver_->settings(), solver_->model().units());
  return bounds;
}

bool LongJump::ReplaceGuesses(const CancellationToken& cancellation) {
  if (library_->reach_is_derived()) return false;
  reach_ = DeriveFarthest(reach_, library_.get(), cancellation);
  return true;
}

void LongJump::RefuteEverywhere(const graph::Edge& edge) {
  if (const std::optional<Leap> leap = AsLeap(edge)) RecordImpossible(leap->task);
}

void LongJump::RecordRefuted(const Leap& leap) const {
  const std::lock_guard lock(mutex_);
  refuted_.push_back(leap);
}

bool LongJump::IsRefuted(const Leap& leap) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(refuted_.begin(), refuted_.end(), [&](const Leap& other) {
    return SameTask(leap.task, other.task) &&
           std::abs(leap.launch.z - other.launch.z) < kSamePose &&
           (leap.launch.pose.position() - other.launch.pose.position()).norm() < kSamePose &&
           std::abs(WrapAngle(leap.launch.pose.yaw - other.launch.pose.yaw)) < kSameHeading;
  });
}

void LongJump::RecordImpossible(const JumpTask& task) const {
  const std::lock_guard lock(mutex_);
  impossible_.push_back(task);
}

bool LongJump::IsImpossible(const JumpTask& task) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(impossible_.begin(), impossible_.end(),
                     [&](const JumpTask& other) { return SameTask(task, other); });
}

std::shared_ptr<SharedJumpSolve> LongJump::SolveOf(const JumpTask& task) const {
  const std::lock_guard lock(mutex_);
  for (const auto& solve : solves_) {
    if (SameTask(solve->task(), task)) return solve;
  }
  return solves_.emplace_back(std::make_shared<SharedJumpSolve>(library_.get(), task));
}

LongJump::Solved LongJump::Examined(std::shared_ptr<const SolvedJump> jump) const {
  {
    const std::lock_guard lock(mutex_);
    for (const Solved& solved : solved_) {
      if (solved.jump == jump) return solved;
    }
  }
  const auto poses = std::make_shared<const MotionPoses>(*model().robot, jump->phases);
  const auto flight = std::make_shared<const MotionPoses>(*model().robot, InTheAir(jump->phases));
  const std::lock_guard lock(mutex_);
  return solved_.emplace_back(Solved{std::move(jump), poses, flight});
}

std::vector<ManoeuvreFactory> JumpFactories(const models::RobotModel& robot, double skip_growth) {
  std::vector<ManoeuvreFactory> factories;
  for (const models::Jump& jump : robot.jumps) {
    factories.push_back({jump.name,
                         [jump](const PlanningContext& context) {
                           return std::make_shared<LongJump>(context, jump);
                         },
                         skip_growth});
  }
  return factories;
}

}  // namespace possibility::actions
