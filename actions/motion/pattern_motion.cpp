#include "actions/motion/pattern_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "actions/motion/gradual_changes.h"
#include "actions/motion/pendulum_spline.h"
#include "actions/motion/smooth_under.h"
#include "actions/motion/swing_path.h"
#include "actions/wholebody/limb_reach.h"
#include "actions/wholebody/limb_tilt.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/planar_pose.h"
#include "actions/wholebody/required_zero_moment_point.h"
#include "actions/wholebody/support_polygon.h"
#include "actions/wholebody/whole_body_task.h"
#include "dynamics/tree/multibody_dynamics.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

double Heading(const Isometry3d& X) { return std::atan2(X(1, 0), X(0, 0)); }

/// @throws std::invalid_argument unless the limbs can go from rest to rest by the schedule.
void RequireSchedule(const models::RobotModel& robot, const NominalStance& stance,
                     const models::ContactSchedule& schedule) {
  models::CheckContactSchedule(schedule);
  std::vector<std::string> limbs;
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    limbs.push_back(robot.contacts[limb.contact].name);
  }
  if (schedule.contacts != limbs) {
    throw std::invalid_argument(fmt::format("contact schedule of {}, expected {}",
                                            fmt::join(schedule.contacts, ", "),
                                            fmt::join(limbs, ", ")));
  }
  const auto all_bear = [](const models::ContactInterval& interval) {
    return std::all_of(interval.bearing.begin(), interval.bearing.end(),
                       [](const auto& bearing) { return bearing.has_value(); });
  };
  if (schedule.intervals.size() < 2 || !all_bear(schedule.intervals.front()) ||
      !all_bear(schedule.intervals.back())) {
    throw std::invalid_argument(
        "contact schedule: a limb swings in the first or the last interval");
  }
}

/// Longest distance of the joints next to a knee or elbow, as a share of the stretched limb: a
/// straight limb cannot follow.
constexpr double kStretch = 0.98;
constexpr double kGuessedStretch = 0.94;  // while the root's place is only guessed

/// Where limbs do not reach their places although the guess said so, the root is lowered by this
/// within this time, m and s, and that so many times at most.
constexpr double kLower = 0.015;
constexpr double kLowerWithin = 0.25;
constexpr int kMostLowerings = 8;

/// Limbs do not reach their places at a knot.
class OutOfReach : public MotionError {
 public:
  OutOfReach(const std::string& message, int phase, int knot)
      : MotionError(message, phase), knot_(knot) {}
  int knot() const { return knot_; }

 private:
  int knot_;
};

/// Share of a swing in which the root still rolls from the one before, and so at its end.
constexpr double kRolling = 0.05;

/// What the tasks of an interval need, besides the centre of mass.
struct Interval {
  double start = 0;  ///< s
  double duration = 0;
  double yaw_from = 0;  ///< of the root
  double yaw_to = 0;
  Vector3d zmp_from = Vector3d::Zero();  ///< on the ground
  Vector3d zmp_to = Vector3d::Zero();
};

/// The pattern of one schedule; shared by the tasks of its phases.
class Pattern {
 public:
  Pattern(const models::RobotModel& robot, const NominalStance& stance,
          const models::ContactSchedule& schedule, const PatternSettings& settings)
      : robot_(robot), stance_(stance), schedule_(schedule), settings_(settings) {
    RequireSchedule(robot_, stance_, schedule_);
    if (settings_.end_joints.size() == 0)
      settings_.end_joints = stance_.q.tail(robot_.num_joints());
    LayOutIntervals();
    LayOutZmp();
    LayOutClimbs();
    LayOutRolls();
    LayOutTurns();
    duration_ = schedule_.duration();
    LayOutKnots();
  }

  /// Solves the centre of mass, then corrects the zero moment point by the whole robot's.
  void Solve(const CancellationToken& cancellation) {
    stiffness_ = dynamics::kGravity / CentreOfMassHeight();
    SolveCentreOfMass();
    GuessRoots();
    lowered_.setZero(times_.size());
    for (int pass = 0; pass < settings_.filter_passes; ++pass) {
      const int stride = pass + 1 < settings_.filter_passes ? settings_.coarse_stride : 1;
      FilterWithinReach(pass == 0 ? kGuessedStretch : kStretch, stride, cancellation);
      SolveCentreOfMass();
    }
    if (KeepsReach()) KeepReach(kStretch);
  }

  int num_intervals() const { return static_cast<int>(intervals_.size()); }
  double duration(int k) const { return intervals_[k].duration; }

  std::vector<int> Contacts(int k) const {
    std::vector<int> contacts;
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      if (schedule_.intervals[k].bearing[limb]) {
        contacts.push_back(stance_.gait->limbs[limb].contact);
      }
    }
    return contacts;
  }

  /// Of the ground of Contacts(k).
  std::vector<Vector3d> Normals(int k) const {
    std::vector<Vector3d> normals;
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      const auto& bearing = schedule_.intervals[k].bearing[limb];
      if (!bearing) continue;
      normals.push_back(IsLevel(bearing->linear())
                            ? Vector3d(Vector3d::UnitZ())
                            : Vector3d(bearing->linear().col(2).normalized()));
    }
    return normals;
  }

  /// `t`: s since the interval began.
  WholeBodyTask Task(int k, double t) const {
    const Interval& interval = intervals_[k];
    WholeBodyTask task;
    task.root_yaw = RootYaw(interval.start + t);
    task.root_pitch =
        Blend(stance_.gait->posture.root_pitch, stance_.gait->posture.root_pitch + settings_.lean,
              Raised(interval.start + t));
    if (!rolls_.empty()) {
      task.root_turn = TurnedBy(task.root_yaw, task.root_pitch, rolls_.At(interval.start + t));
    }
    task.root_height = RootHeight(interval.start + t);
    task.centre_of_mass = CentreOfMass(interval.start + t);
    task.joints = Joints(interval.start + t);
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      task.limbs.push_back(TaskOf(k, static_cast<int>(limb), t));
    }
    return task;
  }

 private:
  std::size_t NumLimbs() const { return stance_.gait->limbs.size(); }

  /// Axes of the stance frame that a limb's patch stands in; upright if the limb does not hold its
  /// orientation.
  Eigen::Matrix3d StanceAxes(int limb, const Isometry3d& X) const {
    if (!stance_.gait->limbs[limb].hold_orientation) return Turned(Heading(X));
    return X.linear() * Turned(-stance_.patch_headings[limb]);
  }

  static Eigen::Matrix3d Turned(double yaw) {
    return Eigen::AngleAxisd(yaw, Vector3d::UnitZ()).toRotationMatrix();
  }

  /// Yaw of the stance frame that a limb's patch stands in.
  double StanceYaw(int limb, const Isometry3d& X) const {
    if (IsLevel(X.linear())) return Heading(X) - stance_.patch_headings[limb];
    return AnglesOf(StanceAxes(limb, X)).yaw;
  }

  /// The stance frame that a limb's patch stands in.
  PlanarPose StanceOf(int limb, const Isometry3d& X) const {
    const double yaw = StanceYaw(limb, X);
    const Vector2d p = Vector2d(X.translation().head<2>()) -
                       Eigen::Rotation2Dd(yaw) * Vector2d(stance_.patch_centres[limb].head<2>());
    return {p.x(), p.y(), yaw};
  }

  /// Mean heading of the limbs, close to `near`.
  template <typename PoseOf>
  double MeanHeading(double near, const PoseOf& pose_of) const {
    double sum = 0;
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      const int index = static_cast<int>(limb);
      sum += WrapAngle(StanceYaw(index, pose_of(index)) - near);
    }
    return near + sum / static_cast<double>(NumLimbs());
  }

  void LayOutIntervals() {
    double start = 0;
    double yaw = StanceYaw(0, *schedule_.intervals.front().bearing.front());
    for (int k = 0; k < static_cast<int>(schedule_.intervals.size()); ++k) {
      Interval interval;
      interval.start = start;
      interval.duration = schedule_.intervals[k].duration;
      interval.yaw_from = yaw;
      yaw = MeanHeading(yaw, [&](int limb) { return schedule_.After(k, limb); });
      interval.yaw_to = yaw;
      intervals_.push_back(interval);
      start += interval.duration;
    }
  }

  /// Every change of contacts is at a knot: accelerations change their slope there.
  void LayOutKnots() {
    std::vector<double> times;
    for (const Interval& interval : intervals_) {
      const int steps = NumIntervals(interval.duration, settings_.grid, settings_.least_steps);
      for (int i = 0; i < steps; ++i) {
        times.push_back(interval.start + interval.duration * i / steps);
      }
    }
    times.push_back(duration_);
    times_ = Eigen::Map<const VectorXd>(times.data(), static_cast<Eigen::Index>(times.size()));
    error_.setZero(2, times_.size());
  }

  /// The centre of mass, in the stance frame, when the robot rests at the end.
  Vector2d CentreOfMassAtEnd() const {
    VectorXd q = stance_.q;
    q.tail(robot_.num_joints()) = settings_.end_joints;
    dynamics::TreeKinematics kinematics(robot_);
    kinematics.SetPosition(q);
    return kinematics.CentreOfMass().head<2>();
  }

  Vector2d Balanced(int k) const { return Balanced(k, stance_.centre_of_mass); }

  /// The centre of mass at rest over the limbs that bear in interval `k`. `centre`: of mass, in the
  /// stance frame.
  Vector2d Balanced(int k, const Vector2d& centre) const {
    Vector2d sum = Vector2d::Zero();
    int count = 0;
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      const auto& bearing = schedule_.intervals[k].bearing[limb];
      if (!bearing) continue;
      sum += StanceOf(static_cast<int>(limb), *bearing) * centre;
      ++count;
    }
    return sum / count;
  }

  /// A patch's points, seen from above.
  void AddFootprint(int limb, const Isometry3d& X, std::vector<Vector2d>* points) const {
    const PlanarPose at = StanceOf(limb, X);
    const Eigen::Matrix3d axes = StanceAxes(limb, X);
    for (const Vector2d& p : stance_.bearing_points[limb]) {
      if (IsLevel(axes)) {
        points->push_back(at * p);
        continue;
      }
      const Vector2d arm = p - Vector2d(stance_.patch_centres[limb].head<2>());
      const Vector3d there = X.translation() + axes * Vector3d(arm.x(), arm.y(), 0);
      points->emplace_back(there.head<2>());
    }
  }

  /// The point of the support of interval `k` closest to Balanced, within the margin.
  Vector3d SupportedZmp(int k) const {
    std::vector<Vector2d> points;
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      const auto& bearing = schedule_.intervals[k].bearing[limb];
      if (!bearing) continue;
      AddFootprint(static_cast<int>(limb), *bearing, &points);
    }
    const Vector2d ahead =
        Eigen::Rotation2Dd(intervals_[k].yaw_from) * Vector2d(Share(k) * settings_.zmp_ahead, 0);
    return OnGround(k, SupportPolygon(points).Nearest(Balanced(k) + ahead, settings_.zmp_margin));
  }

  /// At the mean height of the limbs that bear in interval `k`.
  Vector3d OnGround(int k, const Vector2d& p) const {
    double sum = 0;
    int count = 0;
    for (const auto& bearing : schedule_.intervals[k].bearing) {
      if (!bearing) continue;
      sum += bearing->translation().z();
      ++count;
    }
    return {p.x(), p.y(), sum / count};
  }

  bool AllBear(int k) const { return Contacts(k).size() == NumLimbs(); }

  /// Fixed while a limb swings; from one support to the next while all bear.
  void LayOutZmp() {
    const int last = num_intervals() - 1;
    for (int k = 0; k <= last; ++k) {
      Interval& interval = intervals_[k];
      if (!AllBear(k)) {
        interval.zmp_from = interval.zmp_to = SupportedZmp(k);
        continue;
      }
      interval.zmp_from = k == 0 ? OnGround(k, Balanced(k)) : SupportedZmp(k - 1);
      interval.zmp_to =
          k == last ? OnGround(k, Balanced(k, CentreOfMassAtEnd())) : SupportedZmp(k + 1);
    }
  }

  /// From the beginning of a swing to the end of the next one, so that climbs of equal steps add up
  /// to an almost steady one.
  void LayOutClimbs() {
    int last = -1;
    for (int k = 0; k < num_intervals(); ++k) {
      if (AllBear(k)) continue;
      const double height =
          last < 0 ? 0 : intervals_[k].zmp_from.z() - intervals_[last].zmp_from.z();
      if (height != 0) {
        const double start = intervals_[last].start;
        climbs_.Add(start, intervals_[k].start + intervals_[k].duration - start, height);
      }
      last = k;
    }
  }

  /// Towards the side of the support, from one swing to the next; none at rest.
  void LayOutRolls() {
    if (settings_.sways.empty()) return;
    double roll = 0;
    double start = 0;
    const auto roll_to = [&](double end, double next) {
      rolls_.Add(start, end - start, next - roll);
      roll = next;
    };
    for (int k = 0; k < num_intervals(); ++k) {
      if (AllBear(k)) continue;
      const Interval& swing = intervals_[k];
      roll_to(swing.start + kRolling * swing.duration, -SideOf(k) * settings_.sways[k]);
      start = swing.start + (1 - kRolling) * swing.duration;
    }
    roll_to(intervals_.back().start + intervals_.back().duration, 0);
  }

  double Share(int k) const { return settings_.shares.empty() ? 1 : settings_.shares[k]; }

  /// From one side to the other, each in the time from the middle of the double support before a
  /// swing to the middle of that after it. A step that turns less takes its neighbours' ends along.
  void LayOutTurns() {
    if (settings_.turn == 0 && settings_.twist == 0) return;
    std::vector<int> swings;
    for (int k = 0; k < num_intervals(); ++k) {
      if (!AllBear(k)) swings.push_back(k);
    }
    const auto middle_before = [&](std::size_t i) {
      const double start = intervals_[swings[i]].start;
      const bool follows_support = i > 0 && AllBear(swings[i] - 1);
      return follows_support ? start - intervals_[swings[i] - 1].duration / 2 : start;
    };
    double before = 0;
    for (std::size_t i = 0; i < swings.size(); ++i) {
      const Interval& swing = intervals_[swings[i]];
      const bool is_last = i + 1 == swings.size();
      const double share = is_last ? 0 : std::min(Share(swings[i]), Share(swings[i + 1]));
      const double end = is_last ? swing.start + swing.duration : middle_before(i + 1);
      const double next = SideOf(swings[i]) * share;
      turns_.Add(middle_before(i), end - middle_before(i), next - before);
      before = next;
    }
  }

  /// Of the support beside the middle of all limbs' places: 1 left, -1 right, 0 neither.
  double SideOf(int k) const {
    Vector2d all = Vector2d::Zero();
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      all += schedule_.After(k, static_cast<int>(limb)).translation().head<2>();
    }
    all /= static_cast<double>(NumLimbs());
    const Vector2d left(-std::sin(intervals_[k].yaw_to), std::cos(intervals_[k].yaw_to));
    const double aside = left.dot(intervals_[k].zmp_from.head<2>() - all);
    return aside > 0 ? 1 : aside < 0 ? -1 : 0;
  }

  ScalarSignal RootYaw(double t) const {
    const Interval& interval = intervals_[IntervalAt(t)];
    const ScalarSignal heading = Blend(interval.yaw_from, interval.yaw_to,
                                       RestToRest(t - interval.start, interval.duration));
    return turns_.empty() ? heading : heading + Blend(0, settings_.turn, turns_.At(t));
  }

  int IntervalAt(double t) const {
    int k = num_intervals() - 1;
    while (k > 0 && t < intervals_[k].start) --k;
    return k;
  }

  /// On the ground: between supports of different heights, on the line that joins them.
  Vector3d ReferenceZmp(double t) const {
    const Interval& interval = intervals_[IntervalAt(t)];
    const ScalarSignal s = RestToRest(t - interval.start, interval.duration);
    return interval.zmp_from + s.value * (interval.zmp_to - interval.zmp_from);
  }

  void SolveCentreOfMass() {
    Eigen::Matrix2Xd zmp(2, times_.size());
    VectorXd first(times_.size()), last(times_.size());
    const Interval& start = intervals_.front();
    const Interval& stop = intervals_.back();
    for (Eigen::Index i = 0; i < times_.size(); ++i) {
      const double t = times_[i];
      zmp.col(i) = ReferenceZmp(t).head<2>() - error_.col(i);
      first[i] = t < start.duration ? Bump(t, start.duration).value : 0;
      last[i] = t > stop.start ? Bump(t - stop.start, stop.duration).value : 0;
    }
    const Vector2d from = start.zmp_from.head<2>();
    const Vector2d to = stop.zmp_to.head<2>();
    x_.emplace(times_, zmp.row(0), from.x(), to.x(), stiffness_, first, last);
    y_.emplace(times_, zmp.row(1), from.y(), to.y(), stiffness_, first, last);
  }

  Signal<Vector2d> CentreOfMass(double t) const {
    const ScalarSignal x = x_->At(t);
    const ScalarSignal y = y_->At(t);
    return {{x.value, y.value}, {x.rate, y.rate}, {x.acceleration, y.acceleration}};
  }

  bool KeepsReach() const {
    return settings_.keeps_reach || !climbs_.empty() ||
           std::any_of(settings_.lifts.begin(), settings_.lifts.end(),
                       [](double lift) { return lift > 0; });
  }

  ScalarSignal RootHeight(double t) const { return low_ ? low_->At(t) : WantedRootHeight(t); }

  /// Filter, with the root so low that all limbs reach their places. Where the root is follows from
  /// the posture, so what KeepReach knows of it is only a guess.
  void FilterWithinReach(double stretch, int stride, const CancellationToken& cancellation) {
    for (int lowerings = 0;; ++lowerings) {
      if (KeepsReach()) KeepReach(stretch);
      try {
        return Filter(stride, cancellation);
      } catch (const OutOfReach& error) {
        if (!KeepsReach() || lowerings == kMostLowerings) throw;
        LowerAbout(error.knot());
      }
    }
  }

  void LowerAbout(int knot) {
    for (Eigen::Index i = 0; i < times_.size(); ++i) {
      if (std::abs(times_[i] - times_[knot]) <= kLowerWithin) lowered_[i] += kLower;
    }
  }

  /// Lowers the root as far as the limbs need to reach their places.
  /// @throws MotionError if one is too far from the root, seen from above.
  void KeepReach(double stretch) {
    std::vector<std::optional<LimbReach>> reaches = ReachesOf(robot_, stance_, stretch);
    const Eigen::AngleAxisd lean(settings_.lean, Vector3d::UnitY());
    for (std::optional<LimbReach>& reach : reaches) {
      if (reach) reach->hip = lean * reach->hip;
    }
    VectorXd bound(times_.size());
    for (int i = 0; i < times_.size(); ++i) bound[i] = HighestRoot(reaches, i) - lowered_[i];
    low_.emplace(times_, bound, settings_.height_spacing);
  }

  double HighestRoot(const std::vector<std::optional<LimbReach>>& reaches, int knot) const {
    const double t = times_[knot];
    const int k = IntervalAt(t);
    const Vector2d p = CentreOfMass(t).value + to_root_.col(knot);
    const PlanarPose root{p.x(), p.y(), RootYaw(t).value};
    double highest = WantedRootHeight(t).value;
    for (std::size_t limb = 0; limb < NumLimbs(); ++limb) {
      if (!reaches[limb]) continue;
      const LimbTask task = TaskOf(k, static_cast<int>(limb), t - intervals_[k].start);
      const std::optional<double> reach = reaches[limb]->HighestRoot(
          root, task.position.value, TurnedBy(task.yaw, task.pitch, task.roll).orientation);
      if (!reach) {
        throw MotionError(fmt::format("{} does not reach its place", schedule_.contacts[limb]), k);
      }
      highest = std::min(highest, *reach);
    }
    return highest;
  }

  /// Root minus centre of mass, seen from above, as in the nominal posture; Filter knows better.
  void GuessRoots() {
    const Vector2d in_stance =
        Vector2d(stance_.X_SR.translation().head<2>()) - stance_.centre_of_mass;
    to_root_.resize(2, times_.size());
    for (Eigen::Index i = 0; i < times_.size(); ++i) {
      to_root_.col(i) = Eigen::Rotation2Dd(RootYaw(times_[i]).value) * in_stance;
    }
  }

  ScalarSignal WantedRootHeight(double t) const {
    const ScalarSignal height = HeightAboveGround(t);
    return height + climbs_.At(t, intervals_.front().zmp_from.z());
  }

  ScalarSignal HeightAboveGround(double t) const {
    const double stand = stance_.gait->posture.root_height;
    return Blend(stand, stand + settings_.rise, Raised(t));
  }

  /// 0 at both ends, 1 while the root is carried as in motion.
  ScalarSignal Raised(double t) const {
    const double time = std::min(settings_.rise_time, duration_ / 2);
    const double left = duration_ - t;
    if (t < time) return RestToRest(t, time);
    if (left >= time) return Constant(1);
    return Blend(1, 0, RestToRest(time - left, time));
  }

  /// The joints of limbs do not matter: their tasks determine them.
  Signal<VectorXd> Joints(double t) const {
    const VectorXd nominal = stance_.q.tail(robot_.num_joints());
    const double time = std::min(settings_.turning_time, duration_);
    const double turning = std::min(time, t - (duration_ - time));
    Signal<VectorXd> joints = turning <= 0 ? ConstantVector<VectorXd>(nominal)
                                           : BlendVector<VectorXd>(nominal, settings_.end_joints,
                                                                   RestToRest(turning, time));
    if (settings_.waist && !turns_.empty()) Twist(turns_.At(t), &joints);
    return joints;
  }

  void Twist(const ScalarSignal& share, Signal<VectorXd>* joints) const {
    const auto& [joint, sign] = *settings_.waist;
    const ScalarSignal angle = Blend(0, -sign * settings_.twist, share);
    joints->value[joint] += angle.value;
    joints->rate[joint] += angle.rate;
    joints->acceleration[joint] += angle.acceleration;
  }

  double CentreOfMassHeight() const {
    dynamics::TreeKinematics kinematics(robot_);
    kinematics.SetPosition(stance_.q);
    return kinematics.CentreOfMass().z() + settings_.rise;
  }

  /// The true zero moment point at every knot, minus the pendulum's. It is computed at one knot of
  /// `stride`, and on straight lines between them.
  void Filter(int stride, const CancellationToken& cancellation) {
    WholeBodySolver solver(robot_);
    dynamics::MultibodyDynamics dynamics(UncoupledModel(robot_));
    VectorXd q = stance_.q;
    q.segment<2>(4) = intervals_.front().zmp_from.head<2>();
    const int end = static_cast<int>(times_.size()) - 1;
    for (int i = 0, last = -1; last < end; last = i, i = std::min(i + stride, end)) {
      cancellation.ThrowIfCancelled();
      const double t = times_[i];
      const int k = IntervalAt(t);
      const WholeBodyState state = SolveAt(i, k, t, q, &solver);
      to_root_.col(i) = state.q.segment<2>(4) - CentreOfMass(t).value;
      q = GuessAfter(state, times_[std::min(i + stride, end)] - t);
      dynamics.SetState(state.q, state.v, state.a);
      error_.col(i) = RequiredZeroMomentPoint(&dynamics, ReferenceZmp(t).z()) -
                      Vector2d(x_->Zmp(i), y_->Zmp(i));
      if (last >= 0) {
        FillBetween(last, i, &to_root_);
        FillBetween(last, i, &error_);
      }
    }
  }

  void FillBetween(int from, int to, Eigen::Matrix2Xd* columns) const {
    for (int i = from + 1; i < to; ++i) {
      const double s = (times_[i] - times_[from]) / (times_[to] - times_[from]);
      columns->col(i) = (1 - s) * columns->col(from) + s * columns->col(to);
    }
  }

  WholeBodyState SolveAt(int knot, int k, double t, const VectorXd& guess,
                         WholeBodySolver* solver) const {
    try {
      return solver->Solve(Task(k, t - intervals_[k].start), guess);
    } catch (const MotionError& error) {
      throw OutOfReach(error.what(), k, knot);
    }
  }

  LimbTask TaskOf(int k, int limb, double t) const {
    const Isometry3d& from = schedule_.Before(k, limb);
    LimbTask task;
    task.limb = &stance_.gait->limbs[limb];
    task.orientation = stance_.patch_orientations[limb];
    task.position = ConstantVector<Vector3d>(from.translation());
    task.yaw = Constant(StanceYaw(limb, from));
    const TurnAngles tilt = Tilt(limb, from);
    task.pitch = Constant(tilt.pitch);
    task.roll = Constant(tilt.roll);
    if (!schedule_.intervals[k].bearing[limb]) Swing(k, limb, t, &task);
    return task;
  }

  TurnAngles Tilt(int limb, const Isometry3d& X) const {
    if (IsLevel(X.linear())) return {};
    return AnglesOf(StanceAxes(limb, X));
  }

  void Swing(int k, int limb, double t, LimbTask* task) const {
    const Isometry3d& from = schedule_.Before(k, limb);
    const Isometry3d& to = schedule_.After(k, limb);
    // A swing may outlast changes of other limbs.
    int first = k, last = k;
    while (!schedule_.intervals[first - 1].bearing[limb]) --first;
    while (!schedule_.intervals[last + 1].bearing[limb]) ++last;
    const double begin = intervals_[first].start;
    const double duration = intervals_[last].start + intervals_[last].duration - begin;
    const double swung = intervals_[k].start + t - begin;
    const double lift = settings_.lifts.empty() ? 0 : settings_.lifts[first];
    const SwingPath path{.from = from.translation(),
                         .to = to.translation(),
                         .clearance = settings_.clearance,
                         .lift = lift,
                         .duration = duration,
                         .on_slope = BearOnOneSlope(from, to),
                         .evenness = 1 + Share(first) * (settings_.evenness - 1)};
    task->position = path.At(swung);
    const ScalarSignal s = path.Progress(swung);
    const double yaw = StanceYaw(limb, from);
    task->yaw = Blend(yaw, yaw + WrapAngle(StanceYaw(limb, to) - yaw), s);
    const TurnAngles before = Tilt(limb, from);
    const TurnAngles after = Tilt(limb, to);
    task->pitch = Blend(before.pitch, after.pitch, s);
    task->roll = Blend(before.roll, after.roll, s);
  }

  const models::RobotModel& robot_;
  NominalStance stance_;
  models::ContactSchedule schedule_;
  PatternSettings settings_;
  std::vector<Interval> intervals_;
  /// Of the support from one swing to the next, m: the root rises with it.
  GradualChanges climbs_;
  GradualChanges rolls_;  ///< of the root, rad
  GradualChanges turns_;  ///< -1 to 1, in units of settings_.turn and twist
  Eigen::Matrix2Xd to_root_;
  VectorXd lowered_;                ///< m, at every knot: see FilterWithinReach
  std::optional<SmoothUnder> low_;  ///< the root's height on uneven ground
  double duration_ = 0;             ///< s
  VectorXd times_;                  ///< of the knots of the centre of mass, s
  double stiffness_ = 0;            ///< 1/s^2
  Eigen::Matrix2Xd error_;
  std::optional<PendulumSpline> x_, y_;
};

}  // namespace

std::vector<MotionPhase> PatternPhases(const models::RobotModel& robot, const NominalStance& stance,
                                       const models::ContactSchedule& schedule,
                                       const PatternSettings& settings,
                                       const CancellationToken& cancellation) {
  const auto pattern = std::make_shared<Pattern>(robot, stance, schedule, settings);
  pattern->Solve(cancellation);
  std::vector<MotionPhase> phases;
  for (int k = 0; k < pattern->num_intervals(); ++k) {
    MotionPhase phase;
    phase.duration = pattern->duration(k);
    phase.contacts = pattern->Contacts(k);
    phase.normals = pattern->Normals(k);
    phase.task = [pattern, k](double t) { return pattern->Task(k, t); };
    phases.push_back(std::move(phase));
  }
  return phases;
}

}  // namespace possibility::actions
