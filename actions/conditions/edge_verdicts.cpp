#include "actions/conditions/edge_verdicts.h"

#include "actions/conditions/exploration_pose.h"

namespace possibility::actions {
namespace {

bool SameEdge(const graph::Edge& a, const graph::Edge& b) {
  return IsSamePose(a.from, b.from) && IsSamePose(a.to, b.to);
}

}  // namespace

void EdgeVerdicts::Record(const graph::Edge& edge, bool possible, const std::string& reason) {
  const std::lock_guard lock(mutex_);
  for (Verdict& verdict : verdicts_) {
    if (!SameEdge(verdict.edge, edge)) continue;
    verdict = {edge, possible, reason};
    return;
  }
  verdicts_.push_back({edge, possible, reason});
}

void EdgeVerdicts::Forget(const graph::Edge& edge) {
  const std::lock_guard lock(mutex_);
  std::erase_if(verdicts_, [&](const Verdict& verdict) { return SameEdge(verdict.edge, edge); });
}

std::optional<bool> EdgeVerdicts::On(const graph::Edge& edge) const {
  const std::lock_guard lock(mutex_);
  for (const Verdict& verdict : verdicts_) {
    if (SameEdge(verdict.edge, edge)) return verdict.possible;
  }
  return std::nullopt;
}

std::vector<Refusal> EdgeVerdicts::Refusals() const {
  const std::lock_guard lock(mutex_);
  std::vector<Refusal> refusals;
  for (const Verdict& verdict : verdicts_) {
    if (!verdict.possible) refusals.push_back({verdict.edge, verdict.reason});
  }
  return refusals;
}

}  // namespace possibility::actions
