#include "collocation/robot/contact_sequence.h"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "collocation/robot/placed_patch.h"
#include "collocation/robot/swing_clearance.h"

namespace possibility::collocation {
namespace {

using models::ContactSchedule;

// Typical sizes of rows.
constexpr double kAcceleration = 50;  // m/s^2, of a point
constexpr double kMoment = 20;        // N m

int ContactNamed(const dynamics::MultibodyModel& model, const std::string& name) {
  const std::vector<models::ContactPatch>& contacts = model.tree().contacts;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].name == name) return static_cast<int>(i);
  }
  throw std::invalid_argument(fmt::format("contact sequence: the robot has no contact '{}'", name));
}

/// The whole swing of a contact, which may last for several intervals of a schedule.
struct Swing {
  int first = 0;  ///< interval
  int last = 0;
};

class Sequence {
 public:
  Sequence(OptimalControlProblem* problem, const RobotSystem& model,
           const ContactSchedule& schedule, const ContactSequenceSettings& settings)
      : problem_(problem), model_(model), schedule_(schedule), settings_(settings) {
    models::CheckContactSchedule(schedule);
    for (const std::string& name : schedule.contacts) {
      contacts_.push_back(ContactNamed(*model, name));
    }
  }

  std::vector<RobotPhase> Build() {
    for (int k = 0; k < num_intervals(); ++k) AddInterval(k);
    return phases_;
  }

 private:
  int num_intervals() const { return static_cast<int>(schedule_.intervals.size()); }
  int num_contacts() const { return static_cast<int>(contacts_.size()); }

  bool Bears(int k, int contact) const {
    return k >= 0 && k < num_intervals() && schedule_.intervals[k].bearing[contact].has_value();
  }

  PlacedPatch Placed(int k, int contact) const {
    return Place(*model_, contacts_[contact], *schedule_.intervals[k].bearing[contact]);
  }

  void AddInterval(int k) {
    std::vector<dynamics::ContactPoint> points;
    for (int contact = 0; contact < num_contacts(); ++contact) {
      if (!Bears(k, contact)) continue;
      const PlacedPatch patch = Placed(k, contact);
      points.insert(points.end(), patch.points.begin(), patch.points.end());
    }
    const double duration = schedule_.intervals[k].duration;
    phases_.push_back(AddRobotPhase(problem_, fmt::format("interval {}", k), model_, points,
                                    settings_.limits, Torques::kControls));
    phases_.back().phase->SetDuration(
        {settings_.quickest * duration, settings_.slowest * duration});
    phases_.back().phase->Guess(phases_.back().phase->duration(), duration);
    if (k > 0) ContinueRobot(problem_, phases_[k - 1], phases_[k], true);
    int force = 0;
    for (int contact = 0; contact < num_contacts(); ++contact) {
      if (Bears(k, contact)) {
        Hold(k, contact);
        Load(k, contact, &force);
      } else if (const std::optional<Swing> swing = SwingAt(k, contact)) {
        Clear(k, contact, *swing);
      }
    }
    Separate(k);
  }

  std::string NameOf(const char* what, int contact) const {
    return fmt::format("{} {}", what, schedule_.contacts[contact]);
  }

  /// Whether the contact bears from interval `k` to the end of the schedule.
  bool BearsToTheEnd(int k, int contact) const {
    while (k < num_intervals() && Bears(k, contact)) ++k;
    return k == num_intervals();
  }

  /// Places are stated where a patch lands, velocities at all later knots and accelerations at all
  /// knots: velocities alone leave oscillations of the accelerations, and accelerations alone
  /// drift.
  void Hold(int k, int contact) {
    const RobotPhase& robot = phases_[k];
    const PlacedPatch patch = Placed(k, contact);
    const std::vector<PointComponent> held = HoldingComponents(patch);
    const std::vector<Bounds> still(held.size(), Bounds{0, 0});
    const bool lands = k > 0 && !Bears(k - 1, contact);
    const bool is_fixed_later = settings_.end_is_fixed && BearsToTheEnd(k, contact);
    if ((lands || (k == 0 && !settings_.start_is_fixed)) && !is_fixed_later) {
      std::vector<Bounds> at_place;
      for (const double place : HeldPlaces(patch)) at_place.push_back({place, place});
      robot.phase->Constrain(NameOf("place of", contact), PointPositions(model_, held),
                             robot.Positions(), at_place, At::kStart);
    }
    const bool is_end = k + 1 == num_intervals() && settings_.end_is_fixed;
    const bool starts = lands || (k == 0 && !settings_.start_is_fixed);
    robot.phase->ConstrainKnots(NameOf("velocity of", contact), PointVelocities(model_, held),
                                robot.State(), still,
                                starts ? (is_end ? At::kBeforeEnd : At::kEverywhere)
                                       : (is_end ? At::kInside : At::kAfterStart));
    robot.phase->ConstrainKnots(NameOf("acceleration of", contact),
                                PointAccelerations(model_, held), robot.Motion(), still,
                                WithoutFixedEnds(k), {kAcceleration});
  }

  /// `force`: index of the patch's first force, then of the next patch's.
  void Load(int k, int contact, int* force) {
    const RobotPhase& robot = phases_[k];
    const PlacedPatch patch = Placed(k, contact);
    const int count = 3 * static_cast<int>(patch.points.size());
    const std::vector<Variable> forces(robot.f.begin() + *force, robot.f.begin() + *force + count);
    *force += count;
    const bool lands = k > 0 && !Bears(k - 1, contact);
    const bool lifts = k + 1 < num_intervals() && !Bears(k + 1, contact);
    for (const Variable& f : forces) {
      if (lands) robot.phase->Fix(f, 0, At::kStart);
      if (lifts) robot.phase->Fix(f, 0, At::kEnd);
    }
    if (settings_.pressure_reserve <= 0 || !IsSurface(patch)) return;
    // Without a load there is no centre of pressure.
    const At loaded = lands ? (lifts ? At::kInside : At::kAfterStart)
                            : (lifts ? At::kBeforeEnd : At::kEverywhere);
    robot.phase->Constrain(NameOf("pressure under", contact),
                           PressureReserve(patch, settings_.pressure_reserve), forces,
                           {{0, kInfinity}}, loaded, {kMoment});
  }

  /// None if the contact does not bear before or does not bear again.
  std::optional<Swing> SwingAt(int k, int contact) const {
    Swing swing{k, k};
    while (swing.first >= 0 && !Bears(swing.first, contact)) --swing.first;
    while (swing.last < num_intervals() && !Bears(swing.last, contact)) ++swing.last;
    if (swing.first < 0 || swing.last == num_intervals()) return std::nullopt;
    return Swing{swing.first + 1, swing.last - 1};
  }

  /// Shares of a swing's duration, by the schedule, at which interval `k` begins and ends.
  std::pair<double, double> SharesOf(int k, const Swing& swing) const {
    double before = 0;
    double all = 0;
    for (int i = swing.first; i <= swing.last; ++i) {
      if (i == k) before = all;
      all += schedule_.intervals[i].duration;
    }
    return {before / all, (before + schedule_.intervals[k].duration) / all};
  }

  void Clear(int k, int contact, const Swing& swing) {
    const PlacedPatch from = Placed(swing.first - 1, contact);
    const PlacedPatch to = Placed(swing.last + 1, contact);
    const auto [begin, end] = SharesOf(k, swing);
    std::vector<Variable> arguments = phases_[k].Positions();
    arguments.push_back(phases_[k].phase->share());
    phases_[k].phase->Constrain(NameOf("clearance of", contact),
                                SwingClearance(model_, from, to, {begin, end, settings_.clearance}),
                                arguments, {{0, kInfinity}}, InsideSwing(k, swing));
  }

  /// All of the interval but the instants at which the swing begins and ends.
  static At InsideSwing(int k, const Swing& swing) {
    if (k == swing.first) return k == swing.last ? At::kInside : At::kAfterStart;
    return k == swing.last ? At::kBeforeEnd : At::kEverywhere;
  }

  void Separate(int k) {
    std::vector<PointOverPlane> pairs;
    std::vector<Bounds> bounds;
    for (const Separation& separation : settings_.separations) {
      if (separation.interval != k) continue;
      pairs.push_back(separation.pair);
      bounds.push_back({separation.height, kInfinity});
    }
    if (pairs.empty()) return;
    phases_[k].phase->ConstrainKnots("separation", HeightsOverPlanes(model_, pairs),
                                     phases_[k].Positions(), bounds, WithoutFixedEnds(k));
  }

  /// Everywhere but where the problem fixes all positions.
  At WithoutFixedEnds(int k) const {
    const bool starts_fixed = k == 0 && settings_.start_is_fixed;
    const bool ends_fixed = k + 1 == num_intervals() && settings_.end_is_fixed;
    if (starts_fixed) return ends_fixed ? At::kInside : At::kAfterStart;
    return ends_fixed ? At::kBeforeEnd : At::kEverywhere;
  }

  OptimalControlProblem* problem_;
  RobotSystem model_;
  const ContactSchedule& schedule_;
  const ContactSequenceSettings& settings_;
  std::vector<int> contacts_;  ///< by contact of the schedule: of the robot
  std::vector<RobotPhase> phases_;
};

}  // namespace

std::vector<RobotPhase> AddContactSequence(OptimalControlProblem* problem, const RobotSystem& model,
                                           const ContactSchedule& schedule,
                                           const ContactSequenceSettings& settings) {
  return Sequence(problem, model, schedule, settings).Build();
}

}  // namespace possibility::collocation
