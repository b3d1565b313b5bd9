#include "actions/footsteps/footstep_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <unordered_set>

#include "actions/footsteps/pose_field.h"
#include "actions/motion/limb_bend.h"
#include "actions/motion/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Of the search: weight of the heuristic, and sizes within which two places are the same.
constexpr double kGreed = 4;
constexpr double kSamePlace = 0.04;  // m
constexpr double kSameTurn = 0.15;   // rad
constexpr double kSameHeight = 0.005;

/// Patches keep this far from each other, m.
constexpr double kPatchGap = 0.015;

// Durations, s.
constexpr double kLevelStep = 0.65;
constexpr double kHighStep = 1.2;
constexpr double kSecondsPerMetreUp = 2;

/// A low root needs torque. Steps that need one lower than kEasySquat (m) below the nominal posture
/// count as slower, s/m.
constexpr double kEasySquat = 0.02;
constexpr double kSecondsPerSquat = 60;

/// Of the field of poses, m.
constexpr double kCell = 0.06;
/// The part of the body that is tested while limbs step: above this share of the root's height.
constexpr double kTrunkFrom = 0.5;

/// Steps of the family, in shares of its limits.
constexpr double kAhead[] = {1, 0.88, 0.76, 0.64, 0.5, 0.36, 0.2, 0, -0.25, -0.5};
constexpr double kAside[] = {0, 0.35, 0.7, 1};
constexpr double kTurns[] = {0, 0.5, -0.5, 1, -1};

std::vector<Vector2d> PatchAt(const NominalStance& stance, int limb, const PlanarPose& at) {
  std::vector<Vector2d> points;
  for (const Vector2d& p : stance.bearing_points[limb]) points.push_back(at * p);
  return points;
}

double GapBetween(const std::vector<Vector2d>& a, const std::vector<Vector2d>& b) {
  const SupportPolygon one(a), other(b);
  double gap = std::numeric_limits<double>::infinity();
  for (const Vector2d& p : one.vertices()) gap = std::min(gap, -other.Margin(p));
  for (const Vector2d& p : other.vertices()) gap = std::min(gap, -one.Margin(p));
  return gap;
}

/// The parts of boxes above a height, grown on their sides.
std::vector<Eigen::AlignedBox3d> Above(const std::vector<Eigen::AlignedBox3d>& boxes, double height,
                                       double margin) {
  std::vector<Eigen::AlignedBox3d> above;
  for (Eigen::AlignedBox3d box : boxes) {
    box.min() -= Vector3d(margin, margin, 0);
    box.max() += Vector3d(margin, margin, 0);
    box.min().z() = std::max(box.min().z(), height);
    if (box.min().z() < box.max().z()) above.push_back(box);
  }
  return above;
}

/// Headings square to the sides of boxes and surfaces: of corridors, doors and edges.
std::vector<double> SquareHeadingsOf(const models::Environment& environment) {
  std::vector<double> headings;
  const auto add = [&headings](double yaw) {
    const double heading = WrapAngle(4 * yaw) / 4;
    const bool known = std::any_of(headings.begin(), headings.end(), [&](double other) {
      return std::abs(WrapAngle(4 * (heading - other))) < 4e-3;
    });
    if (!known) headings.push_back(heading);
  };
  for (const models::Obstacle& obstacle : environment.obstacles) {
    if (obstacle.surface < 0) add(std::atan2(obstacle.X_WO(1, 0), obstacle.X_WO(0, 0)));
  }
  for (const models::Surface& surface : environment.surfaces) {
    for (const double heading : surface.headings) add(heading);
  }
  return headings;
}

}  // namespace

FootstepLimits FootstepLimits::Of(const models::RobotModel& robot, const NominalStance& stance) {
  FootstepLimits limits;
  double leg = std::numeric_limits<double>::infinity();
  for (const models::GaitLimb& limb : stance.gait->limbs) {
    if (const auto bend = BendOf(robot, limb)) leg = std::min(leg, bend->length);
  }
  if (!std::isfinite(leg)) leg = stance.gait->posture.root_height;
  limits.forward = 0.5 * leg;
  limits.lateral = 0.24 * leg;
  limits.rise = 0.25 * leg;
  limits.lift = 0.4 * leg;
  limits.clearance = 0.045 * leg;
  limits.lowest_root = stance.gait->posture.root_height - 0.1 * leg;
  return limits;
}

double ExpectedDuration(const Footstep& step) {
  const double height = step.lift + std::abs(step.to.z - step.from.z);
  return height > 0 ? kHighStep + kSecondsPerMetreUp * height : kLevelStep;
}

bool FootstepSearch::Knows(const models::Gait& gait) {
  return gait.limbs.size() == 2 &&
         std::all_of(gait.limbs.begin(), gait.limbs.end(),
                     [](const models::GaitLimb& limb) { return limb.hold_orientation; });
}

struct FootstepSearch::Search {
  using Refusal = std::function<bool(const Footstep&, const Foothold&)>;

  /// Both limbs' places, and the limb that moves next.
  struct Node {
    std::array<Foothold, 2> feet;
    int next = 0;
    int parent = -1;
    double cost = 0;
    double lift = 0;         ///< of the step that led here
    bool is_tested = false;  ///< against obstacles
  };
  struct Open {
    double value = 0;
    int node = 0;
    bool operator>(const Open& other) const {
      return value != other.value ? value > other.value : node > other.node;
    }
  };

  Search(const LocomotionModel& model, int gait, const World& world, const GroundedStance& start,
         const std::vector<GroundedStance>& goals, const FootstepLimits& limits,
         const CancellationToken& cancellation)
      : stance(model.gaits[gait]->stance),
        limits(limits),
        world(world),
        goals(goals),
        ground(*model.robot, stance, world, limits.margin),
        checker(*world.environment),
        trunk(Above(model.gaits[gait]->volumes.standing,
                    kTrunkFrom * stance.gait->posture.root_height, limits.trunk_margin)),
        reaches(ReachesOf(*model.robot, stance, 0.97)),
        headings(SquareHeadingsOf(*world.environment)),
        field(FieldOf(cancellation)) {
    for (int limb = 0; limb < 2; ++limb) {
      displacements[limb] = DisplacementsOf(limb);
      const SupportPolygon patch(stance.bearing_points[limb]);
      const Vector2d shift =
          patch.Nearest(stance.centre_of_mass, stance.gait->parameters.com_margin) -
          stance.centre_of_mass;
      root_over[limb] = Vector2d(stance.X_SR.translation().head<2>()) + shift;
    }
    for (const int next : {0, 1}) {
      Node node;
      for (Foothold& foot : node.feet) foot = {start.pose, start.z};
      node.next = next;
      node.is_tested = true;
      Push(node);
    }
  }

  /// Displacements of a limb's stance in the other's that leave a gap between the patches.
  std::vector<PlanarPose> DisplacementsOf(int limb) const {
    std::vector<PlanarPose> result;
    const double side =
        stance.patch_centres[limb].y() > stance.patch_centres[1 - limb].y() ? 1 : -1;
    const std::vector<Vector2d> other = PatchAt(stance, 1 - limb, {});
    for (const double turn : kTurns) {
      for (const double ahead : kAhead) {
        for (const double aside : kAside) {
          if (std::abs(ahead) + 0.6 * aside + 0.6 * std::abs(turn) > 1.3) continue;
          const PlanarPose displacement{ahead * limits.forward, side * aside * limits.lateral,
                                        turn * limits.turn};
          if (GapBetween(PatchAt(stance, limb, displacement), other) < kPatchGap) continue;
          result.push_back(displacement);
        }
      }
    }
    return result;
  }

  PoseField FieldOf(const CancellationToken& cancellation) const {
    std::vector<PlanarPose> places;
    for (const GroundedStance& goal : goals) places.push_back(goal.pose);
    const std::vector<double>& levels = world.ground->levels();
    const PoseField::Paces paces{kLevelStep / limits.forward, 2 * kLevelStep / limits.lateral,
                                 2 * kLevelStep / limits.turn};
    return PoseField(
        world.environment->bounds, kCell, headings.empty() ? 0 : headings.front(), places, paces,
        [&](const PlanarPose& pose) {
          for (std::size_t level = 0; level < levels.size(); ++level) {
            if (!world.ground->IsNear(static_cast<int>(level), pose.position(),
                                      limits.forward / 2)) {
              continue;
            }
            if (TrunkIsFree(pose, levels[level])) return true;
          }
          return false;
        },
        cancellation);
  }

  static std::int64_t Quantised(double value, double size) { return std::llround(value / size); }

  static std::string KeyOf(const Node& node) {
    std::string key;
    const auto add = [&key](std::int64_t number) {
      key.append(reinterpret_cast<const char*>(&number), sizeof number);
    };
    for (const Foothold& foot : node.feet) {
      add(Quantised(foot.stance.x, kSamePlace));
      add(Quantised(foot.stance.y, kSamePlace));
      add(Quantised(WrapAngle(foot.stance.yaw), kSameTurn));
      add(Quantised(foot.z, kSameHeight));
    }
    add(node.next);
    return key;
  }

  static PlanarPose Middle(const Node& node) {
    return Interpolate(node.feet[0].stance, node.feet[1].stance, 0.5);
  }

  double Heuristic(const Node& node) const { return field.At(Middle(node)); }

  void Push(const Node& node) {
    const double heuristic = Heuristic(node);
    if (!std::isfinite(heuristic)) return;
    nodes.push_back(node);
    open.push({node.cost + kGreed * heuristic, static_cast<int>(nodes.size()) - 1});
  }

  /// How much lower than easy the root has to be for a limb to reach a place while the other one
  /// bears, m; at least 0. None if that is too low.
  std::optional<double> Squat(int limb, const Foothold& place, const Foothold& other) const {
    if (!reaches[limb]) return 0;
    const Vector2d root = other.stance * root_over[1 - limb];
    const double yaw = other.stance.yaw + WrapAngle(place.stance.yaw - other.stance.yaw) / 2;
    const Vector2d centre = place.stance * Vector2d(stance.patch_centres[limb].head<2>());
    const auto highest = reaches[limb]->HighestRoot(
        {root.x(), root.y(), yaw}, {centre.x(), centre.y(), place.z}, place.stance.yaw);
    if (!highest || *highest < other.z + limits.lowest_root) return std::nullopt;
    return std::max(0.0, other.z + stance.gait->posture.root_height - kEasySquat - *highest);
  }

  /// At the node, and on the way to it.
  bool TrunkIsFree(const Node& node) const {
    const Node& parent = nodes[node.parent];
    const double z = std::max(node.feet[0].z, node.feet[1].z);
    const PlanarPose from = Middle(parent);
    const PlanarPose to = Middle(node);
    return TrunkIsFree(to, z) && TrunkIsFree(Interpolate(from, to, 0.5), z);
  }

  bool TrunkIsFree(const PlanarPose& middle, double z) const {
    const Vector2d root = middle * Vector2d(stance.X_SR.translation().head<2>());
    if (!world.environment->bounds.isEmpty() && !world.environment->bounds.contains(root)) {
      return false;
    }
    return checker.AreFree(trunk, middle.At(z));
  }

  /// Tests that cost more, when a node is first taken up.
  bool Test(Node* node, const Refusal& is_refused) {
    if (node->is_tested) return true;
    node->is_tested = true;
    const int moved = 1 - node->next;
    const Foothold& from = nodes[node->parent].feet[moved];
    const Foothold& to = node->feet[moved];
    if (!TrunkIsFree(*node)) return false;
    const auto lift = ground.LiftBetween(moved, from, to, limits.clearance, limits.lift);
    if (!lift) return false;
    node->lift = *lift;
    return !is_refused || !is_refused({moved, from, to, *lift}, node->feet[node->next]);
  }

  void TryPlace(int parent, int limb, const PlanarPose& there) {
    const Node from = nodes[parent];  // a copy: pushing moves the nodes
    const std::vector<double>& levels = world.ground->levels();
    for (std::size_t level = 0; level < levels.size(); ++level) {
      if (std::abs(levels[level] - from.feet[1 - limb].z) > limits.rise + 1e-6) continue;
      const auto place = ground.Place(limb, there, static_cast<int>(level));
      if (place) TryStep(parent, limb, *place);
    }
  }

  void TryStep(int parent, int limb, const Foothold& place) {
    const Node from = nodes[parent];  // a copy: pushing moves the nodes
    const Foothold& other = from.feet[1 - limb];
    const std::optional<double> squat = Squat(limb, place, other);
    const std::optional<double> before = Squat(limb, from.feet[limb], other);
    if (!squat || !before) return;
    if (GapBetween(PatchAt(stance, limb, place.stance), PatchAt(stance, 1 - limb, other.stance)) <
        kPatchGap) {
      return;
    }
    Node node;
    node.feet = from.feet;
    node.feet[limb] = place;
    node.next = 1 - limb;
    node.parent = parent;
    node.cost = from.cost + actions::ExpectedDuration({limb, from.feet[limb], place, 0}) +
                kSecondsPerSquat * std::max(*squat, *before);
    if (!closed.contains(KeyOf(node))) Push(node);
  }

  void Expand(int index) {
    const int limb = nodes[index].next;
    const Foothold other = nodes[index].feet[1 - limb];
    for (const GroundedStance& goal : goals) {
      if (IsWithin(limb, other.stance.Inverse() * goal.pose) &&
          std::abs(goal.z - other.z) <= limits.rise) {
        TryPlace(index, limb, goal.pose);
      }
    }
    for (const double heading : headings) {
      const double turn = WrapAngle(4 * (heading - other.stance.yaw)) / 4;
      if (std::abs(turn) > limits.turn || std::abs(turn) < 1e-6) continue;
      for (const PlanarPose& displacement : displacements[limb]) {
        if (displacement.yaw != 0) continue;
        TryPlace(index, limb, other.stance * PlanarPose{displacement.x, displacement.y, turn});
      }
    }
    for (const PlanarPose& displacement : displacements[limb]) {
      TryPlace(index, limb, other.stance * displacement);
    }
  }

  /// Whether a displacement in the other limb's stance is one of the family.
  bool IsWithin(int limb, const PlanarPose& displacement) const {
    const double side =
        stance.patch_centres[limb].y() > stance.patch_centres[1 - limb].y() ? 1 : -1;
    return std::abs(displacement.x) <= limits.forward &&
           side * displacement.y >= -0.1 * limits.lateral &&
           side * displacement.y <= limits.lateral &&
           std::abs(WrapAngle(displacement.yaw)) <= limits.turn;
  }

  /// Index of the goal in which both limbs stand; -1 if there is none.
  int GoalAt(const Node& node) const {
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const bool is_there =
          std::all_of(node.feet.begin(), node.feet.end(), [&](const Foothold& foot) {
            const PlanarPose off = goals[i].pose.Inverse() * foot.stance;
            return off.position().norm() < 1e-9 && std::abs(WrapAngle(off.yaw)) < 1e-9 &&
                   std::abs(foot.z - goals[i].z) < 1e-9;
          });
      if (is_there) return static_cast<int>(i);
    }
    return -1;
  }

  std::vector<Footstep> StepsTo(int index) const {
    std::vector<Footstep> steps;
    for (; nodes[index].parent >= 0; index = nodes[index].parent) {
      const Node& node = nodes[index];
      const int moved = 1 - node.next;
      steps.push_back({moved, nodes[node.parent].feet[moved], node.feet[moved], node.lift});
    }
    std::reverse(steps.begin(), steps.end());
    return steps;
  }

  const NominalStance& stance;
  FootstepLimits limits;
  const World& world;
  std::vector<GroundedStance> goals;
  FootholdGround ground;
  models::CollisionChecker checker;
  models::UprightBoxes trunk;
  std::vector<std::optional<LimbReach>> reaches;
  std::vector<double> headings;
  PoseField field;
  std::array<std::vector<PlanarPose>, 2> displacements;
  std::array<Vector2d, 2> root_over;  ///< of the stance: the root over a limb that bears alone
  std::vector<Node> nodes;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  std::unordered_set<std::string> closed;
  std::int64_t expanded = 0;
};

FootstepSearch::FootstepSearch(const LocomotionModel& model, int gait, const World& world,
                               const GroundedStance& start,
                               const std::vector<GroundedStance>& goals,
                               const FootstepLimits& limits, const CancellationToken& cancellation)
    : search_(std::make_unique<Search>(model, gait, world, start, goals, limits, cancellation)) {}

FootstepSearch::~FootstepSearch() = default;

std::int64_t FootstepSearch::states() const { return search_->expanded; }

FootstepSearch::Status FootstepSearch::Advance(std::int64_t states,
                                               const CancellationToken& cancellation) {
  Search& search = *search_;
  for (std::int64_t i = 0; i < states; ++i) {
    if (search.open.empty() || search.expanded >= most_states) return Status::kExhausted;
    const int index = search.open.top().node;
    search.open.pop();
    if (i % 16 == 0) cancellation.ThrowIfCancelled();
    if (!search.closed.insert(Search::KeyOf(search.nodes[index])).second) continue;
    if (!search.Test(&search.nodes[index], is_refused)) continue;
    ++search.expanded;
    if (const int goal = search.GoalAt(search.nodes[index]); goal >= 0) {
      goal_ = goal;
      steps_ = search.StepsTo(index);
      return Status::kFound;
    }
    search.Expand(index);
  }
  return Status::kSearching;
}

}  // namespace possibility::actions
