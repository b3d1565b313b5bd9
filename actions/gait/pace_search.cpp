#include "actions/gait/pace_search.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>

#include "actions/gait/pace_fit.h"
#include "actions/gait/pace_trial.h"
#include "actions/gait/waist_joint.h"

namespace possibility::actions {
namespace {

/// By how much the mean speed rises whenever a pace keeps the limits.
constexpr double kQuicker = 1.02;

/// The way whose mean speed counts, in multiples of the root's height. It begins and ends at rest.
constexpr double kWay = 5;

/// The more even a swing, the more suddenly its acceleration rises; here within a sixth of its
/// time.
constexpr double kMostEven = 2;

/// Standard deviation of a change, as a share of its range: at first, at most and at least.
constexpr double kSpread = 0.15;
constexpr double kWidest = 0.3;
constexpr double kNarrowest = 0.02;
/// Its factors after a success and after a failure.
constexpr double kWiden = 1.3;
constexpr double kNarrow = 0.98;
constexpr int kMostChanges = 4;  // of numbers at a time

/// A few steps do not show a gait that goes on: with each of them limbs may lag a little more. On
/// more than two limbs steps are short.
constexpr int kManySteps = 8;
constexpr int kManyShortSteps = 20;
/// Motions may use 95 % of the limits; trials ask for 92 %, to have a reserve for this, too.
constexpr double kReserve = 0.92 / 0.95;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A number of a pace, and where the search may place it.
struct Unknown {
  double* value;
  double least;
  double most;
};

/// The pace that the search changes.
class Searched {
 public:
  Searched(const models::RobotModel& robot, const NominalStance& stance, const Pace& start)
      : pace_(start), way_(kWay * stance.gait->posture.root_height), mean_speed_(MeanSpeed(start)) {
    const models::Gait& gait = *stance.gait;
    const double swing = gait.parameters.swing_time;
    const double height = gait.posture.root_height;
    pace_.style.keeps_reach = true;
    StepTiming& timing = pace_.timing;
    PaceStyle& style = pace_.style;
    // In double supports shorter than the family's, forces change too quickly to be linear between
    // knots: points that bear little need more friction there than they have.
    const double double_support = start.timing.double_support;
    const bool on_feet = gait.limbs.size() == 2;
    const double least_start = on_feet ? 0.6 : 0.4;  // limbs that are well apart need less time
    const double farthest_back = on_feet ? 0.15 : 0.35;
    // Narrow passages are what more limbs are for: a trunk that turns far does not pass them.
    const double most_turn = on_feet ? 0.3 : 0.08;
    unknowns_ = {
        {&timing.swing, 0.5 * swing, 1.2 * swing},
        {&timing.double_support, double_support, 2 * double_support},
        {&timing.start, least_start * swing, 1.4 * swing},
        {&pace_.rise, 0, 0.17 * height},
        {&style.evenness, 1, kMostEven},
        {&style.zmp_ahead, -0.5 * gait.parameters.com_margin, 0.5 * gait.parameters.com_margin},
        {&style.lean, -farthest_back, 0.15},
        {&style.turn, -most_turn, most_turn}};
    if (WaistJoint(robot, stance)) unknowns_.push_back({&style.twist, -0.4, 0.4});
  }
  // The unknowns point into the pace.
  Searched(const Searched&) = delete;

  const Pace& pace() const { return pace_; }
  /// Of the way from rest to rest, m/s.
  double MeanSpeed(const Pace& pace) const {
    return way_ / (way_ / pace.speed() + 2 * pace.timing.start);
  }

  void GoQuicker() { SetMeanSpeed(kQuicker * mean_speed_); }

  /// Changes a few numbers at random; TakeBack undoes it.
  void Mutate(double spread, std::mt19937* random) {
    before_.clear();
    for (const Unknown& unknown : unknowns_) before_.push_back(*unknown.value);
    const auto changes = 1 + (*random)() % kMostChanges;
    for (std::size_t i = 0; i < changes; ++i) {
      const Unknown& one = unknowns_[(*random)() % unknowns_.size()];
      const double change = spread * normal_(*random) * (one.most - one.least);
      *one.value = std::clamp(*one.value + change, one.least, one.most);
    }
    SetMeanSpeed(mean_speed_);
  }
  void TakeBack() {
    for (std::size_t i = 0; i < unknowns_.size(); ++i) *unknowns_[i].value = before_[i];
    SetMeanSpeed(mean_speed_);
  }

 private:
  void SetMeanSpeed(double mean) {
    mean_speed_ = mean;
    const StepTiming& timing = pace_.timing;
    const double speed = way_ / (way_ / mean - 2 * timing.start);
    pace_.bounds.forward = speed * pace_.StepsEach() * (timing.swing + timing.double_support);
    pace_.timing.swing_length = pace_.bounds.forward;
  }

  Pace pace_;
  const double way_;  ///< m
  double mean_speed_;
  std::vector<Unknown> unknowns_;
  std::vector<double> before_;
  std::normal_distribution<double> normal_;
};

/// Of steps ahead, and of those of `start` aside and in turns. Many and shorter steps ahead count,
/// too, if the others keep the limits. Only a lower bound if it is not below `enough`.
double LoadOf(const PaceTrial& trial, const Pace& pace, const Pace& start, int many_steps,
              double enough) {
  double load = trial.Load(pace, {pace.bounds.forward, 0, 0});
  if (load < enough) load = std::max(load, trial.Load(pace, {0, start.bounds.lateral, 0}));
  if (load < enough) load = std::max(load, trial.Load(pace, {0, 0, start.bounds.turn}));
  for (const double share : {1.0, 0.9, 0.8, 0.7, 0.6}) {
    if (load > 1) break;
    const PlanarPose step{share * pace.bounds.forward, 0, 0};
    load = std::max(load, kReserve * trial.Load(pace, step, many_steps));
  }
  return load;
}

/// The paces that a search found, from slow to quick. `load_of`: LoadOf. `asked`: before each
/// trial, with its number.
std::vector<Pace> FoundFrom(std::uint32_t seed, const PaceSearchSettings& settings,
                            const std::function<double(const Pace&, double enough)>& load_of,
                            Searched* searched, const std::function<void(int)>& asked) {
  std::mt19937 random(seed);
  std::vector<Pace> found;
  double load = load_of(searched->pace(), kInfinite);
  double spread = kSpread;
  int last = 0;  // trial that made the pace quicker
  for (int i = 0; i < settings.trials && i - last < settings.idle_trials; ++i) {
    asked(i);
    searched->Mutate(spread, &random);
    const double now = load_of(searched->pace(), load);
    if (!(now < load)) {
      searched->TakeBack();
      spread = std::max(kNarrow * spread, kNarrowest);
      continue;
    }
    load = now;
    spread = std::min(kWiden * spread, kWidest);
    while (load <= 1) {
      last = i;
      found.push_back(searched->pace());
      searched->GoQuicker();
      load = load_of(searched->pace(), kInfinite);
    }
  }
  return found;
}

}  // namespace

std::optional<Pace> SearchPace(const models::RobotModel& robot, const NominalStance& stance,
                               const Pace& start, const PaceSearchSettings& settings,
                               const CancellationToken& cancellation) {
  const PaceTrial trial(robot, stance);
  const int many_steps = stance.gait->limbs.size() == 2 ? kManySteps : kManyShortSteps;
  const auto load_of = [&](const Pace& pace, double enough) {
    return LoadOf(trial, pace, start, many_steps, enough);
  };
  std::vector<Pace> found;
  for (std::size_t search = 0; search < settings.seeds.size(); ++search) {
    Searched searched(robot, stance, start);
    const auto asked = [&](int done) {
      cancellation.ThrowIfCancelled();
      if (!settings.progress) return;
      settings.progress(searched.pace().speed(), static_cast<int>(search) * settings.trials + done,
                        static_cast<int>(settings.seeds.size()) * settings.trials);
    };
    const std::vector<Pace> more =
        FoundFrom(settings.seeds[search], settings, load_of, &searched, asked);
    found.insert(found.end(), more.begin(), more.end());
  }
  const Searched measure(robot, stance, start);
  std::stable_sort(found.begin(), found.end(), [&](const Pace& a, const Pace& b) {
    return measure.MeanSpeed(a) > measure.MeanSpeed(b);
  });
  for (const Pace& pace : found) {
    if (pace.speed() <= start.speed()) break;
    if (!trial.Allows(pace, {pace.bounds.forward, 0, 0})) continue;
    const auto complete = WithStepsAside(trial, stance.gait->parameters, pace);
    if (complete) return complete;
  }
  return std::nullopt;
}

std::vector<Pace> OptimisedPaces(const models::RobotModel& robot, const NominalStance& stance,
                                 const PaceSearchSettings& settings,
                                 const CancellationToken& cancellation) {
  std::vector<Pace> paces = FitPaces(robot, stance);
  if (paces.empty() || SwingGroups(stance).size() != 2) return paces;
  const std::optional<Pace> quick =
      SearchPace(robot, stance, paces.front(), settings, cancellation);
  if (quick) paces.insert(paces.begin(), *quick);
  return paces;
}

}  // namespace possibility::actions
