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
constexpr double kGreedOfMany = 4;   ///< of more than two limbs
constexpr double kSamePlace = 0.04;  // m
constexpr double kSameTurn = 0.15;   // rad
constexpr double kSameHeight = 0.005;
/// A place is compared more coarsely by that where the foot leaves it next: what follows depends on
/// the other one.
constexpr double kCoarser = 3;

/// A limb that need not move in its turn.
constexpr double kSecondsPerPass = 0.02;

/// Work of one turn: a place that is tried counts as this share of a state.
constexpr std::int64_t kPlacesPerState = 16;
constexpr std::int64_t kWorkPerQuestion = 256;

/// A search that goes on for so many states asks whether the ground can be reached at all.
constexpr std::int64_t kStatesBeforeFlood = 500;

}  // namespace

bool FootstepSearch::Knows(const models::Gait& gait) {
  const std::size_t limbs = gait.limbs.size();
  return StandsOnTwoSoles(gait) || (limbs > 2 && limbs <= kMostLimbs);
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

  /// All limbs' places, and the limb that moves next. The one before it has moved, or was passed
  /// over.
  struct Node {
    std::vector<Foothold> feet;
    std::vector<int> layers;  ///< the feet's planes: indices into ground.planes()
    std::vector<int> goals;   ///< in which the feet stand; -1: in none
    int next = 0;
    int passed = 0;  ///< limbs that were passed over since one has moved
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
  using Key = std::array<std::int32_t, 4 * kMostLimbs + 1>;
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
    if (rules.NumLimbs() > 2) greed = kGreedOfMany;
    lowest_root = limits.lowest_root;
    rules.SetLowestRoot(std::max(limits.lowest_root, limits.usual_root));
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

  bool MaySinkLower() const { return !second_best && rules.limits().lowest_root > lowest_root; }

  /// Begins again with roots as low as may be.
  void SinkLower(const CancellationToken& cancellation) {
    rules.SetLowestRoot(lowest_root);
    is_relaxed = false;
    open = {};
    branches.clear();
    closed.clear();
    Begin(cancellation);
  }

  void Begin(int layer, const Foothold& start, double time) {
    const auto limbs = static_cast<std::size_t>(rules.NumLimbs());
    for (int next = 0; next < rules.NumLimbs(); ++next) {
      Node node;
      node.feet.assign(limbs, start);
      node.layers.assign(limbs, layer);
      node.goals.assign(limbs, -1);
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
    Key key = {};
    std::size_t i = 0;
    for (int limb = 0; limb < static_cast<int>(node.feet.size()); ++limb) {
      const Foothold& foot = node.feet[limb];
      const double coarseness = limb == node.next ? kCoarser : 1;
      key[i++] = Quantised(foot.stance.x, coarseness * kSamePlace);
      key[i++] = Quantised(foot.stance.y, coarseness * kSamePlace);
      key[i++] = Quantised(WrapAngle(foot.stance.yaw), coarseness * kSameTurn);
      key[i++] = Quantised(foot.z, kSameHeight);
    }
    // No other state stands for a goal.
    key[i] = kMostLimbs * (1 + GoalAt(node)) + node.next;
    return key;
  }

  static PlanarPose Middle(const Node& node) { return MeanStance(node.feet); }

  int Before(int limb) const { return (limb + rules.NumLimbs() - 1) % rules.NumLimbs(); }
  int After(int limb) const { return (limb + 1) % rules.NumLimbs(); }
  int Moved(const Node& node) const { return Before(node.next); }

  void Push(Node node) {
    const double time =
        heuristic->At(node.layers[Moved(node)], Middle(node)) + kLevelStep * StepsLeft(node);
    if (!std::isfinite(time)) return;
    open.push({node.cost + greed * time, static_cast<int>(nodes.size()), false});
    nodes.push_back(std::move(node));
  }

  /// At the node, and on the way to it.
  bool TrunkIsFree(const Node& node) const {
    const Node& parent = nodes[node.parent];
    double z = node.feet.front().z;
    for (const Foothold& foot : node.feet) z = std::max(z, foot.z);
    const PlanarPose from = Middle(parent);
    const PlanarPose to = Middle(node);
    return rules.TrunkIsFree(to, z) && rules.TrunkIsFree(Interpolate(from, to, 0.5), z);
  }

  /// Tests that cost more, when a node is first taken up.
  bool Test(Node* node, const Refusal& is_refused) {
    if (node->is_tested) return true;
    node->is_tested = true;
    const int moved = Moved(*node);
    const Foothold& from = nodes[node->parent].feet[moved];
    const Foothold& to = node->feet[moved];
    if (!rules.PassesOthers(node->feet, moved, from)) return false;
    if (!TrunkIsFree(*node)) return false;
    const auto lift = rules.LiftBetween(moved, from, to);
    if (!lift) return false;
    node->lift = *lift;
    return !is_refused || !is_refused({moved, from, to, *lift}, RestOf(node->feet, moved));
  }

  int NumGoals() const { return static_cast<int>(goals.stances.size()); }

  /// Places that the limb which moves next may try: goals, and those of the family about the other
  /// limbs. None if it is not one of the family.
  std::optional<PlanarPose> PlaceOf(const Node& node, int number) const {
    const int limb = node.next;
    const PlanarPose rest = RestOf(node.feet, limb).stance;
    if (number >= NumGoals()) return rules.PlaceAbout(limb, rest, number - NumGoals());
    const PlanarPose& goal = goals.stances[number].pose;
    if (!rules.IsWithin(limb, rest.Inverse() * goal)) return std::nullopt;
    return goal;
  }

  /// Layers that the limb which moves next may reach.
  std::vector<int> LayersNear(const Node& node) const {
    const Foothold rest = RestOf(node.feet, node.next);
    const FootstepLimits& limits = rules.limits();
    const double reach = limits.forward + limits.lateral + FootholdGround::kMostShift +
                         2 * rules.stance().patch_centres[node.next].head<2>().norm();
    std::vector<int> near;
    const std::vector<int>& planes = rules.ground().planes();
    for (std::size_t layer = 0; layer < planes.size(); ++layer) {
      const int plane = planes[layer];
      const bool is_level = plane < static_cast<int>(world.ground->levels().size());
      if (is_level && std::abs(world.ground->levels()[plane] - rest.z) > limits.rise + 1e-6) {
        continue;
      }
      if (!world.ground->IsNear(plane, rest.stance.position(), reach)) continue;
      near.push_back(static_cast<int>(layer));
    }
    return near;
  }

  /// Values of the places about a node, as if the limb could go there. They are tested later, best
  /// first.
  void Expand(int index) {
    PassOver(index);
    Node& node = nodes[index];
    const std::optional<double> squat = rules.Squat(node.feet, node.next);
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

  /// Of more than two limbs one need not move in its turn.
  void PassOver(int index) {
    if (nodes[index].passed + 2 >= rules.NumLimbs()) return;
    Node node = nodes[index];
    ++node.passed;
    node.next = After(node.next);
    node.parent = index;
    node.cost += kSecondsPerPass;
    Push(std::move(node));
  }

  /// All of them; PlaceOf gives single ones.
  std::vector<StepRules::Place> PlacesOf(const Node& node) const {
    const PlanarPose rest = RestOf(node.feet, node.next).stance;
    std::vector<StepRules::Place> places = rules.PlacesAbout(node.next, rest);
    for (StepRules::Place& place : places) place.number += NumGoals();
    for (int goal = 0; goal < NumGoals(); ++goal) {
      const std::optional<PlanarPose> there = PlaceOf(node, goal);
      if (there) places.push_back({goal, *there, rest.Inverse() * *there});
    }
    return places;
  }

  std::vector<Candidate> CandidatesOf(const Node& node, const std::vector<StepRules::Place>& places,
                                      int layer) {
    const int limb = node.next;
    const Foothold rest = RestOf(node.feet, limb);
    const double share = 1.0 / rules.NumLimbs();
    const int plane = rules.ground().planes()[layer];
    std::vector<Candidate> candidates;
    for (const auto& [number, there, displacement] : places) {
      const Foothold foothold = rules.ground().On(limb, there, plane);
      if (std::abs(foothold.z - rest.z) > rules.limits().rise + 1e-6) continue;
      const bool is_goal = number < NumGoals();
      const int steps_left =
          !is_goal ? rules.NumLimbs() : StepsLeft(node.goals, Before(limb), number) - 1;
      const double time =
          heuristic->At(layer, Interpolate(rest.stance, there, share)) + kLevelStep * steps_left;
      if (!std::isfinite(time)) continue;
      const double cost =
          node.cost + rules.Cost(limb, node.feet[limb], foothold, displacement, rest, node.squat);
      candidates.push_back({cost + greed * time, number});
    }
    std::make_heap(candidates.begin(), candidates.end(), std::greater<>());
    return candidates;
  }

  double CostOf(const Node& node, const Foothold& place, double squat) const {
    const int limb = node.next;
    return node.cost + rules.Cost(limb, node.feet[limb], place, RestOf(node.feet, limb), squat);
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
    Node node;
    node.feet = from.feet;
    node.feet[limb] = place;
    node.layers = from.layers;
    node.layers[limb] = layer;
    node.goals = from.goals;
    const bool is_goal = number < NumGoals() && IsIn(place, number);
    node.goals[limb] = is_goal ? number : -1;
    node.next = After(limb);
    node.parent = parent;
    if (closed.contains(KeyOf(node))) return;
    const std::optional<double> squat = rules.Squat(node.feet, limb);
    if (!squat) return;
    if (!rules.KeepsOff(node.feet, limb)) return;
    node.cost = CostOf(from, place, std::max(*squat, from.squat));
    Push(std::move(node));
  }

  /// Index of the goal in which all limbs stand; -1 if there is none.
  static int GoalAt(const Node& node) {
    const int goal = node.goals.front();
    const bool all = std::all_of(node.goals.begin(), node.goals.end(),
                                 [goal](int other) { return other == goal; });
    return all ? goal : -1;
  }

  /// Until all limbs stand in a goal, if they go on in turn.
  int StepsLeft(const Node& node) const {
    if (GoalAt(node) >= 0) return 0;
    const int moved = Moved(node);
    return node.goals[moved] < 0 ? rules.NumLimbs()
                                 : StepsLeft(node.goals, moved, node.goals[moved]);
  }

  /// Until all stand in `goal`, of which one is left at least. `last`: the limb that moved last.
  int StepsLeft(const std::vector<int>& in_goals, int last, int goal) const {
    int left = rules.NumLimbs();
    for (int limb = last; left > 1 && in_goals[limb] == goal; limb = Before(limb)) --left;
    return left;
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
      if (!world.environment->bounds.isEmpty() && StandsOnTwoSoles(*rules.stance().gait)) {
        const FootholdFlood flood(rules.stance(), world, rules.ground().planes(), rules.limits(),
                                  starts, cancellation);
        may_reach = std::any_of(goals.stances.begin(), goals.stances.end(),
                                [&](const GroundedStance& goal) { return flood.Reaches(goal); });
      }
    }
    return *may_reach;
  }

  bool ProvesNone() const { return may_reach && !*may_reach; }

  void Remember(int node, int goal) {
    if (second_best && goals.TimeFrom(second_best->second) <= goals.TimeFrom(goal)) return;
    second_best.emplace(node, goal);
  }

  std::vector<Footstep> StepsTo(int index) const {
    std::vector<Footstep> steps;
    for (; nodes[index].parent >= 0; index = nodes[index].parent) {
      const Node& node = nodes[index];
      if (node.passed > 0) continue;
      const int moved = Moved(node);
      steps.push_back({moved, nodes[node.parent].feet[moved], node.feet[moved], node.lift});
    }
    std::reverse(steps.begin(), steps.end());
    return steps;
  }

  const World& world;
  double greed = kGreed;
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
  double lowest_root = 0;         ///< m, see SinkLower
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

bool FootstepSearch::ProvesNone() const { return search_->ProvesNone(); }

std::optional<Footstep> FootstepSearch::StepBetween(const std::vector<Foothold>& feet, int limb,
                                                    const Foothold& to) const {
  return search_->rules.StepBetween(feet, limb, to);
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
    if (search.MaySinkLower() && search.expanded >= most_states / 2) search.SinkLower(cancellation);
    if (search.expanded >= kStatesBeforeFlood && !search.MayReachAGoal(cancellation)) {
      return Exhausted();
    }
    if (search.open.empty() && !search.BeginAgain(cancellation)) {
      if (search.ProvesNone() || !search.MaySinkLower()) return Exhausted();
      search.SinkLower(cancellation);
      if (search.open.empty() && !search.BeginAgain(cancellation)) return Exhausted();
    }
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
