#include "actions/flood/block_flood.h"

#include <algorithm>
#include <utility>

namespace possibility::actions {
namespace {

/// Thrown when a flood reaches its limits.
struct CutShort {};

}  // namespace

BlockFlood::BlockFlood(int planes, double nx, double ny, CellQuadtrees::Judge judge,
                       FloodLimits limits)
    : judge_(std::move(judge)), limits_(std::move(limits)), planes_(planes), nx_(nx), ny_(ny) {}

BlockState BlockFlood::Judge(const CellBlock& block) {
  if (++judged_ > limits_.most_judged) throw CutShort();
  if (!limits_.cancellation.Proceed()) throw CutShort();
  return judge_(block);
}

void BlockFlood::Enter(const CellBlock& block) {
  const auto index = static_cast<std::int32_t>(reached_.size());
  reached_.push_back({block, current_});
  open_.push({static_cast<float>(distance_(block)), index});
}

void BlockFlood::Offer(const CellBlock& block, const Lead& leads_there) {
  cells_->Offer(block, leads_there, [this](const CellBlock& entered) { Enter(entered); });
}

FloodEnd BlockFlood::Run(const CellBlock& seed,
                         const std::function<bool(const CellBlock&)>& is_goal,
                         const std::function<double(const CellBlock&)>& distance,
                         const std::function<void(const CellBlock&)>& expand,
                         const std::function<void(const CellBlock&)>& expand_late) try {
  if (!(std::max(nx_, ny_) <= CellQuadtrees::kMostAlong)) return FloodEnd::kCutShort;
  CellQuadtrees cells(planes_, static_cast<int>(nx_), static_cast<int>(ny_),
                      FloodLimits::kMostNodes,
                      [this](const CellBlock& block) { return Judge(block); });
  cells_ = &cells;
  distance_ = distance;
  cells.Seed(seed.plane, seed.x0, seed.y0, [this](const CellBlock& block) { Enter(block); });
  while (!open_.empty() || !late_.empty()) {
    const bool is_late = open_.empty();
    current_ = is_late ? late_.front() : open_.top().reached;
    const CellBlock block = reached_[current_].block;
    if (is_late) {
      late_.pop_front();
      expand_late(block);
      continue;
    }
    open_.pop();
    if (is_goal(block)) {
      goal_ = current_;
      return FloodEnd::kGoal;
    }
    if (!limits_.cancellation.Proceed()) return FloodEnd::kCutShort;
    late_.push_back(current_);
    expand(block);
  }
  return FloodEnd::kNothingLeft;
} catch (const CutShort&) {
  return FloodEnd::kCutShort;
} catch (const TooManyCells&) {
  return FloodEnd::kCutShort;
}

std::vector<CellBlock> BlockFlood::WayToGoal() const {
  std::vector<CellBlock> way;
  for (std::int32_t i = goal_; i >= 0; i = reached_[i].from) way.push_back(reached_[i].block);
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace possibility::actions
