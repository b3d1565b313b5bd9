#include "experiments/report/plan_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "experiments/report/action_colors.h"
#include "models/mesh/convex_merge.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector2d;

constexpr double kMargin = 0.15;      // m, around the bounds
constexpr double kLineWidth = 0.004;  // of the scene's larger extent

/// A surface of more triangles is drawn as its outline: pictures of every piece would be megabytes.
constexpr std::size_t kMostDrawn = 2000;

bool IsTooFine(const models::Environment& environment, const models::Obstacle& obstacle) {
  return obstacle.surface >= 0 &&
         environment.surfaces[obstacle.surface].mesh.triangles.size() > kMostDrawn;
}

/// Around a surface as seen from above.
std::vector<Vector2d> OutlineOf(const models::Surface& surface) {
  std::vector<Vector2d> corners;
  for (const Eigen::Vector3d& vertex : surface.mesh.vertices) corners.push_back(vertex.head<2>());
  return models::HullOf(std::move(corners), 0);
}

/// Corners of a shape's vertical projection, counter-clockwise: its support points in directions
/// all around.
std::vector<Vector2d> Shadow(const models::Obstacle& obstacle) {
  constexpr int kDirections = 48;
  std::vector<Vector2d> corners;
  for (int i = 0; i < kDirections; ++i) {
    // Off the axes, so that the support point of an upright box is a corner, never a point on a
    // side.
    const double angle = 2 * M_PI * (i + 0.37) / kDirections;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0);
    const Eigen::Vector3d local = obstacle.X_WO.linear().transpose() * direction;
    const Vector2d corner = (obstacle.X_WO * obstacle.shape.Support(local)).head<2>();
    if (corners.empty() || (corner - corners.back()).norm() > 1e-9) corners.push_back(corner);
  }
  return corners;
}

/// Points in the picture's frame: metres, y downward.
std::string Points(const std::vector<Vector2d>& points) {
  std::string text;
  for (const Vector2d& point : points) text += fmt::format("{:.3f},{:.3f} ", point.x(), -point.y());
  return text;
}

std::string Obstacles(const models::Environment& environment, bool ground) {
  std::string svg;
  for (const models::Obstacle& obstacle : environment.obstacles) {
    if (obstacle.is_ground != ground || IsTooFine(environment, obstacle)) continue;
    svg += fmt::format("<polygon points=\"{}\" class=\"{}\"/>\n", Points(Shadow(obstacle)),
                       ground ? "ground" : "obstacle");
  }
  for (const models::Surface& surface : environment.surfaces) {
    if (surface.is_ground != ground || surface.mesh.triangles.size() <= kMostDrawn) continue;
    svg += fmt::format("<polygon points=\"{}\" class=\"{}\"/>\n", Points(OutlineOf(surface)),
                       ground ? "ground" : "obstacle");
  }
  return svg;
}

/// Holes are clockwise, so they stay open under either fill rule.
std::string Reached(const actions::Barrier& barrier) {
  std::string svg;
  for (const actions::ReachedRegion& region : barrier.reached) {
    std::string path;
    for (const std::vector<Vector2d>& outline : region.outlines) {
      path += fmt::format("M{}Z", Points(outline));
    }
    const std::string color = ActionColor(region.action);
    svg += fmt::format("<path d=\"{}\" class=\"reached\" fill=\"{}\" stroke=\"{}\"/>\n", path,
                       color, color);
  }
  return svg;
}

/// The shapes that block the way, and the point where they do.
std::string Closed(const actions::Barrier& barrier, const models::Environment& environment,
                   double dot) {
  std::string svg;
  for (const models::Obstacle& obstacle : environment.obstacles) {
    const auto& names = barrier.closed_by;
    if (IsTooFine(environment, obstacle)) continue;
    if (std::find(names.begin(), names.end(), obstacle.name) == names.end()) continue;
    svg += fmt::format("<polygon points=\"{}\" class=\"barrier\"/>\n", Points(Shadow(obstacle)));
  }
  return svg + fmt::format("<circle cx=\"{:.3f}\" cy=\"{:.3f}\" r=\"{:.3f}\" class=\"closest\"/>\n",
                           barrier.closest.x(), -barrier.closest.y(), dot);
}

std::string No(const std::optional<actions::NoPlan>& no, const models::Environment& environment,
               double dot) {
  if (!no || !no->barrier) return {};
  return Reached(*no->barrier) + Closed(*no->barrier, environment, dot);
}

std::string Graph(const actions::ExploredGraph& graph) {
  // One path element per action: a graph may have tens of thousands of edges.
  std::vector<std::pair<std::string, std::string>> paths;
  for (const actions::ExploredGraph::Edge& edge : graph.edges) {
    auto path = std::find_if(paths.begin(), paths.end(),
                             [&](const auto& item) { return item.first == edge.action; });
    if (path == paths.end()) path = paths.insert(paths.end(), {edge.action, ""});
    const Eigen::Vector3d& from = graph.vertices[edge.from].position;
    const Eigen::Vector3d& to = graph.vertices[edge.to].position;
    path->second +=
        fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}", from.x(), -from.y(), to.x(), -to.y());
  }
  std::string svg;
  for (const auto& [action, path] : paths) {
    svg +=
        fmt::format("<path d=\"{}\" class=\"edge\" stroke=\"{}\"/>\n", path, ActionColor(action));
  }
  return svg;
}

/// The pelvis' path within one segment, a point every few centimetres.
std::vector<Vector2d> Path(const actions::Segment& segment) {
  constexpr double kSpacing = 0.02;  // m
  std::vector<Vector2d> path;
  for (const actions::Phase& phase : segment.phases) {
    for (const actions::Knot& knot : phase.knots) {
      const Vector2d point = knot.q.segment<2>(4);
      const bool is_last = &phase == &segment.phases.back() && &knot == &phase.knots.back();
      if (path.empty() || is_last || (point - path.back()).norm() > kSpacing) path.push_back(point);
    }
  }
  return path;
}

std::string Route(const actions::Plan& plan, double dot) {
  std::string svg;
  std::vector<Vector2d> ends;
  for (const actions::Segment& segment : plan.segments) {
    const std::vector<Vector2d> path = Path(segment);
    if (path.empty()) continue;
    svg += fmt::format("<polyline points=\"{}\" class=\"route\" stroke=\"{}\"/>\n", Points(path),
                       ActionColor(segment.action));
    if (ends.empty()) ends.push_back(path.front());
    ends.push_back(path.back());
  }
  if (ends.empty()) return svg;
  svg += fmt::format("<circle cx=\"{:.3f}\" cy=\"{:.3f}\" r=\"{:.3f}\" fill=\"#212529\"/>\n",
                     ends.front().x(), -ends.front().y(), dot);
  return svg + fmt::format("<circle cx=\"{:.3f}\" cy=\"{:.3f}\" r=\"{:.3f}\" class=\"goal\"/>\n",
                           ends.back().x(), -ends.back().y(), dot);
}

}  // namespace

std::string PlanPicture(const actions::Plan& plan, const models::Environment& environment,
                        double width) {
  const Vector2d low = environment.bounds.min().array() - kMargin;
  const Vector2d extent = environment.bounds.max() - low + Vector2d::Constant(kMargin);
  const double line = kLineWidth * extent.maxCoeff();
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "viewBox=\"{:.3f} {:.3f} {:.3f} {:.3f}\">\n"
      "<style>.ground{{fill:#f1f3f5}}.obstacle{{fill:#495057;fill-opacity:.75}}"
      ".edge{{fill:none;stroke-width:{:.4f};stroke-opacity:.45}}"
      ".route{{fill:none;stroke-width:{:.4f};stroke-linejoin:round;stroke-linecap:round}}"
      ".goal{{fill:white;stroke:#212529;stroke-width:{:.4f}}}"
      ".reached{{fill-opacity:.2;stroke-width:{:.4f}}}.barrier{{fill:#e03131;fill-opacity:.85}}"
      ".closest{{fill:none;stroke:#e03131;stroke-width:{:.4f}}}</style>\n"
      "<rect x=\"{:.3f}\" y=\"{:.3f}\" width=\"{:.3f}\" height=\"{:.3f}\" fill=\"#dee2e6\"/>\n"
      "{}{}{}{}{}</svg>\n",
      width, width * extent.y() / extent.x(), low.x(), -low.y() - extent.y(), extent.x(),
      extent.y(), 0.3 * line, 2 * line, line, 0.5 * line, line, low.x(), -low.y() - extent.y(),
      extent.x(), extent.y(), Obstacles(environment, true), Obstacles(environment, false),
      Graph(plan.explored), No(plan.no, environment, 2.5 * line), Route(plan, 2.5 * line));
}

}  // namespace possibility::experiments
