#include "collocation/study/mesh_refinement.h"

#include <algorithm>
#include <cmath>

namespace possibility::collocation {

namespace {

/// In how many parts an interval is split.
int Parts(double error, const MeshRule& rule) {
  constexpr int kMostParts = 4;
  if (!(error > rule.tolerance)) return 1;
  // The error of an interval is proportional to its length to the power order + 1.
  const double wanted = std::ceil(std::pow(error / rule.tolerance, 1.0 / (rule.order + 1)));
  return std::isfinite(wanted) ? std::clamp(static_cast<int>(wanted), 2, kMostParts) : kMostParts;
}

/// How many intervals from i on may become one. The greatest of their errors is stretched to the
/// length of all.
std::size_t Mergeable(const Mesh& mesh, const std::vector<MeshError>& errors, std::size_t i,
                      const MeshRule& rule) {
  constexpr std::size_t kMost = 4;
  constexpr double kReserve = 0.1;
  double density = 0;  // error of an interval of length 1
  std::size_t count = 0;
  while (count < kMost && i + count < errors.size()) {
    const std::size_t next = i + count;
    density = std::max(
        density, errors[next].Greatest() / std::pow(mesh[next + 1] - mesh[next], rule.order + 1));
    const double merged = density * std::pow(mesh[next + 1] - mesh[i], rule.order + 1);
    if (!(merged <= kReserve * rule.tolerance)) break;
    ++count;
  }
  return std::max<std::size_t>(count, 1);
}

}  // namespace

Mesh Coarse(const Mesh& mesh) {
  constexpr std::size_t kFactor = 5;
  constexpr std::size_t kLeast = 4;
  const std::size_t intervals = mesh.size() - 1;
  const std::size_t count = std::max(intervals / kFactor, std::min(intervals, kLeast));
  Mesh coarse;
  for (std::size_t i = 0; i <= count; ++i) coarse.push_back(mesh[i * intervals / count]);
  return coarse;
}

Mesh Refined(const Mesh& mesh, const std::vector<MeshError>& errors, const MeshRule& rule) {
  Mesh refined = {mesh.front()};
  for (std::size_t i = 0; i + 1 < mesh.size(); ++i) {
    const int parts = Parts(errors[i].Greatest(), rule);
    for (int part = 1; part < parts; ++part) {
      refined.push_back(mesh[i] + (mesh[i + 1] - mesh[i]) * part / parts);
    }
    if (rule.coarsen) i += Mergeable(mesh, errors, i, rule) - 1;
    refined.push_back(mesh[i + 1]);
  }
  return refined;
}

Mesh WithKnotsAtJumps(const Mesh& refined, const Mesh& old, const std::vector<ControlJump>& jumps,
                      double tolerance) {
  Mesh mesh, added;
  for (const double knot : refined) {
    const bool is_inside = std::any_of(jumps.begin(), jumps.end(), [&](const ControlJump& jump) {
      return knot > jump.begin && knot < jump.end;
    });
    if (!is_inside) mesh.push_back(knot);
  }
  for (const ControlJump& jump : jumps) {
    added.insert(added.end(), {jump.begin, jump.end});
    const double width = jump.end - jump.begin;
    if (width <= tolerance) {
      std::copy_if(old.begin(), old.end(), std::back_inserter(added),
                   [&](double knot) { return knot > jump.begin && knot < jump.end; });
      continue;
    }
    for (const double part : {-1.0 / 8, -1.0 / 32, 1.0 / 32, 1.0 / 8}) {
      const double knot = jump.share + part * width;
      const double to_end = std::min(knot - jump.begin, jump.end - knot);
      if (to_end > width / 64) added.push_back(knot);
    }
  }
  mesh.insert(mesh.end(), added.begin(), added.end());
  std::sort(mesh.begin(), mesh.end());
  mesh.erase(std::unique(mesh.begin(), mesh.end()), mesh.end());
  return mesh;
}

}  // namespace possibility::collocation
