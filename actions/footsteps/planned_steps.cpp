#include "actions/footsteps/planned_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "actions/wholebody/motion_collision.h"
#include "actions/wholebody/motion_error.h"
#include "models/robot/rotors.h"

namespace possibility::actions {
namespace {

// Effort of one job, before it is doubled.
constexpr int kSequences = 24;
constexpr int kLowSequences = 2;               // in which the root sinks lower than usual
constexpr std::int64_t kStates = 120000;       // expanded in all its searches
constexpr std::int64_t kStatesOfOne = 16000;   // and in each of them
constexpr std::int64_t kShareFartherAway = 4;  // steps farther from obstacles: a fourth of that
constexpr std::int64_t kStatesPerQuestion = 50;

/// A robot whose rotors are known looks for steps within this share of its torques first, in so
/// many sequences: motors a tenth weaker carry a body 5 % heavier through them.
constexpr double kSparingTorque = 0.85;
constexpr int kSparingSequences = 4;

// Where the robot hits something, the swing is raised, and then the trunk kept away; m.
constexpr double kRaise = 0.03;
constexpr int kMostRaises = 2;  // of two limbs; two more for each further one
constexpr double kAway = 0.02;
constexpr double kFarthestAway = 0.08;

/// Hits of a rough motion that are less deep need not be hits of the motion, m. Links were 10 to
/// 36 mm from where the motion has them, 77 mm once.
constexpr double kRoughPlace = 0.02;

/// A low root loads the bearing leg. Where a step fails with one, the root must be higher by this
/// than it was, m, and that so many times at most.
constexpr double kTaller = 0.01;
constexpr int kMostTaller = 2;

/// Farthest ends of an edge, m.
constexpr double kFarthest = 30;

/// Edges whose ends differ by less are the same: routes compute ends anew. m and rad.
constexpr double kSameEnd = 1e-7;

// Of the expected duration, s.
constexpr double kToStartAndStop = 2.5;
constexpr double kSecondsPerMetre = 2.2;
constexpr double kSecondsPerMetreRisen = 12;

/// All limbs' places before a step.
std::vector<Foothold> FeetBefore(const GroundedStance& start, std::size_t limbs,
                                 const std::vector<Footstep>& steps, int step) {
  std::vector<Foothold> feet(limbs, Foothold{start.pose, start.z});
  for (int i = 0; i < step; ++i) feet[steps[i].limb] = steps[i].to;
  return feet;
}

bool AreSame(const std::vector<Footstep>& some, const std::vector<Footstep>& others) {
  return std::equal(some.begin(), some.end(), others.begin(), others.end(),
                    [](const Footstep& a, const Footstep& b) {
                      return a.limb == b.limb && a.to.z == b.to.z &&
                             a.to.stance.position() == b.to.stance.position() &&
                             a.to.stance.yaw == b.to.stance.yaw;
                    });
}

}  // namespace

PlannedSteps::PlannedSteps(const PlanningContext& context, int gait)
    : Manoeuvre(context, NameOf(context.model->gaits[gait]->gait), gait, gait),
      limits_(FootstepLimits::Of(*context.model->robot, context.model->gaits[gait]->stance)),
      reach_(*context.model->robot, context.model->gaits[gait]->stance),
      motion_(*context.model->robot, context.model->gaits[gait]->stance) {}

bool PlannedSteps::CN(const graph::Edge& edge) const {
  const std::optional<GroundedStance> from = LaunchStance(edge.from);
  const std::optional<GroundedStance> to = LandingStance(edge.to);
  if (!from || !to) return false;
  if ((to->pose.position() - from->pose.position()).norm() > kFarthest) return false;
  return launch_gait().CS(edge.from) && landing_gait().CS(edge.to);
}

double PlannedSteps::GreatestSpeed() const {
  const double longest = std::hypot(limits_.forward, limits_.lateral) + FootholdGround::kMostShift;
  return longest / motion_.LeastStepTime();
}

double PlannedSteps::ExpectedDuration(const graph::Edge& edge) const {
  const EdgeKey key = KeyOf(edge);
  if (const std::optional<double> known = DurationOfOutcome(key)) return *known;
  const std::vector<Footstep> steps = SuggestedFor(key).steps;
  if (!steps.empty()) return ExpectedDuration(steps);
  const Eigen::Vector3d way = (edge.to - edge.from).head<3>();
  return kToStartAndStop + kSecondsPerMetre * way.head<2>().norm() +
         kSecondsPerMetreRisen * std::abs(way.z());
}

std::optional<double> PlannedSteps::DurationOfOutcome(const EdgeKey& key) const {
  const std::lock_guard lock(mutex_);
  const auto known = outcomes_.find(key);
  if (known == outcomes_.end() || known->second.motion.empty()) return std::nullopt;
  return known->second.motion.back().knots.back().t;
}

std::vector<Phase> PlannedSteps::FreeMotion(const GroundedStance& from, std::vector<Footstep> steps,
                                            double most_torque,
                                            const CancellationToken& cancellation) const {
  const int most_raises = kMostRaises * (static_cast<int>(stance().gait->limbs.size()) - 1);
  for (int raises = 0, style = 0;;) {
    try {
      return MotionOffObstacles(from, steps, most_torque, &style, cancellation);
    } catch (const FootstepError& error) {
      if (error.hit() != FootstepError::Hit::kSwinging) throw;
      Footstep& step = steps[error.step()];
      step.lift += kRaise;
      if (++raises > most_raises || step.lift > limits_.lift) throw;
    }
  }
}

std::vector<Phase> PlannedSteps::MotionOffObstacles(const GroundedStance& from,
                                                    const std::vector<Footstep>& steps,
                                                    double most_torque, int* style,
                                                    const CancellationToken& cancellation) const {
  const models::RobotModel& robot = *model().robot;
  const models::Environment& environment = *world().environment;
  const auto require = [&](const std::vector<Phase>& motion, const auto& first_hit) {
    for (std::size_t i = 0; i < motion.size(); ++i) {
      const std::string hit = first_hit(motion[i]);
      cancellation.ThrowIfCancelled();
      if (hit.empty()) continue;
      const int phase = static_cast<int>(i);
      throw FootstepError(hit, FootstepMotion::StepOfPhase(phase, static_cast<int>(steps.size())),
                          FootstepMotion::SwingsIn(phase) ? FootstepError::Hit::kSwinging
                                                          : FootstepError::Hit::kBearing);
    }
  };
  const auto require_rough = [&](const std::vector<Phase>& rough) {
    require(rough, [&](const Phase& phase) {
      return FirstRoughHit(robot, environment, *checker(), {phase}, kRoughPlace, cancellation);
    });
  };
  std::vector<Phase> motion =
      motion_.Build({from.pose, from.z}, steps, cancellation, style, most_torque, require_rough);
  const std::string self = FirstSelfHit(robot, *checker(), motion, cancellation);
  cancellation.ThrowIfCancelled();
  if (!self.empty()) throw FootstepError(self, -1);
  require(motion, [&](const Phase& phase) {
    return FirstHit(robot, environment, *checker(), {phase}, cancellation);
  });
  return motion;
}

std::shared_ptr<const StepGround> PlannedSteps::known_ground() const {
  std::call_once(ground_is_known_, [this] {
    known_ground_ = std::make_shared<StepGround>(model(), from(), world(), limits_);
  });
  return known_ground_;
}

PlannedSteps::EdgeKey PlannedSteps::KeyOf(const graph::Edge& edge) {
  EdgeKey key;
  for (const graph::Point* end : {&edge.from, &edge.to}) {
    for (const double number : *end) key.push_back(std::llround(number / kSameEnd));
  }
  return key;
}

void PlannedSteps::Suggest(const graph::Edge& edge, std::vector<Footstep> steps,
                           double most_duration) const {
  const std::lock_guard lock(mutex_);
  suggested_.insert_or_assign(KeyOf(edge), Suggestion{std::move(steps), most_duration});
}

PlannedSteps::Suggestion PlannedSteps::SuggestedFor(const EdgeKey& key) const {
  const std::lock_guard lock(mutex_);
  const auto suggested = suggested_.find(key);
  return suggested == suggested_.end() ? Suggestion() : suggested->second;
}

std::vector<Footstep> PlannedSteps::Search(const GroundedStance& from, const GroundedStance& to,
                                           const FootstepLimits& limits,
                                           const StepRefusals& refusals, std::int64_t states,
                                           Effort* effort,
                                           const CancellationToken& cancellation) const {
  FootstepSearch search(model(), this->from(), world(), FootstepEnds{{from}, {to}, {}, {}}, limits,
                        known_ground(), cancellation);
  search.most_states = std::min(states, effort->states);
  search.is_refused = [&refusals](const Footstep& step, const Foothold& rest) {
    return refusals.Refuses(step, rest);
  };
  FootstepSearch::Status status = FootstepSearch::Status::kSearching;
  while (status == FootstepSearch::Status::kSearching) {
    status = search.Advance(kStatesPerQuestion, cancellation);
  }
  effort->states -= search.states();
  effort->proves_none = search.ProvesNone();
  return status == FootstepSearch::Status::kFound ? search.steps() : std::vector<Footstep>();
}

/// The trunk is not always what hits: without other steps there is nothing to build anew.
std::vector<Footstep> PlannedSteps::StepsFartherAway(const GroundedStance& from,
                                                     const GroundedStance& to,
                                                     const std::vector<Footstep>& steps,
                                                     const StepRefusals& refusals,
                                                     FootstepLimits* limits, Effort* effort,
                                                     const CancellationToken& cancellation) const {
  while (limits->trunk_margin < kFarthestAway) {
    limits->trunk_margin += kAway;
    std::vector<Footstep> others =
        Search(from, to, *limits, refusals, effort->each / kShareFartherAway, effort, cancellation);
    if (!AreSame(others, steps)) return others;
  }
  return {};
}

void PlannedSteps::Refuse(const FootstepError& error, const Footstep& step, const Foothold& rest,
                          StepRefusals* refusals) {
  switch (error.part()) {
    case FootstepError::Part::kStep:
      refusals->Add(step, rest);
      break;
    case FootstepError::Part::kFrom:
      refusals->AddEnd(step.from, rest);
      break;
    case FootstepError::Part::kTo:
      refusals->AddEnd(step.to, rest);
      break;
  }
}

std::optional<double> PlannedSteps::HighestRoot(std::vector<Foothold> feet,
                                                const Footstep& step) const {
  const auto before = reach_.HighestRoot(feet, step.limb);
  feet[step.limb] = step.to;
  const auto after = reach_.HighestRoot(feet, step.limb);
  if (!before || !after) return std::nullopt;
  return std::min(*before, *after);
}

bool PlannedSteps::SinkLow(const GroundedStance& from, const std::vector<Footstep>& steps) const {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::vector<Foothold> feet =
        FeetBefore(from, stance().gait->limbs.size(), steps, static_cast<int>(i));
    const std::optional<double> root = HighestRoot(feet, steps[i]);
    if (!root || *root < limits_.usual_root) return true;
  }
  return false;
}

PlannedSteps::Effort PlannedSteps::FullEffort() const {
  const int doublings = doublings_;
  return {kSequences << doublings, kStates << doublings, kStatesOfOne << doublings};
}

PlannedSteps::Outcome PlannedSteps::Plan(const GroundedStance& from, const GroundedStance& to,
                                         const Suggestion& suggestion,
                                         const CancellationToken& cancellation) const {
  Suggestion first = suggestion;
  if (models::HasRotors(*model().robot)) {
    Effort sparing = FullEffort();
    sparing.sequences = kSparingSequences;
    Outcome outcome = PlanWithin(kSparingTorque, sparing, from, to, &first, cancellation);
    if (outcome.fault.empty()) return outcome;
  }
  return PlanWithin(1, FullEffort(), from, to, &first, cancellation);
}

PlannedSteps::Outcome PlannedSteps::PlanWithin(double most_torque, Effort effort,
                                               const GroundedStance& from, const GroundedStance& to,
                                               Suggestion* suggestion,
                                               const CancellationToken& cancellation) const {
  using Breadth = StepRefusals::Breadth;
  std::vector<Footstep> steps = suggestion->steps;
  StepRefusals refusals(doublings_ > 0 ? Breadth::kSame : Breadth::kBeyond);
  FootstepLimits limits = limits_;
  Outcome outcome;
  outcome.fault = "no footholds";
  const double upright = stance().gait->posture.root_height;
  double lowest = limits_.lowest_root;
  bool is_first = true;
  int taller = 0;
  while (effort.sequences-- > 0) {
    if (steps.empty()) {
      steps = Search(from, to, limits, refusals, effort.each, &effort, cancellation);
      if (steps.empty()) {
        outcome.is_decided = effort.proves_none;
        if (outcome.is_decided || limits.lowest_root == lowest) return outcome;
        limits.lowest_root = lowest;
        taller = kMostTaller;
        continue;
      }
      if (suggestion->steps.empty()) suggestion->steps = steps;
    }
    if (is_first && doublings_ == 0) {
      // Where usual steps exist, lower ones seldom do better: they are left to greater efforts. Low
      // ones seldom do at all, and another route may not need them.
      if (SinkLow(from, steps)) {
        effort.sequences = std::min(effort.sequences, kLowSequences);
      } else {
        lowest = limits.lowest_root = std::max(lowest, limits_.usual_root);
      }
    }
    is_first = false;
    if (ExpectedDuration(steps) > suggestion->most_duration) {
      outcome.fault += "; other steps take too long";
      outcome.is_decided = true;
      return outcome;
    }
    try {
      outcome.motion = FreeMotion(from, steps, most_torque, cancellation);
      outcome.fault.clear();
      return outcome;
    } catch (const FootstepError& error) {
      outcome.fault = error.what();
      if (error.step() < 0) return outcome;
      if (error.is_hit()) {
        std::vector<Footstep> away =
            StepsFartherAway(from, to, steps, refusals, &limits, &effort, cancellation);
        if (!away.empty()) {
          steps = std::move(away);
          continue;
        }
      }
      const Footstep& step = steps[error.step()];
      const std::vector<Foothold> feet =
          FeetBefore(from, stance().gait->limbs.size(), steps, error.step());
      Refuse(error, step, RestOf(feet, step.limb), &refusals);
      const double root = HighestRoot(feet, step).value_or(limits.lowest_root);
      if (root < upright && taller < kMostTaller) {
        ++taller;
        limits.lowest_root = std::max(limits.lowest_root, std::min(root + kTaller, upright));
      }
      steps.clear();
    }
  }
  return outcome;
}

bool PlannedSteps::AskAgain(std::vector<graph::Edge>* edges) {
  if (doublings_ == kMostDoublings) return false;
  edges->clear();
  const std::lock_guard lock(mutex_);
  std::erase_if(outcomes_, [edges](const auto& entry) {
    const Outcome& outcome = entry.second;
    if (outcome.fault.empty() || outcome.is_decided) return false;
    edges->push_back(outcome.edge);
    return true;
  });
  if (edges->empty() && !is_cut_short_.exchange(false)) return false;
  ++doublings_;
  return true;
}

std::vector<Phase> PlannedSteps::Motion(const graph::Edge& edge,
                                        const CancellationToken& cancellation) const {
  const std::optional<GroundedStance> from = LaunchStance(edge.from);
  const std::optional<GroundedStance> to = LandingStance(edge.to);
  if (!from || !to) throw MotionError("the edge is no '" + name() + "'");
  const EdgeKey key = KeyOf(edge);
  {
    const std::lock_guard lock(mutex_);
    const auto known = outcomes_.find(key);
    if (known != outcomes_.end()) {
      if (!known->second.fault.empty()) throw MotionError(known->second.fault);
      return known->second.motion;
    }
  }
  Outcome outcome = Plan(*from, *to, SuggestedFor(key), cancellation);
  outcome.edge = edge;
  const std::lock_guard lock(mutex_);
  const Outcome& kept = outcomes_.emplace(key, std::move(outcome)).first->second;
  if (!kept.fault.empty()) throw MotionError(kept.fault);
  return kept.motion;
}

}  // namespace possibility::actions
