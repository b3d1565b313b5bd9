#include "actions/verify/verification_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

std::string Words(ViolationKind kind) {
  std::string words = ToString(kind);
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string Line(const Violation& violation) {
  std::string line = fmt::format("  {}: {}", Words(violation.kind), violation.quantity);
  if (!violation.unit.empty()) {
    line +=
        fmt::format(", {:.6g} {} (limit {:.6g})", violation.value, violation.unit, violation.limit);
  }
  if (violation.segment >= 0) {
    line += fmt::format(", segment {} at {:.3f} s", violation.segment, violation.time);
  }
  return line + "\n";
}

std::string Line(const StretchRollout& rollout) {
  const RolloutDrift& drift = rollout.drift;
  std::string line = fmt::format("  simulated segment {} ({:.3f} to {:.3f} s): ", rollout.segment,
                                 drift.start, drift.end);
  if (!drift.failure.empty()) return line + drift.failure + "\n";
  return line + fmt::format(
                    "root within {:.3g} m and {:.3g} rad of the plan, joints {:.3g}; ends {:.3g} m "
                    "and {:.3g} rad off\n",
                    drift.worst_position, drift.worst_orientation, drift.worst_joint,
                    drift.end_position, drift.end_orientation);
}

/// Escapes a path, which may contain line breaks that imitate another line of the report.
std::string Line(const char* what, const std::filesystem::path& file) {
  return file.empty() ? std::string() : fmt::format("  {} {:?}\n", what, file.string());
}

nlohmann::ordered_json ToJson(const StretchRollout& rollout) {
  const RolloutDrift& drift = rollout.drift;
  nlohmann::ordered_json json;
  json["segment"] = rollout.segment;
  json["last_segment"] = rollout.last_segment;
  json["start_s"] = drift.start;
  json["end_s"] = drift.end;
  json["worst_position_m"] = drift.worst_position;
  json["worst_orientation_rad"] = drift.worst_orientation;
  json["worst_joint"] = drift.worst_joint;
  json["end_position_m"] = drift.end_position;
  json["end_orientation_rad"] = drift.end_orientation;
  json["end_speed"] = drift.end_speed;
  json["impacts"] = drift.impacts;
  json["failure"] = drift.failure;
  return json;
}

/// Names and margins in the order of the report.
std::vector<std::pair<const char*, Margin>> Named(const PlanMargins& margins) {
  return {{"zmp", margins.zmp},
          {"ground_edge", margins.ground_edge},
          {"torque", margins.torque},
          {"friction", margins.friction},
          {"joint_speed", margins.joint_speed},
          {"self_distance", margins.self_distance},
          {"obstacle_distance", margins.obstacle_distance}};
}

nlohmann::ordered_json ToJson(const PlanMargins& margins) {
  nlohmann::ordered_json json;
  for (const auto& [name, margin] : Named(margins)) {
    if (margin.segment < 0) {
      json[name] = nullptr;
    } else {
      json[name] = {{"value", margin.value}, {"segment", margin.segment}, {"t", margin.time}};
    }
  }
  return json;
}

std::string Line(const PlanMargins& margins) {
  std::string line = "  margins:";
  const char* separator = " ";
  for (const auto& [name, margin] : Named(margins)) {
    if (margin.segment < 0) continue;
    line += fmt::format("{}{} {:.3g}", separator, name, margin.value);
    separator = ", ";
  }
  return line + "\n";
}

}  // namespace

std::string FormatText(const VerificationReport& report) {
  std::string text = fmt::format("{}: {} samples at most {:.3g} ms apart, checked in {:.2f} s\n",
                                 report.accepted() ? "accepted" : "rejected", report.samples,
                                 1e3 * report.resolution, report.seconds);
  if (report.force_resolution > 0) {
    text += fmt::format("  between samples within {:.2g} m and {:.2g} N of a straight line\n",
                        report.position_resolution, report.force_resolution);
  }
  text += Line("scenario", report.scenario_file) + Line("robot", report.robot_file);
  for (const Violation& violation : report.violations) text += Line(violation);
  for (const StretchRollout& rollout : report.rollouts) text += Line(rollout);
  if (report.margins) text += Line(*report.margins);
  return text;
}

std::string FormatJson(const VerificationReport& report) {
  nlohmann::ordered_json json;
  json["accepted"] = report.accepted();
  json["scenario"] = report.scenario_file.string();
  json["robot"] = report.robot_file.string();
  json["samples"] = report.samples;
  json["resolution_s"] = report.resolution;
  json["resolution_m"] = report.position_resolution;
  json["resolution_n"] = report.force_resolution;
  json["seconds"] = report.seconds;
  json["violations"] = nlohmann::ordered_json::array();
  for (const Violation& violation : report.violations) {
    nlohmann::ordered_json entry;
    entry["kind"] = ToString(violation.kind);
    entry["segment"] = violation.segment;
    entry["time_s"] = violation.time;
    entry["quantity"] = violation.quantity;
    entry["value"] = violation.value;
    entry["limit"] = violation.limit;
    entry["unit"] = violation.unit;
    json["violations"].push_back(std::move(entry));
  }
  if (!report.rollouts.empty()) json["rollout"] = nlohmann::ordered_json::array();
  for (const StretchRollout& rollout : report.rollouts) json["rollout"].push_back(ToJson(rollout));
  if (report.margins) json["margins"] = ToJson(*report.margins);
  return models::JsonText(json);
}

}  // namespace possibility::actions
