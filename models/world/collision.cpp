#include "models/world/collision.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "models/shapes/bounds_tree.h"
#include "models/shapes/signed_distance.h"

namespace possibility::models {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Rounding of poses and projections stays below this for scenes of up to kilometres, m.
constexpr double kRounding = 1e-8;

struct PosedBody {
  PreparedShape shape;
  Isometry3d X_PC;  ///< pose of the core in the link or in the world
};

/// The bodies of a link, and a ball around them.
struct PreparedLink {
  std::vector<PosedBody> bodies;
  Vector3d centre = Vector3d::Zero();  ///< in L
  double radius = 0;                   ///< m

  explicit PreparedLink(const Link& link) {
    AlignedBox3d around;
    for (const PosedShape& posed : link.shapes) {
      PreparedShape shape(posed.shape);
      const Isometry3d X_LC = shape.CorePose(posed.X_PS);
      around.extend(shape.OuterBounds(X_LC));
      bodies.push_back({std::move(shape), X_LC});
    }
    if (bodies.empty()) return;
    centre = around.center();
    radius = around.sizes().norm() / 2 + kRounding;
  }

  /// Contains the bodies: empty without any, all of space if the pose is not finite.
  AlignedBox3d OuterBounds(const Isometry3d& X_WL) const {
    if (bodies.empty()) return {};
    Vector3d reach = Vector3d::Constant(radius);
    if (!X_WL.matrix().allFinite()) reach.setConstant(std::numeric_limits<double>::infinity());
    const Vector3d p_W = X_WL * centre;
    const Vector3d centre_W = p_W.allFinite() ? p_W : Vector3d::Zero();
    return {centre_W - reach, centre_W + reach};
  }
};

std::vector<std::pair<int, int>> SelfPairs(const RobotModel& robot) {
  std::set<std::pair<int, int>> excluded;
  for (int i = 0; i < robot.num_joints(); ++i) excluded.insert({robot.joints[i].parent, i + 1});
  for (const auto& [a, b] : robot.ignored_collisions) excluded.insert(std::minmax(a, b));
  std::vector<std::pair<int, int>> pairs;
  for (int a = 0; a < robot.num_links(); ++a) {
    for (int b = a + 1; b < robot.num_links(); ++b) {
      if (excluded.contains({a, b})) continue;
      if (!robot.links[a].shapes.empty() && !robot.links[b].shapes.empty()) {
        pairs.emplace_back(a, b);
      }
    }
  }
  return pairs;
}

/// Shapes whose bounding boxes are farther apart than this are ruled out. A negative threshold asks
/// for overlap, which needs overlapping boxes.
double Reach(double threshold) { return std::max(threshold, 0.0) + kRounding; }

bool FartherThan(const AlignedBox3d& a, const AlignedBox3d& b, double reach) {
  return a.squaredExteriorDistance(b) > reach * reach;
}

/// Nothing if a prism is not finite.
std::optional<AlignedBox3d> BoundsOf(const std::vector<Prism>& prisms) {
  AlignedBox3d bounds;
  for (const Prism& prism : prisms) {
    const AlignedBox3d own = prism.Bounds();
    if (!own.min().allFinite() || !own.max().allFinite()) return std::nullopt;
    bounds.extend(own);
  }
  return bounds;
}

}  // namespace

struct CollisionChecker::Impl {
  std::vector<PreparedLink> links;
  std::vector<std::pair<int, int>> self_pairs;
  std::vector<PosedBody> obstacles;
  std::vector<AlignedBox3d> bounds;  ///< of the obstacles
  std::vector<Prism> prisms;         ///< around the obstacles
  BoundsTree tree;

  explicit Impl(const Environment& environment) {
    for (const Obstacle& obstacle : environment.obstacles) {
      PreparedShape shape(obstacle.shape);
      const Isometry3d X_WC = shape.CorePose(obstacle.X_WO);
      prisms.emplace_back(shape, X_WC, shape.OuterBounds(X_WC));
      obstacles.push_back({std::move(shape), X_WC});
      bounds.push_back(obstacle.shape.Bounds(obstacle.X_WO));
    }
    tree = BoundsTree(bounds);
  }

  void CheckPoses(const std::vector<Isometry3d>& X_WL) const {
    if (X_WL.size() != links.size()) {
      throw std::invalid_argument("collision query: expected one pose for each link");
    }
  }

  /// Distance of the nearest obstacle, at most `at_most`. A distance below `stop_below` ends the
  /// search.
  double Nearest(const PreparedShape& shape, const Isometry3d& X_WS, double at_most,
                 double stop_below) const {
    const Isometry3d X_WC = shape.CorePose(X_WS);
    double nearest = at_most;
    tree.VisitNear(shape.OuterBounds(X_WC), Reach(at_most), [&](int obstacle) {
      const PosedBody& other = obstacles[obstacle];
      // Rounding is accounted for before comparing, so that `at_most` itself is never reduced.
      const double distance =
          SignedDistance(shape, X_WC, other.shape, other.X_PC, nearest + kRounding) - kRounding;
      nearest = std::min(nearest, distance);
      return nearest < stop_below ? -1 : Reach(nearest);
    });
    return nearest;
  }

  /// Whether a box is nearer than 0 to the obstacle. Skips boxes that their prisms separate from
  /// it.
  bool Meets(const UprightBoxes& boxes, const std::vector<Prism>& posed, const Isometry3d& X_WS,
             int obstacle) const {
    for (size_t i = 0; i < posed.size(); ++i) {
      if (AreApart(posed[i], prisms[obstacle], kCertainGap)) continue;
      const PreparedShape& shape = boxes.shapes()[i];
      const Isometry3d X_WC = X_WS * boxes.X_SB()[i];
      if (FartherThan(shape.OuterBounds(X_WC), bounds[obstacle], Reach(0))) continue;
      const PosedBody& other = obstacles[obstacle];
      if (!(SignedDistance(shape, X_WC, other.shape, other.X_PC, kRounding) >= kRounding)) {
        return true;
      }
    }
    return false;
  }

  std::vector<int> ObstaclesNear(const AlignedBox3d& around, double reach) const {
    std::vector<int> near;
    tree.VisitNear(around, reach, [&](int obstacle) {
      near.push_back(obstacle);
      return reach;
    });
    std::sort(near.begin(), near.end());
    return near;
  }

  /// Distance of a link to an obstacle, at most `at_most`.
  double LinkDistance(const PreparedLink& link, const Isometry3d& X_WL, int obstacle,
                      double at_most) const {
    const PosedBody& other = obstacles[obstacle];
    const double reach = Reach(at_most);
    double nearest = at_most;
    for (const PosedBody& body : link.bodies) {
      const Isometry3d X_WC = X_WL * body.X_PC;
      if (FartherThan(body.shape.OuterBounds(X_WC), bounds[obstacle], reach)) continue;
      nearest =
          std::min(nearest, SignedDistance(body.shape, X_WC, other.shape, other.X_PC, at_most));
    }
    return nearest;
  }
};

namespace {

/// The bodies of every link in the world, with their bounds.
struct WorldBodies {
  struct Body {
    Isometry3d X_WC;
    AlignedBox3d bounds;
  };
  std::vector<std::vector<Body>> links;
  std::vector<AlignedBox3d> link_bounds;

  WorldBodies(const std::vector<PreparedLink>& prepared, const std::vector<Isometry3d>& X_WL)
      : links(prepared.size()), link_bounds(prepared.size()) {
    for (size_t link = 0; link < prepared.size(); ++link) {
      links[link].reserve(prepared[link].bodies.size());
      for (const PosedBody& body : prepared[link].bodies) {
        const Isometry3d X_WC = X_WL[link] * body.X_PC;
        links[link].push_back({X_WC, body.shape.OuterBounds(X_WC)});
        link_bounds[link].extend(links[link].back().bounds);
      }
    }
  }
};

}  // namespace

CollisionChecker::CollisionChecker(const RobotModel& robot, const Environment& environment)
    : CollisionChecker(environment) {
  for (const Link& link : robot.links) impl_->links.emplace_back(link);
  impl_->self_pairs = SelfPairs(robot);
}

CollisionChecker::CollisionChecker(const Environment& environment)
    : impl_(std::make_unique<Impl>(environment)) {}

CollisionChecker::~CollisionChecker() = default;
CollisionChecker::CollisionChecker(CollisionChecker&&) noexcept = default;
CollisionChecker& CollisionChecker::operator=(CollisionChecker&&) noexcept = default;

std::vector<Proximity> CollisionChecker::EnvironmentProximities(const std::vector<Isometry3d>& X_WL,
                                                                double threshold) const {
  impl_->CheckPoses(X_WL);
  const double reach = Reach(threshold);
  std::vector<AlignedBox3d> link_bounds;
  AlignedBox3d robot_bounds;
  for (size_t link = 0; link < X_WL.size(); ++link) {
    link_bounds.push_back(impl_->links[link].OuterBounds(X_WL[link]));
    robot_bounds.extend(link_bounds.back());
  }
  if (robot_bounds.isEmpty()) return {};
  const std::vector<int> near = impl_->ObstaclesNear(robot_bounds, reach);
  std::vector<Proximity> proximities;
  for (size_t link = 0; link < X_WL.size(); ++link) {
    if (link_bounds[link].isEmpty()) continue;
    for (const int obstacle : near) {
      if (FartherThan(link_bounds[link], impl_->bounds[obstacle], reach)) continue;
      const double distance =
          impl_->LinkDistance(impl_->links[link], X_WL[link], obstacle, threshold);
      if (distance < threshold) proximities.push_back({static_cast<int>(link), obstacle, distance});
    }
  }
  return proximities;
}

std::vector<Proximity> CollisionChecker::SelfProximities(const std::vector<Isometry3d>& X_WL,
                                                         double threshold) const {
  impl_->CheckPoses(X_WL);
  const WorldBodies world(impl_->links, X_WL);
  const double reach = Reach(threshold);
  std::vector<Proximity> proximities;
  for (const auto& [a, b] : impl_->self_pairs) {
    if (FartherThan(world.link_bounds[a], world.link_bounds[b], reach)) continue;
    double nearest = threshold;
    for (size_t i = 0; i < world.links[a].size(); ++i) {
      for (size_t j = 0; j < world.links[b].size(); ++j) {
        const WorldBodies::Body& body_a = world.links[a][i];
        const WorldBodies::Body& body_b = world.links[b][j];
        if (FartherThan(body_a.bounds, body_b.bounds, reach)) continue;
        nearest = std::min(nearest,
                           SignedDistance(impl_->links[a].bodies[i].shape, body_a.X_WC,
                                          impl_->links[b].bodies[j].shape, body_b.X_WC, nearest));
      }
    }
    if (nearest < threshold) proximities.push_back({a, b, nearest});
  }
  return proximities;
}

bool CollisionChecker::IsFree(const PreparedShape& shape, const Isometry3d& X_WS,
                              double margin) const {
  return impl_->Nearest(shape, X_WS, margin, margin) >= margin;
}

bool CollisionChecker::IsFree(const Shape& shape, const Isometry3d& X_WS, double margin) const {
  return IsFree(PreparedShape(shape), X_WS, margin);
}

bool CollisionChecker::AreFree(const UprightBoxes& boxes, const Isometry3d& X_WS) const {
  std::vector<Prism> posed;
  posed.reserve(boxes.boxes().size());
  for (const AlignedBox3d& box : boxes.boxes()) posed.emplace_back(box, X_WS);
  const std::optional<AlignedBox3d> bounds = BoundsOf(posed);
  if (!bounds) return impl_->obstacles.empty();
  bool is_free = true;
  impl_->tree.VisitNear(*bounds, kCertainGap, [&](int obstacle) {
    is_free = !impl_->Meets(boxes, posed, X_WS, obstacle);
    return is_free ? kCertainGap : -1;
  });
  return is_free;
}

bool CollisionChecker::AreCertainlyFree(const std::vector<Prism>& boxes) const {
  const std::optional<AlignedBox3d> bounds = BoundsOf(boxes);
  if (!bounds) return false;
  bool is_free = true;
  impl_->tree.VisitNear(*bounds, kCertainGap, [&](int obstacle) {
    is_free = std::all_of(boxes.begin(), boxes.end(), [&](const Prism& box) {
      return AreApart(box, impl_->prisms[obstacle], kCertainGap);
    });
    return is_free ? kCertainGap : -1;
  });
  return is_free;
}

double CollisionChecker::Clearance(const PreparedShape& shape, const Isometry3d& X_WS,
                                   double at_most) const {
  return impl_->Nearest(shape, X_WS, at_most, -std::numeric_limits<double>::infinity());
}

}  // namespace possibility::models
