#include "experiments/report/plan_summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "actions/verify/verification_report.h"
#include "experiments/report/cost_of_transport.h"
#include "experiments/report/plan_speeds.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

bool Found(const actions::PlanResult& result) {
  return result.status == actions::PlanStatus::kFound;
}

std::string Row(const std::string& name, const std::string& value) {
  return fmt::format("{:<16} {}\n", name, value);
}

std::string Seconds(double value) { return fmt::format("{:.2f} s", value); }

std::string RouteText(const actions::Plan& plan) {
  std::string text;
  for (const ActionSpan& leg : RouteByAction(plan)) {
    const std::string row =
        fmt::format("{:<14} {:>8.2f} s  from {:>8.2f} s", leg.action, leg.duration, leg.begin);
    text += Row(text.empty() ? "route" : "", row);
  }
  return text;
}

/// Mean speeds of the actions and the length of the way.
std::string SpeedsText(const actions::Plan& plan) {
  std::vector<std::string> speeds;
  for (const auto& [action, speed] : SpeedsByAction(plan)) {
    speeds.push_back(fmt::format("{} {:.2f} m/s", action, speed));
  }
  if (speeds.empty()) return {};
  return Row("speeds",
             fmt::format("{}; {:.2f} m in all", fmt::join(speeds, ", "), PlanarLength(plan)));
}

/// Mechanical cost of transport of the actions and of the plan.
std::string CostsText(const models::RobotModel& robot, const actions::Plan& plan) {
  const std::optional<double> whole = CostOfTransport(robot, plan);
  if (!whole) return {};
  std::vector<std::string> costs;
  for (const auto& [action, cost] : CostsOfTransportByAction(robot, plan)) {
    costs.push_back(fmt::format("{} {:.2f}", action, cost));
  }
  return Row("transport cost", fmt::format("{}; {:.2f} in all", fmt::join(costs, ", "), *whole));
}

/// The explorers of the route, and the gain over the first one.
std::string SearchText(const actions::Plan& plan) {
  if (!plan.search || plan.search->explorers.empty()) return {};
  const actions::SearchReport& search = *plan.search;
  std::string text = Row("found by", fmt::format("{}", fmt::join(search.explorers, ", ")));
  text += Row(
      "expected",
      fmt::format("{:.2f} s, the first route {:.2f} s{}", search.duration, search.first_duration,
                  search.lower_bound > 0
                      ? fmt::format(", no route searched is expected in less than {:.2f} s",
                                    search.lower_bound)
                      : std::string()));
  return text;
}

}  // namespace

std::vector<ActionSpan> RouteByAction(const actions::Plan& plan) {
  std::vector<ActionSpan> legs;
  for (const actions::Segment& segment : plan.segments) {
    if (segment.phases.empty()) continue;
    const double begin = segment.phases.front().knots.front().t;
    const double end = segment.phases.back().knots.back().t;
    if (legs.empty() || legs.back().action != segment.action) {
      legs.push_back({segment.action, begin, 0});
    }
    legs.back().duration = end - legs.back().begin;
  }
  return legs;
}

double PlanningSeconds(const actions::Plan& plan) {
  return plan.timings.preparation_s + plan.timings.graph_s + plan.timings.motion_s;
}

std::optional<double> RealTimeRatio(const actions::Plan& plan) {
  const double planning = PlanningSeconds(plan);
  if (planning <= 0) return std::nullopt;
  return plan.duration() / planning;
}

std::string SummaryText(const actions::PlanResult& result, const models::RobotModel& robot,
                        const PlanFiles& files) {
  const actions::Plan& plan = result.plan;
  std::string text = Row("status", actions::ToString(result.status));
  if (Found(result)) {
    text += RouteText(plan);
    text += Row("plan duration", Seconds(plan.duration()));
    text += SpeedsText(plan);
    text += CostsText(robot, plan);
    text += SearchText(plan);
  }
  text += Row("preparation", Seconds(plan.timings.preparation_s));
  text += Row("graph", Seconds(plan.timings.graph_s));
  text += Row("motion", Seconds(plan.timings.motion_s));
  text += Row("verification", Seconds(plan.timings.verification_s));
  if (const auto ratio = RealTimeRatio(plan); ratio && Found(result)) {
    text += Row("real-time ratio", fmt::format("{:.1f}", *ratio));
  }
  text += Row("plan", files.plan.string());
  return text + Row("page", files.page.string());
}

std::string SummaryJson(const actions::PlanResult& result, const models::RobotModel& robot,
                        const PlanFiles& files) {
  const actions::Plan& plan = result.plan;
  Json json;
  json["status"] = Found(result) ? "found" : "no_plan";
  if (!Found(result)) {
    json["no"] = actions::ToString(result.status);
    json["explanation"] = result.explanation;
  }
  json["seed"] = plan.seed;
  json["preparation_s"] = plan.timings.preparation_s;
  json["graph_s"] = plan.timings.graph_s;
  json["confirmation_s"] = plan.timings.confirmation_s;
  json["motion_s"] = plan.timings.motion_s;
  json["verification_s"] = plan.timings.verification_s;
  json["statistics"] = plan.statistics;
  if (Found(result)) {
    const auto ratio = RealTimeRatio(plan);
    json["plan_duration_s"] = plan.duration();
    json["real_time_ratio"] = ratio ? Json(*ratio) : Json(nullptr);
    json["path_length_m"] = PlanarLength(plan);
    json["speeds"] = Json::object();
    for (const auto& [action, speed] : SpeedsByAction(plan)) json["speeds"][action] = speed;
    const std::optional<double> cost = CostOfTransport(robot, plan);
    json["cost_of_transport"] = cost ? Json(*cost) : Json(nullptr);
    json["cost_of_transport_by_action"] = Json::object();
    for (const auto& [action, part] : CostsOfTransportByAction(robot, plan)) {
      json["cost_of_transport_by_action"][action] = part;
    }
    json["goal"] = plan.goal;
    if (plan.search) {
      json["explorers"] = plan.search->explorers;
      json["expected_duration_s"] = plan.search->duration;
      json["first_duration_s"] = plan.search->first_duration;
      json["lower_bound_s"] = plan.search->lower_bound;
    }
    json["route"] = Json::array();
    for (const ActionSpan& leg : RouteByAction(plan)) {
      json["route"].push_back(
          {{"action", leg.action}, {"begin_s", leg.begin}, {"duration_s", leg.duration}});
    }
    json["verification"] = Json::parse(actions::FormatJson(result.verification));
  }
  json["plan"] = files.plan.string();
  json["page"] = files.page.string();
  return models::JsonText(json);
}

}  // namespace possibility::experiments
