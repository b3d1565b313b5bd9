#include "actions/footsteps/footstep_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <unordered_set>
#include <utility>

#include "actions/footsteps/foothold_field.h"
#include "actions/footsteps/foothold_flood.h"
#include "actions/footsteps/pose_field.h"
#include "actions/footsteps/step_reach.h"
#include "actions/motion/limb_bend.h"
#include "actions/motion/support_polygon.h"

namespace possibility::actions {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Of the search: weight of the heuristic, and sizes within which two places are the same.
constexpr double kGreed = 2.5;
constexpr double kSamePlace = 0.04;  // m
constexpr double kSameTurn = 0.15;   // rad
constexpr double kSameHeight = 0.005;
/// A place is compared more coarsely by that where the foot leaves it next: what follows depends on
/// the other one.
constexpr double kCoarser = 3;

constexpr double kFamilyRounding = 1e-6;  // m and rad

/// Patches keep this far from each other, m.
constexpr double kPatchGap = 0.015;
constexpr int kPassingSamples = 8;

// Durations, s.
constexpr double kLevelStep = 0.65;
constexpr double kHighStep = 1.2;
constexpr double kSecondsPerMetreLifted = 2;

/// A low root needs torque. Steps that need one lower than kEasySquat (m) below the nominal posture
/// count as slower, s/m.
constexpr double kEasySquat = 0.02;
constexpr double kSecondsPerSquat = 60;
/// On ground that is not level, longer strides than this share of the family's cost torque and
/// joint speed, s/m.
constexpr double kEasyStride = 0.6;
constexpr double kSecondsPerStride = 4;
/// A step that is moved to where ground is may become longer than the family's; that is dear, s/m.
constexpr double kSecondsPerMetreBeyond = 30;
/// Expected by the field of footholds, s/m: high steps, low roots, a second foot that follows.
constexpr double kSecondsPerMetreClimbed = 12;

/// Work of one turn: a place that is tried counts as this share of a state.
constexpr std::int64_t kPlacesPerState = 16;
constexpr std::int64_t kWorkPerQuestion = 256;

/// A search that goes on for so many states asks whether the ground can be reached at all.
constexpr std::int64_t kStatesBeforeFlood = 500;

/// Of the field of poses, m.
constexpr double kCell = 0.06;
constexpr double kMostPoseCells = 100e3;  // seen from above; in larger places cells are larger
/// The part of the body that is tested while limbs step: above this share of the root's height.
constexpr double kTrunkFrom = 0.5;

/// Steps of the family, in shares of its limits.
constexpr double kAhead[] = {1, 0.88, 0.76, 0.64, 0.5, 0.36, 0.2, 0, -0.25, -0.5};
constexpr double kAside[] = {0, 0.35, 0.7, 1};
constexpr double kTurning[] = {0, 0.5, -0.5, 1, -1};

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
  const double height = step.lift + step.ChangeOfHeight();
  return height > 0 ? kHighStep + kSecondsPerMetreLifted * height : kLevelStep;
}

bool FootstepSearch::Knows(const models::Gait& gait) {
  return gait.limbs.size() == 2 &&
         std::all_of(gait.limbs.begin(), gait.limbs.end(),
                     [](const models::GaitLimb& limb) { return limb.hold_orientation; });
}

struct FootstepSearch::Search {
  using Refusal = std::function<bool(const Footstep&, const Foothold&)>;

  /// Where the limb that moves next may go: not tested yet.
  struct Candidate {
    double value = 0;
    int place = 0;  ///< number of PlaceOf
    bool operator>(const Candidate& other) const {
      return value != other.value ? value > other.value : place > other.place;
    }
  };
  /// A node's candidates on one plane: a heap, the least value on top.
  struct Branch {
    int node = 0;
    int layer = 0;
    std::vector<Candidate> candidates;
  };

  /// Both limbs' places, and the limb that moves next.
  struct Node {
    std::array<Foothold, 2> feet;
    std::array<int, 2> layers = {-1, -1};  ///< the feet's planes: indices into ground.planes()
    std::array<int, 2> goals = {-1, -1};   ///< in which the feet stand; -1: in none
    int next = 0;
    int parent = -1;
    double cost = 0;
    double lift = 0;         ///< of the step that led here
    bool is_tested = false;  ///< against obstacles
    double squat = 0;        ///< before the next step; once expanded
  };

  /// A node, or the best candidate of a branch.
  struct Open {
    double value = 0;
    int number = 0;
    bool is_branch = false;
    bool operator>(const Open& other) const {
      if (value != other.value) return value > other.value;
      return number != other.number ? number < other.number : is_branch > other.is_branch;
    }
  };

  /// A state, rounded.
  using Key = std::array<std::int32_t, 9>;
  struct HashOfKey {
    std::size_t operator()(const Key& key) const {
      std::uint64_t hash = 0;
      for (const std::int32_t number : key) {
        hash = (hash ^ static_cast<std::uint32_t>(number)) * 0x9E3779B97F4A7C15;
        hash ^= hash >> 29;
      }
      return hash;
    }
  };

  Search(const LocomotionModel& model, int gait, const World& world, FootstepEnds ends,
         const FootstepLimits& limits, const CancellationToken& cancellation)
      : stance(model.gaits[gait]->stance),
        limits(limits),
        world(world),
        starts(std::move(ends.starts)),
        start_times(std::move(ends.start_times)),
        goals(std::move(ends.goals)),
        goal_times(std::move(ends.goal_times)),
        ground(*model.robot, stance, world, limits.margin),
        checker(*world.environment),
        trunk(Above(model.gaits[gait]->volumes.standing,
                    kTrunkFrom * stance.gait->posture.root_height, limits.trunk_margin)),
        reach(*model.robot, stance),
        headings(SquareHeadingsOf(*world.environment)),
        displacements({DisplacementsOf(0), DisplacementsOf(1)}) {
    Begin(cancellation);
  }

  void Begin(const CancellationToken& cancellation) {
    footholds.emplace(stance, world, ground.planes(), limits, goals, goal_times, TimesOfSteps());
    field.emplace(FieldOf());
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const int layer = LayerUnder(0, {starts[i].pose, starts[i].z});
      if (layer < 0) continue;
      field->At(layer, starts[i].pose, cancellation);  // most of the field
      Begin(layer, {starts[i].pose, starts[i].z}, start_times.empty() ? 0 : start_times[i]);
    }
  }

  /// Once nothing is left to search: begins again with fields that rule out less. Whether there is
  /// anything to search then.
  bool BeginAgain(const CancellationToken& cancellation) {
    if (is_relaxed || second_best || !MayReachAGoal(cancellation)) return false;
    is_relaxed = true;
    closed.clear();
    Begin(cancellation);
    return !open.empty();
  }

  void Begin(int layer, const Foothold& start, double time) {
    for (const int next : {0, 1}) {
      Node node;
      node.feet.fill(start);
      node.layers.fill(layer);
      node.next = next;
      node.is_tested = true;
      node.cost = time;
      Push(std::move(node));
    }
  }

  /// Displacements of a limb's stance in the other's that leave a gap between the patches.
  std::vector<PlanarPose> DisplacementsOf(int limb) const {
    std::vector<PlanarPose> result;
    const double side =
        stance.patch_centres[limb].y() > stance.patch_centres[1 - limb].y() ? 1 : -1;
    const std::vector<Vector2d> other = PatchAt(stance, 1 - limb, {});
    for (const double turn : kTurning) {
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

  PoseField FieldOf() {
    std::vector<PoseField::Goal> places;
    for (std::size_t i = 0; i < goals.size(); ++i) {
      const int layer = LayerUnder(0, {goals[i].pose, goals[i].z});
      if (layer >= 0) places.push_back({goals[i].pose, layer, TimeFrom(static_cast<int>(i))});
    }
    const PoseField::Paces paces{kLevelStep / limits.forward, 2 * kLevelStep / limits.lateral,
                                 2 * kLevelStep / limits.turn};
    PoseField::Ground known;
    known.layers = static_cast<int>(ground.planes().size());
    known.time = [this](int layer, const Vector2d& p) { return footholds->Near(layer, p); };
    known.most = is_relaxed ? std::numeric_limits<double>::infinity() : footholds->LongestStep();
    return PoseField(
        world.environment->bounds, CellSize(), headings.empty() ? 0 : headings.front(), places,
        paces, [this](int layer, const PlanarPose& pose) { return MayStandAt(layer, pose); },
        known);
  }

  /// Of the plane that a limb is on; -1 if there is none.
  int LayerUnder(int limb, const Foothold& place) const {
    const Vector2d centre = place.stance * Vector2d(stance.patch_centres[limb].head<2>());
    for (std::size_t layer = 0; layer < ground.planes().size(); ++layer) {
      const models::GroundPlane& plane = world.ground->planes()[ground.planes()[layer]];
      if (plane.normal == place.normal && std::abs(plane.HeightAt(centre) - place.z) < 1e-6) {
        return static_cast<int>(layer);
      }
    }
    return -1;
  }

  /// What the legs' reach leaves of the family.
  FootholdField::StepTimes TimesOfSteps() const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    FootholdField::StepTimes steps;
    steps.pace = kLevelStep / limits.forward;
    const auto distances = static_cast<std::size_t>(
        std::ceil(FootholdFlood::ReachOf(stance, limits) / steps.spacing) + 1);
    for (int row = 0; row * steps.spacing <= limits.rise + steps.spacing / 2; ++row) {
      const double rise = std::min(row * steps.spacing, limits.rise);
      std::vector<double> times(distances, kInfinity);
      for (const int limb : {0, 1}) {
        for (const PlanarPose& displacement : displacements[limb]) {
          for (const double z : {rise, -rise}) AddStep(limb, displacement, z, steps, &times);
        }
      }
      // Where a long step leads, shorter ones do.
      for (std::size_t i = distances - 1; i > 0; --i) {
        times[i - 1] = std::min(times[i - 1], times[i]);
      }
      // Places may be moved.
      if (is_relaxed) {
        const auto moved =
            static_cast<std::ptrdiff_t>(std::ceil(FootholdGround::kMostShift / steps.spacing));
        times.insert(times.begin(), moved, times.front());
      }
      steps.times.push_back(std::move(times));
    }
    return steps;
  }

  void AddStep(int limb, const PlanarPose& displacement, double rise,
               const FootholdField::StepTimes& steps, std::vector<double>* times) const {
    const Foothold other;
    const Foothold place{displacement, rise};
    const std::optional<double> before = Squat(limb, place, other);
    const std::optional<double> after = Squat(1 - limb, other, place);
    if (!before || !after) return;
    const Vector2d centre = displacement * Vector2d(stance.patch_centres[limb].head<2>());
    const double distance = (centre - stance.patch_centres[1 - limb].head<2>()).norm();
    double& time = (*times)[std::lround(distance / steps.spacing)];
    time = std::min(time, std::max(kLevelStep, steps.pace * distance) +
                              StrideTime(displacement.x, rise == 0) +
                              std::max(kSecondsPerMetreClimbed * std::abs(rise),
                                       kSecondsPerSquat * std::max(*before, *after)));
  }

  double TimeFrom(int goal) const { return goal_times.empty() ? 0 : goal_times[goal]; }

  /// Whether no other goal seems quicker by way of this one.
  bool IsBest(int goal) {
    return TimeFrom(goal) <=
           field->At(LayerUnder(0, {goals[goal].pose, goals[goal].z}), goals[goal].pose) + 1e-9;
  }

  double CellSize() const {
    if (world.environment->bounds.isEmpty()) return kCell;
    return std::max(kCell, std::sqrt(world.environment->bounds.sizes().prod() / kMostPoseCells));
  }

  bool MayStandAt(int layer, const PlanarPose& pose) {
    const models::GroundPlane& plane = world.ground->planes()[ground.planes()[layer]];
    return TrunkIsFree(pose, plane.HeightAt(pose.position())) &&
           (is_relaxed || footholds->Stands(layer, pose, kPatchGap));
  }

  static std::int32_t Quantised(double value, double size) {
    return static_cast<std::int32_t>(std::lround(value / size));
  }

  static Key KeyOf(const Node& node) {
    Key key;
    std::size_t i = 0;
    for (const int limb : {0, 1}) {
      const Foothold& foot = node.feet[limb];
      const double coarseness = limb == node.next ? kCoarser : 1;
      key[i++] = Quantised(foot.stance.x, coarseness * kSamePlace);
      key[i++] = Quantised(foot.stance.y, coarseness * kSamePlace);
      key[i++] = Quantised(WrapAngle(foot.stance.yaw), coarseness * kSameTurn);
      key[i++] = Quantised(foot.z, kSameHeight);
    }
    // No other state stands for a goal.
    key[i] = 2 * (1 + GoalAt(node)) + node.next;
    return key;
  }

  static PlanarPose Middle(const Node& node) {
    return Interpolate(node.feet[0].stance, node.feet[1].stance, 0.5);
  }

  void Push(Node node) {
    const int moved = 1 - node.next;
    const double heuristic =
        field->At(node.layers[moved], Middle(node)) + kLevelStep * StepsLeft(node);
    if (!std::isfinite(heuristic)) return;
    open.push({node.cost + kGreed * heuristic, static_cast<int>(nodes.size()), false});
    nodes.push_back(std::move(node));
  }

  /// How much lower than easy the root has to be for a limb to reach a place while the other one
  /// bears, m; at least 0. None if that is too low.
  std::optional<double> Squat(int limb, const Foothold& place, const Foothold& other) const {
    const std::optional<double> highest = reach.HighestRoot(limb, place, other);
    if (!highest || *highest < limits.lowest_root) return std::nullopt;
    return std::max(0.0, stance.gait->posture.root_height - kEasySquat - *highest);
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

  /// Whether a limb's patch keeps off the other one's on its way, seen from above: where it does
  /// not, the legs hit each other, however high it is lifted.
  bool PassesOther(int limb, const Foothold& from, const Foothold& to,
                   const Foothold& other) const {
    const std::vector<Vector2d> bearing = PatchAt(stance, 1 - limb, other.stance);
    for (int i = 1; i < kPassingSamples; ++i) {
      const PlanarPose at =
          Interpolate(from.stance, to.stance, static_cast<double>(i) / kPassingSamples);
      if (GapBetween(PatchAt(stance, limb, at), bearing) < kPatchGap) return false;
    }
    return true;
  }

  /// Tests that cost more, when a node is first taken up.
  bool Test(Node* node, const Refusal& is_refused) {
    if (node->is_tested) return true;
    node->is_tested = true;
    const int moved = 1 - node->next;
    const Foothold& from = nodes[node->parent].feet[moved];
    const Foothold& to = node->feet[moved];
    if (!PassesOther(moved, from, to, node->feet[node->next])) return false;
    if (!TrunkIsFree(*node)) return false;
    const auto lift = ground.LiftBetween(moved, from, to, limits.clearance, limits.lift);
    if (!lift) return false;
    node->lift = *lift;
    return !is_refused || !is_refused({moved, from, to, *lift}, node->feet[node->next]);
  }

  std::optional<Footstep> StepBetween(int limb, const Foothold& from, const Foothold& to,
                                      const Foothold& other) const {
    if (!Squat(limb, from, other) || !Squat(limb, to, other)) return std::nullopt;
    if (GapBetween(PatchAt(stance, limb, to.stance), PatchAt(stance, 1 - limb, other.stance)) <
            kPatchGap ||
        !PassesOther(limb, from, to, other)) {
      return std::nullopt;
    }
    const auto lift = ground.LiftBetween(limb, from, to, limits.clearance, limits.lift);
    if (!lift) return std::nullopt;
    return Footstep{limb, from, to, *lift};
  }

  /// Places that the limb which moves next may try: goals, displacements at square headings, and
  /// displacements. None if it is not one of the family.
  std::optional<PlanarPose> PlaceOf(const Node& node, int number) const {
    const int limb = node.next;
    const PlanarPose& other = node.feet[1 - limb].stance;
    if (number < static_cast<int>(goals.size())) {
      if (!IsWithin(limb, other.Inverse() * goals[number].pose)) return std::nullopt;
      return goals[number].pose;
    }
    number -= static_cast<int>(goals.size());
    const int each = static_cast<int>(displacements[limb].size());
    const int heading = number / each;
    PlanarPose displacement = displacements[limb][number % each];
    if (heading < static_cast<int>(headings.size())) {
      if (displacement.yaw != 0) return std::nullopt;
      displacement.yaw = WrapAngle(4 * (headings[heading] - other.yaw)) / 4;
      if (std::abs(displacement.yaw) > limits.turn || std::abs(displacement.yaw) < 1e-6) {
        return std::nullopt;
      }
    }
    return other * displacement;
  }

  int PlacesOf(int limb) const {
    return static_cast<int>(goals.size() + (headings.size() + 1) * displacements[limb].size());
  }

  /// Layers that the limb which moves next may reach.
  std::vector<int> LayersNear(const Node& node) const {
    const Foothold& other = node.feet[1 - node.next];
    const double reach = limits.forward + limits.lateral + FootholdGround::kMostShift +
                         2 * stance.patch_centres[node.next].head<2>().norm();
    std::vector<int> near;
    for (std::size_t layer = 0; layer < ground.planes().size(); ++layer) {
      const int plane = ground.planes()[layer];
      const bool is_level = plane < static_cast<int>(world.ground->levels().size());
      if (is_level && std::abs(world.ground->levels()[plane] - other.z) > limits.rise + 1e-6) {
        continue;
      }
      if (!world.ground->IsNear(plane, other.stance.position(), reach)) continue;
      near.push_back(static_cast<int>(layer));
    }
    return near;
  }

  /// Values of the places about a node, as if the limb could go there. They are tested later, best
  /// first.
  void Expand(int index) {
    Node& node = nodes[index];
    const int limb = node.next;
    const Foothold& other = node.feet[1 - limb];
    const std::optional<double> squat = Squat(limb, node.feet[limb], other);
    if (!squat) return;
    node.squat = *squat;
    for (const int layer : LayersNear(node)) {
      Branch branch{index, layer, CandidatesOf(node, layer)};
      if (branch.candidates.empty()) continue;
      branches.push_back(std::move(branch));
      PushCandidate(static_cast<int>(branches.size()) - 1);
    }
  }

  std::vector<Candidate> CandidatesOf(const Node& node, int layer) {
    const int limb = node.next;
    const Foothold& other = node.feet[1 - limb];
    std::vector<Candidate> candidates;
    const int places = PlacesOf(limb);
    for (int place = 0; place < places; ++place) {
      const std::optional<PlanarPose> there = PlaceOf(node, place);
      if (!there) continue;
      const Foothold foothold = ground.On(limb, *there, ground.planes()[layer]);
      if (std::abs(foothold.z - other.z) > limits.rise + 1e-6) continue;
      const bool is_goal = place < static_cast<int>(goals.size());
      const int steps_left = !is_goal ? 2 : node.goals[1 - limb] == place ? 0 : 1;
      const double time =
          field->At(layer, Interpolate(other.stance, *there, 0.5)) + kLevelStep * steps_left;
      if (!std::isfinite(time)) continue;
      candidates.push_back({CostOf(node, foothold, node.squat) + kGreed * time, place});
    }
    std::make_heap(candidates.begin(), candidates.end(), std::greater<>());
    return candidates;
  }

  double CostOf(const Node& node, const Foothold& place, double squat) const {
    return node.cost + actions::ExpectedDuration({node.next, node.feet[node.next], place, 0}) +
           kSecondsPerSquat * squat + StrideTime(node, place);
  }

  double StrideTime(const Node& node, const Foothold& place) const {
    const Foothold& other = node.feet[1 - node.next];
    const bool is_level = place.IsLevel() && other.IsLevel() && place.z == other.z;
    return StrideTime((other.stance.Inverse() * place.stance).x, is_level);
  }

  /// What a long stride takes beyond a short one.
  double StrideTime(double ahead, bool is_level) const {
    const double easy = (is_level ? 1 : kEasyStride) * limits.forward;
    return kSecondsPerStride * std::max(0.0, std::abs(ahead) - easy) +
           kSecondsPerMetreBeyond * std::max(0.0, std::abs(ahead) - limits.forward);
  }

  void PushCandidate(int index) {
    const std::vector<Candidate>& candidates = branches[index].candidates;
    if (!candidates.empty()) open.push({candidates.front().value, index, true});
  }

  /// The best place of a branch.
  void TryBest(int index) {
    Branch& branch = branches[index];
    std::vector<Candidate>& candidates = branch.candidates;
    std::pop_heap(candidates.begin(), candidates.end(), std::greater<>());
    const int place = candidates.back().place;
    candidates.pop_back();
    PushCandidate(index);
    const Node& from = nodes[branch.node];
    const auto foothold =
        ground.Place(from.next, *PlaceOf(from, place), ground.planes()[branch.layer]);
    if (foothold) TryStep(branch.node, place, *foothold, branch.layer);
  }

  void TryStep(int parent, int number, const Foothold& place, int layer) {
    const Node& from = nodes[parent];
    const int limb = from.next;
    const Foothold& other = from.feet[1 - limb];
    Node node;
    node.feet = from.feet;
    node.feet[limb] = place;
    node.layers = from.layers;
    node.layers[limb] = layer;
    node.goals = from.goals;
    const bool is_goal = number < static_cast<int>(goals.size()) && IsIn(place, number);
    node.goals[limb] = is_goal ? number : -1;
    node.next = 1 - limb;
    node.parent = parent;
    if (closed.contains(KeyOf(node))) return;
    const std::optional<double> squat = Squat(limb, place, other);
    if (!squat) return;
    if (GapBetween(PatchAt(stance, limb, place.stance), PatchAt(stance, 1 - limb, other.stance)) <
        kPatchGap) {
      return;
    }
    node.cost = CostOf(from, place, std::max(*squat, from.squat));
    Push(std::move(node));
  }

  /// Whether a displacement in the other limb's stance is one of the family.
  bool IsWithin(int limb, const PlanarPose& displacement) const {
    const double side =
        stance.patch_centres[limb].y() > stance.patch_centres[1 - limb].y() ? 1 : -1;
    return std::abs(displacement.x) <= limits.forward + kFamilyRounding &&
           side * displacement.y >= -0.1 * limits.lateral &&
           side * displacement.y <= limits.lateral + kFamilyRounding &&
           std::abs(WrapAngle(displacement.yaw)) <= limits.turn + kFamilyRounding;
  }

  /// Index of the goal in which both limbs stand; -1 if there is none.
  static int GoalAt(const Node& node) {
    return node.goals[0] == node.goals[1] ? node.goals[0] : -1;
  }

  /// At least, until both limbs stand in a goal.
  static int StepsLeft(const Node& node) {
    if (GoalAt(node) >= 0) return 0;
    return node.goals[1 - node.next] >= 0 ? 1 : 2;
  }

  bool IsIn(const Foothold& place, int goal) const {
    const PlanarPose off = goals[goal].pose.Inverse() * place.stance;
    return off.position().norm() < 1e-9 && std::abs(WrapAngle(off.yaw)) < 1e-9 &&
           std::abs(place.z - goals[goal].z) < 1e-9;
  }

  /// False only if there is a proof that no steps lead to any goal. The flood is asked once.
  bool MayReachAGoal(const CancellationToken& cancellation) {
    if (!may_reach) {
      may_reach = true;
      if (!world.environment->bounds.isEmpty()) {
        const FootholdFlood flood(stance, world, ground.planes(), limits, starts, cancellation);
        may_reach = std::any_of(goals.begin(), goals.end(),
                                [&](const GroundedStance& goal) { return flood.Reaches(goal); });
      }
    }
    return *may_reach;
  }

  void Remember(int node, int goal) {
    if (second_best && TimeFrom(second_best->second) <= TimeFrom(goal)) return;
    second_best.emplace(node, goal);
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
  std::vector<GroundedStance> starts;
  std::vector<double> start_times;
  std::vector<GroundedStance> goals;
  std::vector<double> goal_times;
  std::optional<std::pair<int, int>> second_best;  ///< node and its goal
  FootholdGround ground;
  models::CollisionChecker checker;
  models::UprightBoxes trunk;
  StepReach reach;
  std::vector<double> headings;
  std::array<std::vector<PlanarPose>, 2> displacements;
  std::optional<FootholdField> footholds;
  std::optional<PoseField> field;
  std::vector<Node> nodes;
  std::vector<Branch> branches;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  std::unordered_set<Key, HashOfKey> closed;
  std::int64_t expanded = 0;
  std::optional<bool> may_reach;  ///< unless not asked yet
  bool is_relaxed = false;        ///< see BeginAgain
};

FootstepSearch::FootstepSearch(const LocomotionModel& model, int gait, const World& world,
                               const GroundedStance& start,
                               const std::vector<GroundedStance>& goals,
                               const FootstepLimits& limits, const CancellationToken& cancellation)
    : FootstepSearch(model, gait, world, FootstepEnds{{start}, goals, {}, {}}, limits,
                     cancellation) {}

FootstepSearch::FootstepSearch(const LocomotionModel& model, int gait, const World& world,
                               FootstepEnds ends, const FootstepLimits& limits,
                               const CancellationToken& cancellation)
    : search_(std::make_unique<Search>(model, gait, world, std::move(ends), limits, cancellation)) {
}

FootstepSearch::~FootstepSearch() = default;

std::int64_t FootstepSearch::states() const { return search_->expanded; }

std::optional<Footstep> FootstepSearch::StepBetween(int limb, const Foothold& from,
                                                    const Foothold& to,
                                                    const Foothold& other) const {
  return search_->StepBetween(limb, from, to, other);
}

FootstepSearch::Status FootstepSearch::Answer(int node, int goal) {
  goal_ = goal;
  steps_ = search_->StepsTo(node);
  while (search_->nodes[node].parent >= 0) node = search_->nodes[node].parent;
  const Foothold& first = search_->nodes[node].feet.front();
  start_ = search_->goals[goal];  // for its gait
  start_.pose = first.stance;
  start_.z = first.z;
  return Status::kFound;
}

FootstepSearch::Status FootstepSearch::Exhausted() {
  if (!search_->second_best) return Status::kExhausted;
  return Answer(search_->second_best->first, search_->second_best->second);
}

FootstepSearch::Status FootstepSearch::Advance(std::int64_t states,
                                               const CancellationToken& cancellation) {
  Search& search = *search_;
  for (std::int64_t work = 0; work < states * kPlacesPerState; ++work) {
    if (search.expanded >= most_states) return Exhausted();
    if (search.expanded >= kStatesBeforeFlood && !search.MayReachAGoal(cancellation)) {
      return Exhausted();
    }
    if (search.open.empty() && !search.BeginAgain(cancellation)) return Exhausted();
    if (work % kWorkPerQuestion == 0) cancellation.ThrowIfCancelled();
    const auto [value, index, is_branch] = search.open.top();
    search.open.pop();
    if (is_branch) {
      search.TryBest(index);
      continue;
    }
    const Search::Key key = Search::KeyOf(search.nodes[index]);
    if (search.closed.contains(key) || !search.Test(&search.nodes[index], is_refused)) continue;
    search.closed.insert(key);
    ++search.expanded;
    work += kPlacesPerState - 1;
    if (const int goal = Search::GoalAt(search.nodes[index]); goal >= 0) {
      if (search.IsBest(goal)) return Answer(index, goal);
      search.Remember(index, goal);
    }
    search.Expand(index);
  }
  return Status::kSearching;
}

}  // namespace possibility::actions
