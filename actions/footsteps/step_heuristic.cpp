#include "actions/footsteps/step_heuristic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "actions/footholds/foothold_flood.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Expected by the field of footholds, s/m: high steps, low roots, a second foot that follows.
constexpr double kSecondsPerMetreClimbed = 12;

/// Of the field of poses, where no footholds give it, m.
constexpr double kCell = 0.06;

}  // namespace

StepHeuristic::StepHeuristic(const StepRules& rules, const StepGround& known, const World& world,
                             const StepGoals& goals, const std::vector<GroundedStance>& starts,
                             bool is_relaxed)
    : rules_(rules), known_(known), world_(world), goals_(goals), is_relaxed_(is_relaxed) {
  if (known.cells) {
    footholds_.emplace(*known.cells, rules.stance(), world, rules.limits(), goals.stances,
                       goals.times, TimesOfSteps());
  }
  poses_.emplace(PosesField(starts));
}

bool StepHeuristic::IsBest(int goal) {
  const GroundedStance& stance = goals_.stances[goal];
  return goals_.TimeFrom(goal) <= At(LayerUnder(0, {stance.pose, stance.z}), stance.pose) + 1e-9;
}

/// Of n limbs each goes 2/n as far ahead of the middle as it goes ahead of the others. Of two limbs
/// aside and in turns one makes a step and the other closes up.
PoseField::Paces StepHeuristic::PacesOfPoses() const {
  const FootstepLimits& limits = rules_.limits();
  const double steps = rules_.NumLimbs() / 2.0;
  const double closing = rules_.NumLimbs() == 2 ? 2 : 1;
  return {steps * kLevelStep / limits.forward, closing * steps * kLevelStep / limits.lateral,
          closing * steps * kLevelStep / limits.turn};
}

PoseField StepHeuristic::PosesField(const std::vector<GroundedStance>& starts) {
  std::vector<PoseField::Goal> places;
  for (std::size_t i = 0; i < goals_.stances.size(); ++i) {
    const int layer = LayerUnder(0, {goals_.stances[i].pose, goals_.stances[i].z});
    if (layer >= 0)
      places.push_back({goals_.stances[i].pose, layer, goals_.TimeFrom(static_cast<int>(i))});
  }
  std::vector<PoseField::Start> asked;
  for (const GroundedStance& start : starts) {
    const int layer = LayerUnder(0, {start.pose, start.z});
    if (layer >= 0) asked.push_back({start.pose, layer});
  }
  PoseField::Ground known;
  known.layers = static_cast<int>(rules_.ground().planes().size());
  known.most = std::numeric_limits<double>::infinity();
  if (footholds_) {
    known.time = [this](int layer, const Vector2d& p) { return footholds_->Near(layer, p); };
    if (!is_relaxed_) known.most = footholds_->LongestStep();
  }
  return PoseField(
      world_.environment->bounds, known_.room ? known_.room->cell() : kCell, known_.first_heading(),
      places, PacesOfPoses(),
      [this](int layer, const PlanarPose& pose) { return MayStandAt(layer, pose); }, known, asked);
}

int StepHeuristic::LayerUnder(int limb, const Foothold& place) const {
  const Vector2d centre = place.stance * Vector2d(rules_.stance().patch_centres[limb].head<2>());
  for (std::size_t layer = 0; layer < rules_.ground().planes().size(); ++layer) {
    const models::GroundPlane& plane = world_.ground->planes()[rules_.ground().planes()[layer]];
    const bool is_alike = plane.normal == place.normal && plane.friction == place.friction;
    if (is_alike && std::abs(plane.HeightAt(centre) - place.z) < 1e-6) {
      return static_cast<int>(layer);
    }
  }
  return -1;
}

/// What the legs' reach leaves of the family.
FootholdField::StepTimes StepHeuristic::TimesOfSteps() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FootholdField::StepTimes steps;
  steps.pace = kLevelStep / rules_.limits().forward;
  const auto distances = static_cast<std::size_t>(
      std::ceil(FootholdFlood::ReachOf(rules_.stance(), rules_.limits()) / steps.spacing) + 1);
  for (int row = 0; row * steps.spacing <= rules_.limits().rise + steps.spacing / 2; ++row) {
    const double rise = std::min(row * steps.spacing, rules_.limits().rise);
    std::vector<double> times(distances, kInfinity);
    for (const int limb : {0, 1}) {
      for (const PlanarPose& displacement : rules_.displacements(limb)) {
        for (const double z : {rise, -rise}) AddStep(limb, displacement, z, steps, &times);
      }
    }
    // Where a long step leads, shorter ones do.
    for (std::size_t i = distances - 1; i > 0; --i) {
      times[i - 1] = std::min(times[i - 1], times[i]);
    }
    // Places may be moved.
    if (is_relaxed_) {
      const auto moved =
          static_cast<std::ptrdiff_t>(std::ceil(FootholdGround::kMostShift / steps.spacing));
      times.insert(times.begin(), moved, times.front());
    }
    steps.times.push_back(std::move(times));
  }
  return steps;
}

void StepHeuristic::AddStep(int limb, const PlanarPose& displacement, double rise,
                            const FootholdField::StepTimes& steps,
                            std::vector<double>* times) const {
  std::vector<Foothold> feet(2);
  feet[limb] = {displacement, rise};
  const std::optional<double> before = rules_.Squat(feet, limb);
  const std::optional<double> after = rules_.Squat(feet, 1 - limb);
  if (!before || !after) return;
  const Vector2d centre = displacement * Vector2d(rules_.stance().patch_centres[limb].head<2>());
  const double distance = (centre - rules_.stance().patch_centres[1 - limb].head<2>()).norm();
  double& time = (*times)[std::lround(distance / steps.spacing)];
  time = std::min(time, std::max(kLevelStep, steps.pace * distance) +
                            rules_.StrideTime(displacement.x, rise == 0) +
                            std::max(kSecondsPerMetreClimbed * std::abs(rise),
                                     StepRules::kSecondsPerSquat * std::max(*before, *after)));
}

bool StepHeuristic::MayStandAt(int layer, const PlanarPose& pose) {
  const models::GroundPlane& plane = world_.ground->planes()[rules_.ground().planes()[layer]];
  if (known_.room ? !is_relaxed_ && !known_.room->IsAt(layer, pose)
                  : !world_.ground->IsNear(rules_.ground().planes()[layer], pose.position(),
                                           rules_.Extent())) {
    return false;
  }
  return rules_.TrunkIsFree(pose, plane.HeightAt(pose.position()));
}

}  // namespace possibility::actions
