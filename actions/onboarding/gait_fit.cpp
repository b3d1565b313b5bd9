#include "actions/onboarding/gait_fit.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/gait/quasi_static_gait.h"
#include "actions/gait/swept_volume.h"
#include "actions/onboarding/gait_numbers.h"
#include "actions/onboarding/pace_limits.h"
#include "actions/onboarding/touching_pairs.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/nominal_stance.h"
#include "common/stopwatch.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

/// In the order in which they are tried; the first of each is where the search begins.
constexpr double kSpreads[] = {0.8, 1, 1.2, 0.6};
constexpr double kExtensions[] = {0.9, 0.86, 0.94, 0.82, 0.97, 0.92, 0.76};
constexpr double kQuickness[] = {1, 0.8, 1.25};
constexpr double kMarginShares[] = {1, 1.6, 0.6};
/// rad: tried one after the other, until something walks.
constexpr double kSways[] = {0, 0.08, 0.16};
/// Of the longest strides ahead, aside and in turns.
constexpr double kStrides[] = {1, 0.75, 0.5, 0.35, 0.2};

constexpr std::size_t kKept = 2;
constexpr double kStrideSampling = 0.04;  // s

class WalkFit {
 public:
  WalkFit(const RobotDraft& draft, double seconds, double enough, std::vector<FitTrial>* trials,
          const std::function<void(const FitTrial&)>& progress)
      : draft_(draft),
        seconds_(seconds),
        wanted_(enough * ExpectedSpeed(draft)),
        trials_(trials),
        progress_(progress) {}

  std::vector<FittedGait> Run() {
    for (const double sway : kSways) {
      Search(draft_.sway.value_or(sway));
      if (!fits_.empty() || draft_.sway) break;
    }
    if (fits_.size() > kKept) fits_.resize(kKept);
    return std::move(fits_);
  }

 private:
  /// One number after the other, each from the best so far.
  void Search(double sway) {
    start_.choice = {kExtensions[0], kSpreads[0]};
    start_.sway = sway;
    Try(start_);
    Vary(kSpreads, [](FitTrial* trial, double value) { trial->choice.spread = value; });
    Vary(kExtensions, [](FitTrial* trial, double value) { trial->choice.extension = value; });
    Vary(kMarginShares, [](FitTrial* trial, double value) { trial->margin = value; });
    Vary(kQuickness, [](FitTrial* trial, double value) { trial->quickness = value; });
    Vary(kExtensions, [](FitTrial* trial, double value) { trial->choice.extension = value; });
  }

  bool IsDone() const {
    const bool quick = !fits_.empty() && fits_.front().trial.speed >= wanted_;
    return quick || watch_.Seconds() > seconds_;
  }

  template <std::size_t count, typename Set>
  void Vary(const double (&values)[count], const Set& set) {
    const FitTrial from = fits_.empty() ? start_ : fits_.front().trial;
    for (const double value : values) {
      if (IsDone()) return;
      FitTrial trial = from;
      set(&trial, value);
      if (!WasTried(trial)) Try(trial);
    }
  }

  bool WasTried(const FitTrial& trial) const {
    return std::any_of(trials_->begin(), trials_->end(), [&](const FitTrial& other) {
      return other.choice.extension == trial.choice.extension &&
             other.choice.spread == trial.choice.spread && other.quickness == trial.quickness &&
             other.margin == trial.margin && other.sway == trial.sway;
    });
  }

  void Try(const FitTrial& choice) {
    FitTrial trial = choice;
    trial.speed = 0;
    trial.reason.clear();
    trial.binding.clear();
    std::string reason;
    const std::optional<StandingPosture> standing = StandWith(draft_, trial.choice, &reason);
    if (!standing) {
      trial.reason = reason;
      return Record(trial);
    }
    models::RobotModel robot = draft_.robot;
    std::vector<IgnoredPair> ignored = draft_.ignored;
    if (!draft_.pairs_are_given) {
      for (const IgnoredPair& pair : TouchingPairs(draft_, standing->posture.joints)) {
        ignored.push_back(pair);
      }
    }
    for (const IgnoredPair& pair : ignored) {
      robot.ignored_collisions.emplace_back(pair.link, pair.other);
    }
    FittedGait fitted{Walk(*standing, trial), ignored, {}, *standing, trial};
    if (FitPaces(robot, &fitted, &trial)) {
      fitted.trial = trial;
      fits_.push_back(std::move(fitted));
      std::stable_sort(fits_.begin(), fits_.end(), [](const FittedGait& a, const FittedGait& b) {
        return a.trial.speed > b.trial.speed;
      });
    }
    Record(trial);
  }

  void Record(const FitTrial& trial) {
    trials_->push_back(trial);
    if (progress_) progress_(trial);
  }

  models::Gait Walk(const StandingPosture& standing, const FitTrial& trial) const {
    models::Gait gait;
    gait.name = "walk";
    gait.posture = standing.posture;
    gait.limbs = {{0, true, draft_.left_leg}, {1, true, draft_.right_leg}};
    gait.parameters = ScaledParameters(draft_, 1, trial.quickness);
    gait.parameters.com_margin *= trial.margin;
    gait.parameters.sway = trial.sway;
    return gait;
  }

  /// Whether the robot can make each stride that the bounds allow, and at which paces it walks.
  bool FitPaces(const models::RobotModel& robot, FittedGait* fitted, FitTrial* trial) const {
    try {
      const NominalStance stance = SolveNominalStance(robot, fitted->gait);
      if (!FitStrides(robot, stance, fitted, trial)) return false;
      const PaceLimits limits(robot, stance);
      const DynamicGait gait(robot, stance, PacesOf(robot, stance, limits, fitted));
      SweepGait(robot, stance, gait, {});
      fitted->paces = gait.paces();
      trial->speed =
          gait.paces().empty() ? StaticSpeed(robot, stance) : gait.paces().front().speed();
      trial->binding = limits.BindingLimit(gait.paces());
      trial->reason.clear();
      return true;
    } catch (const InputError& error) {
      trial->reason = error.what();
      return false;
    }
  }

  /// Shortens the strides ahead, aside and in turns, each by itself, until they are possible.
  static bool FitStrides(const models::RobotModel& robot, const NominalStance& stance,
                         FittedGait* fitted, FitTrial* trial) {
    models::GaitParameters& p = fitted->gait.parameters;
    const QuasiStaticGait gait(robot, stance);
    const auto fit = [&](double* bound, const auto& displacement) {
      const double longest = *bound;
      for (const double share : kStrides) {
        *bound = share * longest;
        const bool ahead = IsPossible(gait, displacement(*bound), &trial->reason);
        if (ahead && IsPossible(gait, displacement(-*bound), &trial->reason)) return true;
      }
      return false;
    };
    return fit(&p.forward,
               [](double x) {
                 return PlanarPose{x, 0, 0};
               }) &&
           fit(&p.lateral,
               [](double y) {
                 return PlanarPose{0, y, 0};
               }) &&
           fit(&p.turn, [](double yaw) {
             return PlanarPose{0, 0, yaw};
           });
  }

  static bool IsPossible(const QuasiStaticGait& gait, const PlanarPose& displacement,
                         std::string* reason) {
    try {
      gait.Motion({PlanarPose(), displacement}, kStrideSampling, {});
      return true;
    } catch (const MotionError& error) {
      *reason = error.what();
      return false;
    }
  }

  /// With the clearance between links that fitted paces have, or else half of it, which motions
  /// fall back to. The whole family takes seconds to try, so the slowest pace comes first.
  static std::vector<Pace> PacesOf(const models::RobotModel& robot, const NominalStance& stance,
                                   const PaceLimits& limits, FittedGait* fitted) {
    if (!limits.AllowsSlowestPace(kTightClearance)) return {};
    const models::GaitParameters before = fitted->gait.parameters;
    if (limits.AllowsSlowestPace(kFittedClearance) &&
        FitAside(limits, kFittedClearance, &fitted->gait.parameters)) {
      const DynamicGait gait(robot, stance);
      if (!gait.paces().empty()) return gait.paces();
    }
    fitted->gait.parameters = before;
    if (!FitAside(limits, kTightClearance, &fitted->gait.parameters)) return {};
    const std::optional<Pace> pace = limits.Quickest(kTightClearance);
    return pace ? std::vector<Pace>{*pace} : std::vector<Pace>();
  }

  /// Shortens steps aside and turns until a pace of middling speed allows them.
  static bool FitAside(const PaceLimits& limits, double clearance, models::GaitParameters* p) {
    const auto shorten = [](double* bound, const auto& is_possible) {
      for (const double share : kStrides) {
        if (!is_possible(share * *bound)) continue;
        *bound *= share;
        return true;
      }
      return false;
    };
    return shorten(&p->lateral,
                   [&](double y) {
                     return limits.AllowsStep({0, y, 0}, clearance);
                   }) &&
           shorten(&p->turn, [&](double yaw) {
             return limits.AllowsStep({0, 0, yaw}, clearance);
           });
  }

  static double StaticSpeed(const models::RobotModel& robot, const NominalStance& stance) {
    const QuasiStaticGait gait(robot, stance);
    constexpr int kMany = 10;
    return kMany * stance.gait->parameters.forward / gait.ExpectedDuration(kMany);
  }

  const RobotDraft& draft_;
  const double seconds_;
  const double wanted_;
  std::vector<FitTrial>* trials_;
  const std::function<void(const FitTrial&)>& progress_;
  Stopwatch watch_;
  FitTrial start_;
  std::vector<FittedGait> fits_;  ///< the quickest first
};

}  // namespace

std::string TextOf(const FitTrial& trial) {
  const std::string what = trial.reason.empty()
                               ? fmt::format("{:.2f} m/s (quicker: {})", trial.speed, trial.binding)
                               : "no: " + trial.reason;
  const std::string sway = trial.sway == 0 ? "" : fmt::format(", sway {:.2f}", trial.sway);
  return fmt::format("hips at {:.2f}, feet at {:.2f}, balance {:.1f}, quickness {:.2f}{}: {}",
                     trial.choice.extension, trial.choice.spread, trial.margin, trial.quickness,
                     sway, what);
}

std::vector<FittedGait> FitWalk(const RobotDraft& draft, double seconds, double enough,
                                std::vector<FitTrial>* trials,
                                const std::function<void(const FitTrial&)>& progress) {
  return WalkFit(draft, seconds, enough, trials, progress).Run();
}

}  // namespace possibility::actions
