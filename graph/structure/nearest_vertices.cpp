#include "graph/structure/nearest_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace possibility::graph {
namespace {

/// Pivots are chosen among at most this many evenly spaced vertices.
constexpr std::size_t kCandidates = 256;

/// Bound of the relative rounding error of tabulated distances (float), with a factor of at least
/// two to spare.
constexpr double kRounding = 2.5e-7;

}  // namespace

/// State of one search: the best vertex so far, and the data of the bounds.
struct NearestVertices::Best {
  const Point* target;
  std::array<float, kPivots> from_pivot = {};  ///< distances of the target from the pivots
  double margin = 0;                           ///< what rounding may add to a bound
  double distance = std::numeric_limits<double>::infinity();
  std::optional<VertexId> vertex = {};
};

void NearestVertices::Insert(VertexId vertex, const Point& point) {
  vertices_.push_back(vertex);
  points_.push_back(point);
  if (points_.size() >= next_choice_) {
    ChoosePivots();
    next_choice_ = 4 * points_.size();
  } else {
    Tabulate(points_.size() - 1);
  }
}

/// Each pivot is the candidate farthest from all pivots before it.
void NearestVertices::ChoosePivots() {
  pivots_.clear();
  blocks_.clear();
  const std::size_t spacing = (points_.size() + kCandidates - 1) / kCandidates;
  std::vector<double> clearance(points_.size(), std::numeric_limits<double>::infinity());
  std::size_t next = 0;
  while (pivots_.size() < kPivots) {
    pivots_.push_back(points_[next]);
    for (std::size_t i = 0; i < points_.size(); i += spacing) {
      clearance[i] = std::min(clearance[i], space_->Distance(points_[i], pivots_.back()));
      if (clearance[i] > clearance[next]) next = i;
    }
  }
  for (std::size_t i = 0; i < points_.size(); ++i) Tabulate(i);
}

void NearestVertices::Tabulate(std::size_t index) {
  if (index / kBlock >= blocks_.size()) blocks_.push_back(Block::Zero());
  for (std::size_t j = 0; j < pivots_.size(); ++j) {
    const double distance = space_->Distance(pivots_[j], points_[index]);
    blocks_[index / kBlock](index % kBlock, j) = static_cast<float>(distance);
  }
}

std::optional<VertexId> NearestVertices::Closest(const Point& p, const Filter& admits) const {
  Best best{.target = &p};
  for (std::size_t j = 0; j < pivots_.size(); ++j) {
    best.from_pivot[j] = static_cast<float>(space_->Distance(pivots_[j], p));
    best.margin = std::max(best.margin, kRounding * best.from_pivot[j]);
  }
  for (std::size_t block = 0; block < blocks_.size(); ++block) LookThrough(block, admits, &best);
  return best.vertex;
}

void NearestVertices::LookThrough(std::size_t block, const Filter& admits, Best* best) const {
  Eigen::Array<float, kBlock, 1> bound = Eigen::Array<float, kBlock, 1>::Zero();
  for (std::size_t j = 0; j < pivots_.size(); ++j) {
    bound = bound.max((blocks_[block].col(j) - best->from_pivot[j]).abs());
  }
  const std::size_t first = block * kBlock;
  const std::size_t last = std::min(first + kBlock, points_.size());
  for (std::size_t i = first; i < last; ++i) {
    // Subtract what rounding may have added to the bound.
    const double sure = bound[i - first] * (1 - kRounding) - best->margin;
    if (sure >= best->distance || (admits && !admits(vertices_[i]))) continue;
    const double distance = space_->Distance(points_[i], *best->target);
    if (distance < best->distance) {
      best->distance = distance;
      best->vertex = vertices_[i];
    }
  }
}

}  // namespace possibility::graph
