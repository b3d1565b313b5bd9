#include "actions/footsteps/footstep_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <unordered_set>
#include <utility>

#include "actions/footholds/foothold_flood.h"
#include "actions/footsteps/step_heuristic.h"
#include "actions/footsteps/step_rules.h"

namespace possibility::actions {
namespace {

// Of the search: weight of the heuristic, and sizes within which two places are the same.
constexpr double kGreed = 2.5;
constexpr double kSamePlace = 0.04;  // m
constexpr double kSameTurn = 0.15;   // rad
constexpr double kSameHeight = 0.005;
/// A place is compared more coarsely by that where the foot leaves it next: what follows depends on
/// the other one.
constexpr double kCoarser = 3;

/// Work of one turn: a place that is tried counts as this share of a state.
constexpr std::int64_t kPlacesPerState = 16;
constexpr std::int64_t kWorkPerQuestion = 256;

/// A search that goes on for so many states asks whether the ground can be reached at all.
constexpr std::int64_t kStatesBeforeFlood = 500;

}  // namespace

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
         const FootstepLimits& limits, std::shared_ptr<const StepGround> step_ground,
         const CancellationToken& cancellation)
      : world(world),
        known(std::move(step_ground)),
        starts(std::move(ends.starts)),
        start_times(std::move(ends.start_times)),
        goals{std::move(ends.goals), std::move(ends.goal_times)},
        rules(model, gait, world, *known, limits) {
    Begin(cancellation);
  }

  void Begin(const CancellationToken& cancellation) {
    heuristic.emplace(rules, *known, world, goals, starts, is_relaxed);
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const int layer = heuristic->LayerUnder(0, {starts[i].pose, starts[i].z});
      if (layer < 0) continue;
      heuristic->At(layer, starts[i].pose, cancellation);  // most of the fields
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
    const double time =
        heuristic->At(node.layers[moved], Middle(node)) + kLevelStep * StepsLeft(node);
    if (!std::isfinite(time)) return;
    open.push({node.cost + kGreed * time, static_cast<int>(nodes.size()), false});
    nodes.push_back(std::move(node));
  }

  /// At the node, and on the way to it.
  bool TrunkIsFree(const Node& node) const {
    const Node& parent = nodes[node.parent];
    const double z = std::max(node.feet[0].z, node.feet[1].z);
    const PlanarPose from = Middle(parent);
    const PlanarPose to = Middle(node);
    return rules.TrunkIsFree(to, z) && rules.TrunkIsFree(Interpolate(from, to, 0.5), z);
  }

  /// Tests that cost more, when a node is first taken up.
  bool Test(Node* node, const Refusal& is_refused) {
    if (node->is_tested) return true;
    node->is_tested = true;
    const int moved = 1 - node->next;
    const Foothold& from = nodes[node->parent].feet[moved];
    const Foothold& to = node->feet[moved];
    if (!rules.PassesOther(moved, from, to, node->feet[node->next])) return false;
    if (!TrunkIsFree(*node)) return false;
    const auto lift = rules.LiftBetween(moved, from, to);
    if (!lift) return false;
    node->lift = *lift;
    return !is_refused || !is_refused({moved, from, to, *lift}, node->feet[node->next]);
  }

  int NumGoals() const { return static_cast<int>(goals.stances.size()); }

  /// Places that the limb which moves next may try: goals, and those of the family about the other
  /// limb. None if it is not one of the family.
  std::optional<PlanarPose> PlaceOf(const Node& node, int number) const {
    const int limb = node.next;
    const PlanarPose& other = node.feet[1 - limb].stance;
    if (number >= NumGoals()) return rules.PlaceAbout(limb, other, number - NumGoals());
    const PlanarPose& goal = goals.stances[number].pose;
    if (!rules.IsWithin(limb, other.Inverse() * goal)) return std::nullopt;
    return goal;
  }

  /// Layers that the limb which moves next may reach.
  std::vector<int> LayersNear(const Node& node) const {
    const Foothold& other = node.feet[1 - node.next];
    const FootstepLimits& limits = rules.limits();
    const double reach = limits.forward + limits.lateral + FootholdGround::kMostShift +
                         2 * rules.stance().patch_centres[node.next].head<2>().norm();
    std::vector<int> near;
    const std::vector<int>& planes = rules.ground().planes();
    for (std::size_t layer = 0; layer < planes.size(); ++layer) {
      const int plane = planes[layer];
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
    const std::optional<double> squat = rules.Squat(limb, node.feet[limb], other);
    if (!squat) return;
    node.squat = *squat;
    const std::vector<StepRules::Place> places = PlacesOf(node);
    for (const int layer : LayersNear(node)) {
      Branch branch{index, layer, CandidatesOf(node, places, layer)};
      if (branch.candidates.empty()) continue;
      branches.push_back(std::move(branch));
      PushCandidate(static_cast<int>(branches.size()) - 1);
    }
  }

  /// All of them; PlaceOf gives single ones.
  std::vector<StepRules::Place> PlacesOf(const Node& node) const {
    const PlanarPose& other = node.feet[1 - node.next].stance;
    std::vector<StepRules::Place> places = rules.PlacesAbout(node.next, other);
    for (StepRules::Place& place : places) place.number += NumGoals();
    for (int goal = 0; goal < NumGoals(); ++goal) {
      const std::optional<PlanarPose> there = PlaceOf(node, goal);
      if (there) places.push_back({goal, *there, (other.Inverse() * *there).x});
    }
    return places;
  }

  std::vector<Candidate> CandidatesOf(const Node& node, const std::vector<StepRules::Place>& places,
                                      int layer) {
    const int limb = node.next;
    const Foothold& other = node.feet[1 - limb];
    const int plane = rules.ground().planes()[layer];
    std::vector<Candidate> candidates;
    for (const auto& [number, there, ahead] : places) {
      const Foothold foothold = rules.ground().On(limb, there, plane);
      if (std::abs(foothold.z - other.z) > rules.limits().rise + 1e-6) continue;
      const bool is_goal = number < NumGoals();
      const int steps_left = !is_goal ? 2 : node.goals[1 - limb] == number ? 0 : 1;
      const double time =
          heuristic->At(layer, Interpolate(other.stance, there, 0.5)) + kLevelStep * steps_left;
      if (!std::isfinite(time)) continue;
      const double cost =
          node.cost + rules.Cost(limb, node.feet[limb], foothold, ahead, other, node.squat);
      candidates.push_back({cost + kGreed * time, number});
    }
    std::make_heap(candidates.begin(), candidates.end(), std::greater<>());
    return candidates;
  }

  double CostOf(const Node& node, const Foothold& place, double squat) const {
    const int limb = node.next;
    return node.cost + rules.Cost(limb, node.feet[limb], place, node.feet[1 - limb], squat);
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
    const auto foothold = rules.ground().Place(from.next, *PlaceOf(from, place),
                                               rules.ground().planes()[branch.layer]);
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
    const bool is_goal = number < NumGoals() && IsIn(place, number);
    node.goals[limb] = is_goal ? number : -1;
    node.next = 1 - limb;
    node.parent = parent;
    if (closed.contains(KeyOf(node))) return;
    const std::optional<double> squat = rules.Squat(limb, place, other);
    if (!squat) return;
    if (!rules.KeepsOff(limb, place, other)) return;
    node.cost = CostOf(from, place, std::max(*squat, from.squat));
    Push(std::move(node));
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
    const PlanarPose off = goals.stances[goal].pose.Inverse() * place.stance;
    return off.position().norm() < 1e-9 && std::abs(WrapAngle(off.yaw)) < 1e-9 &&
           std::abs(place.z - goals.stances[goal].z) < 1e-9;
  }

  /// False only if there is a proof that no steps lead to any goal. The flood is asked once.
  bool MayReachAGoal(const CancellationToken& cancellation) {
    if (!may_reach) {
      may_reach = true;
      if (!world.environment->bounds.isEmpty()) {
        const FootholdFlood flood(rules.stance(), world, rules.ground().planes(), rules.limits(),
                                  starts, cancellation);
        may_reach = std::any_of(goals.stances.begin(), goals.stances.end(),
                                [&](const GroundedStance& goal) { return flood.Reaches(goal); });
      }
    }
    return *may_reach;
  }

  void Remember(int node, int goal) {
    if (second_best && goals.TimeFrom(second_best->second) <= goals.TimeFrom(goal)) return;
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

  const World& world;
  std::shared_ptr<const StepGround> known;
  std::vector<GroundedStance> starts;
  std::vector<double> start_times;
  StepGoals goals;
  std::optional<std::pair<int, int>> second_best;  ///< node and its goal
  StepRules rules;
  std::optional<StepHeuristic> heuristic;
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
                     std::make_shared<StepGround>(model, gait, world, limits), cancellation) {}

FootstepSearch::FootstepSearch(const LocomotionModel& model, int gait, const World& world,
                               FootstepEnds ends, const FootstepLimits& limits,
                               std::shared_ptr<const StepGround> known,
                               const CancellationToken& cancellation)
    : search_(std::make_unique<Search>(model, gait, world, std::move(ends), limits,
                                       std::move(known), cancellation)) {}

FootstepSearch::~FootstepSearch() = default;

std::int64_t FootstepSearch::states() const { return search_->expanded; }

bool FootstepSearch::ProvesNone() const { return search_->may_reach && !*search_->may_reach; }

std::optional<Footstep> FootstepSearch::StepBetween(int limb, const Foothold& from,
                                                    const Foothold& to,
                                                    const Foothold& other) const {
  return search_->rules.StepBetween(limb, from, to, other);
}

FootstepSearch::Status FootstepSearch::Answer(int node, int goal) {
  goal_ = goal;
  steps_ = search_->StepsTo(node);
  while (search_->nodes[node].parent >= 0) node = search_->nodes[node].parent;
  const Foothold& first = search_->nodes[node].feet.front();
  start_ = search_->goals.stances[goal];  // for its gait
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
      if (search.heuristic->IsBest(goal)) return Answer(index, goal);
      search.Remember(index, goal);
    }
    search.Expand(index);
  }
  return Status::kSearching;
}

}  // namespace possibility::actions
