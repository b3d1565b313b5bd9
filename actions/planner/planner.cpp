#include "actions/planner/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>

#include "actions/checks/structure_check.h"
#include "actions/conditions/exploration_pose.h"
#include "actions/crossing/step_over.h"
#include "actions/motion/motion_schedule.h"
#include "actions/plan/plan_rounding.h"
#include "actions/planner/least_duration.h"
#include "actions/planner/passage_explanation.h"
#include "actions/planner/plan_explanation.h"
#include "actions/planner/planner_memory.h"
#include "actions/planner/request_checks.h"
#include "actions/planner/route_improvement.h"
#include "actions/planner/route_refusals.h"
#include "actions/planner/route_search.h"
#include "actions/refinement/plan_refinement.h"
#include "actions/route/route.h"
#include "actions/route/route_motion.h"
#include "common/cancellation_token.h"
#include "common/deadline.h"
#include "common/stopwatch.h"

namespace possibility::actions {
namespace {

/// Minimum time allowed for motion and verification after the time limit, s.
constexpr double kLeastToFinish = 10;

/// Gain in duration that is worth another plan, s.
constexpr double kLeastGain = 1e-3;

/// Whether the same motion may be free of this violation elsewhere.
bool DependsOnPlace(ViolationKind kind) {
  return kind == ViolationKind::kPenetration || kind == ViolationKind::kContactGround ||
         kind == ViolationKind::kStart || kind == ViolationKind::kGoal ||
         kind == ViolationKind::kBounds;
}

void FillHeader(const models::RobotModel& robot, const models::Scenario& scenario,
                const PlanRequest& request, Plan* plan) {
  plan->robot_file = robot.file;
  plan->robot_hash = robot.content_hash;
  plan->scenario_file = scenario.file;
  plan->scenario_hash = scenario.content_hash;
  plan->seed = request.seed;
  for (const models::Joint& joint : robot.joints) plan->joints.push_back(joint.name);
}

void SayNo(PlanStatus status, const std::string& explanation, PlanResult* result) {
  result->status = status;
  result->explanation = explanation;
  result->plan.no = NoPlan{ToString(status), explanation, {}};
}

/// Rounded to a micrometre: the explored graph is for viewing, and large.
ExploredGraph::Vertex ExploredVertex(const graph::Point& point) {
  const auto rounded = [](double x) { return std::round(1e6 * x) / 1e6; };
  return {point.head<3>().unaryExpr(rounded), rounded(Heading(ToPose(point).linear()))};
}

/// One request, from the checked scenario to a verified plan.
class TraversalPlanner {
 public:
  TraversalPlanner(const models::RobotModel& robot, const models::Scenario& scenario,
                   const PlanRequest& request)
      : robot_(robot),
        scenario_(scenario),
        request_(request),
        last_deadline_(request.time_limit + std::max(request.time_limit, kLeastToFinish)),
        search_(robot, scenario, request) {}

  PlanResult Plan() {
    PlanResult result;
    FillHeader(robot_, scenario_, request_, &result.plan);
    result.plan.timings.preparation_s = search_.preparation_s();
    for (std::uint64_t attempt = 0;; ++attempt) {
      const graph::PathResult path = search_.Find(attempt);
      const bool found = path.status == graph::PathStatus::kFound;
      const double first_s = found ? path.first_path_seconds : path.seconds;
      result.plan.timings.graph_s += first_s;
      result.plan.timings.motion_s += path.seconds - first_s;
      for (const graph::ConfirmationReport& job : path.confirmations) {
        result.plan.timings.confirmation_s += job.seconds;
        if (job.outcome != graph::JobOutcome::kFailed) continue;
        failures_[search_.Actions()[static_cast<size_t>(job.action)]->name()].push_back(
            {job.points, job.reason});
      }
      Record(path, &result);
      if (path.status != graph::PathStatus::kFound) return result;
      try {
        if (Realise(path, &result)) {
          if (request_.improved) Improve(path, &result);
          return result;
        }
      } catch (const Cancelled&) {
        request_.cancellation.ThrowIfCancelled();
        DropMotion(&result.plan);
        SayNo(PlanStatus::kTimeLimit,
              fmt::format("a route was found in {:.2f} s, but time ran out before its motion was "
                          "verified.",
                          result.plan.timings.graph_s) +
                  refusals_.Explain() + ExplainManoeuvres(search_.all_manoeuvres(), failures_),
              &result);
        return result;
      }
    }
  }

 private:
  void Record(const graph::PathResult& path, PlanResult* result) {
    for (const auto& [name, count] : path.counters) result->plan.statistics[name] += count;
    result->plan.statistics["cycles"] = path.statistics.cycles;
    result->plan.statistics["vertices"] = path.statistics.vertices;
    result->plan.statistics["edges"] = path.statistics.edges;
    result->plan.goal = std::max(path.goal, 0);
    ExploredGraph& explored = result->plan.explored;
    explored = {};
    for (const graph::Point& point : path.graph.vertices) {
      explored.vertices.push_back(ExploredVertex(point));
    }
    for (const graph::GraphSnapshot::Edge& edge : path.graph.edges) {
      explored.edges.push_back({edge.from, edge.to, search_.PlanActionOf(edge.action)});
    }
    result->status = StatusOf(path.status);
    if (path.status == graph::PathStatus::kFound) {
      result->plan.search = ReportOf(path);
      return;
    }
    SayNo(result->status, Explain(*result), result);
    result->plan.no->passage = search_.floods().passage();
    if (result->status != PlanStatus::kTimeLimit && search_.floods().has_barrier()) {
      result->plan.no->barrier = search_.floods().barrier();
    }
  }

  /// Edges of a gait begin and end in motion. A route of them begins and ends at rest.
  SearchReport ReportOf(const graph::PathResult& path) const {
    SearchReport report{path.found_by, path.first_duration, path.duration, path.lower_bound};
    const Route route = RouteAlong(search_.model(), search_.all_manoeuvres(), path.path);
    if (route.empty()) return report;
    const double rest_time = RestTime(route.front()) + RestTime(route.back());
    report.first_duration += rest_time;
    report.duration += rest_time;
    return report;
  }

  /// Of a leg's gait, s. Transitions and manoeuvres include theirs.
  double RestTime(const RouteLeg& leg) const {
    const bool is_way = leg.manoeuvre == nullptr && leg.transition < 0;
    return is_way ? search_.model().gaits[leg.gait]->motion->RestTime() : 0;
  }

  static PlanStatus StatusOf(graph::PathStatus status) {
    switch (status) {
      case graph::PathStatus::kFound:
        return PlanStatus::kFound;
      case graph::PathStatus::kProvenInfeasible:
        return PlanStatus::kProvenInfeasible;
      case graph::PathStatus::kExhausted:
        return PlanStatus::kExhausted;
      case graph::PathStatus::kTimeLimit:
        break;
    }
    return PlanStatus::kTimeLimit;
  }

  std::string Explain(const PlanResult& result) {
    const std::string why =
        result.status == PlanStatus::kTimeLimit
            ? fmt::format("no route that can be executed was found within {:.1f} s.",
                          request_.time_limit) +
                  ExplainClosest(result.plan.explored, scenario_.goals)
        : search_.floods().has_barrier()
            ? ExplainBarrier(result.status, search_.floods().barrier())
            : ExplainEffort(scenario_.planner.turns_after_floods) +
                  ExplainClosest(result.plan.explored, scenario_.goals);
    return why + ExplainPassage(search_.floods().has_barrier(), search_.floods().passage()) +
           refusals_.Explain() + ExplainSearch(result.plan.statistics) +
           ExplainManoeuvres(search_.all_manoeuvres(), failures_);
  }

  /// Turns a confirmed path into a verified plan. On failure it forbids the legs at fault.
  /// @throws Cancelled at the time limit.
  bool Realise(const graph::PathResult& path, PlanResult* result) {
    const Stopwatch motion_clock;
    Route route = RouteAlong(search_.model(), search_.all_manoeuvres(), path.path);
    if (route.empty()) route = {Pause(search_.start())};
    const bool moved = Generate(route, &result->plan);
    result->plan.timings.motion_s += motion_clock.Seconds();
    if (moved) {
      NameVertices(path, &result->plan);
      AddSchedule(&result->plan);
    }
    return moved && IsVerified(route, result);
  }

  /// PlanRequest::improved. Routes are changed at random, and now and then another is explored.
  void Improve(const graph::PathResult& path, PlanResult* best) {
    best->least_duration =
        LeastDuration({search_.model(), search_.world(), search_.manoeuvres(), search_.steps(),
                       scenario_.planner},
                      search_.start(), search_.goals(), search_.Until(search_.deadline()));
    request_.improved(*best);
    is_improving_ = true;
    RouteImprovement improvement(
        search_.Space(), RouteAlong(search_.model(), search_.all_manoeuvres(), path.path),
        request_.seed, [this](std::uint64_t round) { return search_.FindElsewhere(round); });
    try {
      while (best->plan.duration() > best->least_duration && !search_.deadline().Passed()) {
        const std::optional<Route> route = improvement.Next(search_.Until(search_.deadline()));
        if (!route) break;
        PlanResult quicker = *best;
        quicker.plan.timings.motion_s = quicker.plan.timings.verification_s = 0;
        if (!RealiseQuicker(*route, best->plan.duration(), &quicker)) continue;
        improvement.Accept(*route);
        *best = std::move(quicker);
        request_.improved(*best);
      }
    } catch (const Cancelled&) {
      request_.cancellation.ThrowIfCancelled();  // otherwise time is up
    }
  }

  /// Whether the route leads to a verified plan shorter than `duration` (s).
  bool RealiseQuicker(const Route& route, double duration, PlanResult* result) {
    const Stopwatch motion_clock;
    if (!Generate(route, &result->plan)) return false;
    result->plan.timings.motion_s = motion_clock.Seconds();
    if (!(result->plan.duration() < duration - kLeastGain)) return false;
    AddSchedule(&result->plan);
    if (!IsVerified(route, result)) return false;
    result->plan.search->duration = ExpectedDuration(search_.model(), route);
    return true;
  }

  /// Of motion and verification.
  CancellationToken UntilTheEnd() const {
    return search_.Until(is_improving_ ? search_.deadline() : last_deadline_);
  }

  /// Motion of other programs may be malformed. It gets no schedule, and the verifier rejects it.
  void AddSchedule(actions::Plan* plan) const {
    ViolationLog log;
    if (CheckStructure(*plan, robot_, &log)) {
      plan->schedule = ScheduleOfMotion(robot_, plan->segments);
    }
  }

  static void DropMotion(actions::Plan* plan) {
    plan->segments.clear();
    plan->schedule.reset();
  }

  /// A pause is not an edge of the graph.
  static void NameVertices(const graph::PathResult& path, actions::Plan* plan) {
    for (size_t i = 0; i < path.path.size(); ++i) {
      plan->segments[i].vertices = {path.path[i].from, path.path[i].to};
    }
  }

  /// What is verified is what will be written.
  void RoundToFile(actions::Plan* plan) const {
    if (request_.plan_version == 2) {
      *plan = RefinedPlan(*plan, robot_);
    } else {
      RoundToPlanDigits(plan);
    }
  }

  bool Generate(const Route& route, actions::Plan* plan) {
    try {
      plan->segments = GenerateMotion(
          search_.model(), scenario_.environment, route, request_.threads, UntilTheEnd(),
          [this](double fraction) { Report("generating motion", fraction); });
      RoundToFile(plan);
      return true;
    } catch (const LegError& error) {
      const RouteLeg& leg = route[static_cast<size_t>(error.leg())];
      refusals_.ByMotion(LegWords(search_.model(), leg), error.what());
      Forbid(leg, error.what());
      plan->statistics["routes refuted by motion generation"]++;
      return false;
    }
  }

  bool IsVerified(const Route& route, PlanResult* result) {
    VerifierSettings settings;
    settings.threads = request_.threads;
    settings.cancellation = UntilTheEnd();
    if (request_.memory) settings.store = &request_.memory->verdicts();
    settings.progress = [this](double fraction) { Report("verifying", fraction); };
    result->verification = Verify(result->plan, robot_, scenario_, settings);
    result->plan.timings.verification_s += result->verification.seconds;
    if (!result->verification.accepted()) {
      std::vector<std::string> legs;
      for (const RouteLeg& leg : route) legs.push_back(LegWords(search_.model(), leg));
      refusals_.ByVerification(result->verification, legs);
    }
    if (result->verification.cancelled) throw Cancelled();
    if (result->verification.accepted()) {
      result->explanation =
          refusals_.Explain() + ExplainManoeuvres(search_.all_manoeuvres(), failures_);
      if (!result->explanation.empty()) result->explanation.erase(0, 1);
      return true;
    }
    bool somebody_is_at_fault = false;
    for (const Violation& violation : result->verification.violations) {
      if (violation.segment < 0) continue;
      somebody_is_at_fault = true;
      Forbid(route[static_cast<size_t>(violation.segment)],
             "its motion does not verify: " + Describe(violation), !DependsOnPlace(violation.kind));
    }
    if (!somebody_is_at_fault) {
      for (const RouteLeg& leg : route) {
        if (leg.manoeuvre != nullptr) {
          Forbid(leg,
                 "its motion does not verify: " + Describe(result->verification.violations.front()),
                 false);
        }
      }
    }
    result->plan.statistics["routes refuted by verification"]++;
    DropMotion(&result->plan);
    return false;
  }

  /// The route of a plan whose start is its goal.
  static RouteLeg Pause(const GroundedStance& stance) {
    RouteLeg leg;
    leg.gait = stance.gait;
    leg.from = leg.to = stance.pose;
    leg.z = leg.z_to = stance.z;
    return leg;
  }

  void Forbid(const RouteLeg& leg, const std::string& reason, bool everywhere = false) {
    const graph::Edge edge = LegEdge(search_.model(), leg);
    if (leg.manoeuvre != nullptr) return leg.manoeuvre->Forbid(edge, reason, everywhere);
    if (leg.transition < 0) return search_.gaits()[static_cast<size_t>(leg.gait)]->Forbid(edge);
    for (const auto& action : search_.gaits()) action->Forbid(edge);
  }

  /// From any thread.
  void Report(const std::string& stage, double fraction) const {
    if (!request_.progress) return;
    const std::lock_guard lock(progress_mutex_);
    request_.progress({stage, {}, fraction});
  }

  const models::RobotModel& robot_;
  const models::Scenario& scenario_;
  const PlanRequest& request_;
  /// Motion and verification of a route found in time may take the time limit again (at least
  /// kLeastToFinish).
  Deadline last_deadline_;
  RouteSearch search_;
  FailedJobs failures_;
  RouteRefusals refusals_;
  bool is_improving_ = false;  ///< a plan is found; a quicker one is looked for
  mutable std::mutex progress_mutex_;
};

/// The request with the manoeuvres that need nothing of the robot's file, unless their name is
/// taken.
PlanRequest WithStepOver(const models::RobotModel& robot, PlanRequest request) {
  std::vector<std::string> taken = FurtherNames(request.gaits, request.manoeuvres);
  for (const models::Gait& gait : robot.gaits) taken.push_back(gait.name);
  for (const models::Jump& jump : robot.jumps) taken.push_back(jump.name);
  if (std::find(taken.begin(), taken.end(), kStepOver) == taken.end()) {
    request.manoeuvres.push_back(StepOverFactory());
  }
  return request;
}

}  // namespace

std::string ToString(PlanStatus status) {
  switch (status) {
    case PlanStatus::kFound:
      return "found";
    case PlanStatus::kProvenInfeasible:
      return "proven_infeasible";
    case PlanStatus::kExhausted:
      return "exhausted";
    case PlanStatus::kTimeLimit:
      return "time_limit";
  }
  return "unknown";
}

PlanResult PlanTraversal(const models::RobotModel& robot, const models::Scenario& scenario,
                         const PlanRequest& request) {
  RequireNewNames(robot, scenario, request.gaits, request.manoeuvres);
  const PlanRequest full = WithStepOver(robot, request);
  models::Scenario asked = scenario;
  if (!full.actions.empty()) asked.actions = full.actions;
  models::CheckScenarioAgainstRobot(asked, robot, FurtherNames(full.gaits, full.manoeuvres));
  try {
    return TraversalPlanner(robot, asked, full).Plan();
  } catch (const Cancelled&) {
    request.cancellation.ThrowIfCancelled();
    PlanResult result;
    FillHeader(robot, scenario, request, &result.plan);
    SayNo(PlanStatus::kTimeLimit, "time ran out while the robot's swept volumes were computed.",
          &result);
    return result;
  }
}

}  // namespace possibility::actions
