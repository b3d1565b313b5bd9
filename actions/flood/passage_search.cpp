#include "actions/flood/passage_search.h"

#include <utility>

#include "actions/flood/passage_gauge.h"
#include "actions/flood/sufficient_flood.h"

namespace possibility::actions {
namespace {

constexpr double kMostLeniency = 0.3;  // m
/// Determines the leniency to 2 cm.
constexpr int kPassageHalvings = 4;
constexpr std::int64_t kMostJudged = 200'000;

}  // namespace

std::optional<NarrowPassage> SearchPassage(const LocomotionModel& model, const World& world,
                                           const GroundedStance& start,
                                           const std::vector<GroundedStance>& goals,
                                           double resolution,
                                           const std::vector<FloodManoeuvre>& manoeuvres,
                                           const CancellationToken& cancellation) {
  const auto way_with = [&](double leniency) {
    return FloodSufficient(model, world, start, goals,
                           {.resolution = resolution, .halvings = 2, .leniency = leniency},
                           {.most_judged = kMostJudged, .cancellation = cancellation}, manoeuvres)
        .way;
  };
  double closed = 0, open = kMostLeniency;
  std::vector<GroundedStance> way = way_with(open);
  if (way.empty()) return std::nullopt;
  for (int i = 0; i < kPassageHalvings; ++i) {
    const double middle = (closed + open) / 2;
    std::vector<GroundedStance> narrower = way_with(middle);
    if (narrower.empty()) {
      closed = middle;
    } else {
      open = middle;
      way = std::move(narrower);
    }
  }
  return PassageGauge(model, world, manoeuvres).Narrowest(way, cancellation);
}

}  // namespace possibility::actions
