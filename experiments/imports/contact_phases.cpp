#include "experiments/imports/contact_phases.h"

#include <algorithm>
#include <utility>

namespace possibility::experiments {
namespace {

using Bears = std::vector<bool>;

Bears Both(const Bears& a, const Bears& b) {
  Bears both(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) both[i] = a[i] && b[i];
  return both;
}

bool Any(const Bears& bears) { return std::find(bears.begin(), bears.end(), true) != bears.end(); }

/// Closes the time between the phase and the next one, whose first sample follows at once. Appends
/// a phase of its own if neither of the two may take it.
void Join(ImportedPhase* next, std::vector<ImportedPhase>* phases) {
  ImportedPhase& phase = phases->back();
  const int before = phase.samples.back();
  const int after = next->samples.front();
  const Bears both = Both(phase.bears, next->bears);
  if (both == next->bears) {
    next->samples.insert(next->samples.begin(), before);
  } else if (both == phase.bears || !Any(both)) {
    phase.samples.push_back(after);
  } else {
    phases->push_back({phase.segment, both, {before, after}});
  }
}

}  // namespace

bool ImportedPhase::AnyBears() const { return Any(bears); }

std::vector<std::pair<int, int>> SteadyRuns(const ImportedTrajectory& trajectory) {
  const auto& samples = trajectory.samples;
  std::vector<std::pair<int, int>> runs;
  int begin = 0;
  for (int i = 1; i <= static_cast<int>(samples.size()); ++i) {
    const bool goes_on = i < static_cast<int>(samples.size()) && !SharesTime(trajectory, i - 1) &&
                         samples[i].bears == samples[begin].bears &&
                         samples[i].segment == samples[begin].segment;
    if (goes_on) continue;
    runs.emplace_back(begin, i);
    begin = i;
  }
  return runs;
}

std::vector<ImportedPhase> CutIntoPhases(const ImportedTrajectory& trajectory) {
  std::vector<ImportedPhase> phases;
  for (const auto& [begin, end] : SteadyRuns(trajectory)) {
    const ImportedSample& first = trajectory.samples[begin];
    ImportedPhase next{first.segment, first.bears, {}};
    for (int i = begin; i < end; ++i) next.samples.push_back(i);
    if (begin > 0 && !SharesTime(trajectory, begin - 1)) Join(&next, &phases);
    phases.push_back(std::move(next));
  }
  // A single sample lasts no time.
  std::erase_if(phases, [](const ImportedPhase& phase) { return phase.samples.size() < 2; });
  return phases;
}

}  // namespace possibility::experiments
