#include "models/shapes/convex_hull.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

constexpr double kOnFacet = 1e-9;  // of the extent
constexpr double kFlat = 1e-6;     // likewise

/// A facet with the points outside of it that no facet before has taken.
struct Facet {
  std::array<int, 3> corners;
  std::array<int, 3> neighbours;  ///< [i]: across the edge from corner i to corner i + 1
  Vector3d normal;
  double offset = 0;
  std::vector<int> outside;
  int farthest = -1;
  double distance = 0;  ///< of the farthest
  bool is_alive = true;
};

class Quickhull {
 public:
  explicit Quickhull(const std::vector<Vector3d>& points) : points_(points) {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low;
    for (const Vector3d& p : points) {
      if (!p.allFinite()) throw InputError("convex hull: a point is not finite");
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    extent_ = points.empty() ? 0 : (high - low).maxCoeff();
    Begin();
  }

  /// Takes the farthest points first, until none is outside or there are `most` corners.
  void Grow(int most) {
    while (num_corners_ < most) {
      int next = -1;
      for (std::size_t f = 0; f < facets_.size(); ++f) {
        if (!facets_[f].is_alive || facets_[f].farthest < 0) continue;
        if (next < 0 || facets_[f].distance > facets_[next].distance) next = static_cast<int>(f);
      }
      if (next < 0) return;
      Add(facets_[next].farthest, next);
      ++num_corners_;
    }
  }

  ConvexHull Result() const {
    ConvexHull hull;
    std::map<int, int> index;
    for (const Facet& facet : facets_) {
      if (!facet.is_alive) continue;
      std::array<int, 3> corners{};
      for (int i = 0; i < 3; ++i) {
        const auto [known, is_new] =
            index.try_emplace(facet.corners[i], static_cast<int>(hull.vertices.size()));
        if (is_new) hull.vertices.push_back(points_[facet.corners[i]]);
        corners[i] = known->second;
      }
      hull.facets.push_back(corners);
    }
    return hull;
  }

 private:
  [[noreturn]] static void FailFlat() {
    throw InputError("convex hull: the points lie in one plane, expected a body");
  }

  template <typename Measure>
  int Farthest(const Measure& measure) const {
    int best = 0;
    double most = -1;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (const double value = measure(points_[i]); value > most) {
        most = value;
        best = static_cast<int>(i);
      }
    }
    if (!(most > kFlat * extent_)) FailFlat();
    return best;
  }

  /// A tetrahedron of points that are far apart.
  void Begin() {
    if (points_.size() < 4 || !(extent_ > 0)) FailFlat();
    const int a = Farthest([&](const Vector3d& p) { return (p - points_[0]).norm(); });
    const int b = Farthest([&](const Vector3d& p) { return (p - points_[a]).norm(); });
    const Vector3d along = (points_[b] - points_[a]).normalized();
    const int c = Farthest([&](const Vector3d& p) { return (p - points_[a]).cross(along).norm(); });
    const Vector3d normal = along.cross(points_[c] - points_[a]).normalized();
    const int d = Farthest([&](const Vector3d& p) { return std::abs(normal.dot(p - points_[a])); });
    const bool d_is_above = normal.dot(points_[d] - points_[a]) > 0;
    const auto add = [&](int i, int j, int k) {
      AddFacet(i, d_is_above ? k : j, d_is_above ? j : k);
    };
    add(a, b, c);
    add(a, d, b);
    add(b, d, c);
    add(c, d, a);
    Link(0);
    std::vector<int> all(points_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    Distribute(all, 0);
  }

  void AddFacet(int a, int b, int c) {
    Facet facet;
    facet.corners = {a, b, c};
    facet.neighbours = {-1, -1, -1};
    facet.normal = (points_[b] - points_[a]).cross(points_[c] - points_[a]).normalized();
    facet.offset = facet.normal.dot(points_[a]);
    facets_.push_back(std::move(facet));
  }

  /// Joins the facets from `first` on with each other across the edges that they share.
  void Link(int first) {
    std::map<std::pair<int, int>, std::pair<int, int>> sides;
    for (int f = first; f < static_cast<int>(facets_.size()); ++f) {
      for (int i = 0; i < 3; ++i) {
        if (facets_[f].neighbours[i] >= 0) continue;
        const int from = facets_[f].corners[i], to = facets_[f].corners[(i + 1) % 3];
        const auto other = sides.find({to, from});
        if (other == sides.end()) {
          sides[{from, to}] = {f, i};
          continue;
        }
        facets_[f].neighbours[i] = other->second.first;
        facets_[other->second.first].neighbours[other->second.second] = f;
      }
    }
  }

  double Height(int facet, int point) const {
    return facets_[facet].normal.dot(points_[point]) - facets_[facet].offset;
  }

  /// Gives each point to the first facet from `first` on that it is outside of.
  void Distribute(const std::vector<int>& points, int first) {
    for (const int point : points) {
      for (int f = first; f < static_cast<int>(facets_.size()); ++f) {
        const double height = Height(f, point);
        if (!(height > kOnFacet * extent_)) continue;
        Facet& facet = facets_[f];
        facet.outside.push_back(point);
        if (height > facet.distance) {
          facet.distance = height;
          facet.farthest = point;
        }
        break;
      }
    }
  }

  /// Replaces the facets that see the point by those that join it with their outline.
  void Add(int point, int seen_first) {
    std::vector<int> open = {seen_first};
    std::vector<int> orphans;
    std::vector<std::array<int, 4>> outline;  // from, to, facet behind, its edge
    facets_[seen_first].is_alive = false;
    while (!open.empty()) {
      const int seen = open.back();
      open.pop_back();
      orphans.insert(orphans.end(), facets_[seen].outside.begin(), facets_[seen].outside.end());
      for (int i = 0; i < 3; ++i) {
        const int other = facets_[seen].neighbours[i];
        if (other < 0 || !facets_[other].is_alive) continue;
        if (Height(other, point) > kOnFacet * extent_) {
          facets_[other].is_alive = false;
          open.push_back(other);
        }
      }
      seen_.push_back(seen);
    }
    CollectOutline(&outline);
    seen_.clear();
    const int first = static_cast<int>(facets_.size());
    for (const auto& [from, to, behind, edge] : outline) {
      AddFacet(from, to, point);
      facets_.back().neighbours[0] = behind;
      facets_[behind].neighbours[edge] = static_cast<int>(facets_.size()) - 1;
    }
    Link(first);
    orphans.erase(std::remove(orphans.begin(), orphans.end(), point), orphans.end());
    Distribute(orphans, first);
  }

  void CollectOutline(std::vector<std::array<int, 4>>* outline) const {
    for (const int seen : seen_) {
      for (int i = 0; i < 3; ++i) {
        const int other = facets_[seen].neighbours[i];
        if (other < 0 || !facets_[other].is_alive) continue;
        const auto& back = facets_[other].neighbours;
        const int edge = static_cast<int>(std::find(back.begin(), back.end(), seen) - back.begin());
        outline->push_back(
            {facets_[seen].corners[i], facets_[seen].corners[(i + 1) % 3], other, edge});
      }
    }
  }

  const std::vector<Vector3d>& points_;
  double extent_ = 0;
  int num_corners_ = 4;
  std::vector<Facet> facets_;
  std::vector<int> seen_;
};

double SixVolumes(const ConvexHull& hull, const std::array<int, 3>& facet) {
  const Vector3d& origin = hull.vertices[0];
  return (hull.vertices[facet[0]] - origin)
      .dot((hull.vertices[facet[1]] - origin).cross(hull.vertices[facet[2]] - origin));
}

}  // namespace

double ConvexHull::Volume() const {
  double sum = 0;
  for (const auto& facet : facets) sum += SixVolumes(*this, facet);
  return sum / 6;
}

Vector3d ConvexHull::Centroid() const {
  Vector3d sum = Vector3d::Zero();
  double volume = 0;
  for (const auto& facet : facets) {
    const double six = SixVolumes(*this, facet);
    sum += six / 4 * (vertices[0] + vertices[facet[0]] + vertices[facet[1]] + vertices[facet[2]]);
    volume += six;
  }
  return sum / volume;
}

Eigen::Matrix3d ConvexHull::Covariance() const {
  const Vector3d centre = Centroid();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double volume = 0;
  for (const auto& facet : facets) {
    // The mean of d d^T over a tetrahedron with corners 0, a, b and c is
    // (a a^T + b b^T + c c^T + (a + b + c) (a + b + c)^T) / 20.
    const Vector3d a = vertices[facet[0]] - centre, b = vertices[facet[1]] - centre,
                   c = vertices[facet[2]] - centre;
    const double six = a.dot(b.cross(c));
    const Vector3d all = a + b + c;
    sum += six / 20 *
           (a * a.transpose() + b * b.transpose() + c * c.transpose() + all * all.transpose());
    volume += six;
  }
  return sum / volume;
}

double ConvexHull::Outside(const Vector3d& point) const {
  double most = -std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : facets) {
    const Vector3d normal = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    const double norm = normal.norm();
    if (norm > 0) most = std::max(most, normal.dot(point - vertices[a]) / norm);
  }
  return most;
}

ConvexHull HullOfPoints(const std::vector<Vector3d>& points) {
  Quickhull quickhull(points);
  quickhull.Grow(std::numeric_limits<int>::max());
  return quickhull.Result();
}

ConvexHull SimpleHullOfPoints(const std::vector<Vector3d>& points, int most_vertices) {
  const ConvexHull exact = HullOfPoints(points);
  if (static_cast<int>(exact.vertices.size()) <= most_vertices) return exact;
  Quickhull quickhull(exact.vertices);
  quickhull.Grow(most_vertices);
  ConvexHull hull = quickhull.Result();
  const Vector3d centre = hull.Centroid();
  double scale = 1;
  for (const auto& [a, b, c] : hull.facets) {
    const Vector3d normal = (hull.vertices[b] - hull.vertices[a])
                                .cross(hull.vertices[c] - hull.vertices[a])
                                .normalized();
    const double depth = normal.dot(hull.vertices[a] - centre);
    for (const Vector3d& p : exact.vertices)
      scale = std::max(scale, normal.dot(p - centre) / depth);
  }
  for (Vector3d& vertex : hull.vertices) vertex = centre + scale * (vertex - centre);
  return hull;
}

}  // namespace possibility::models
