#include "actions/verification_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

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

}  // namespace

std::string FormatText(const VerificationReport& report) {
  std::string text = fmt::format("{}: {} samples at most {:.3g} ms apart, checked in {:.2f} s\n",
                                 report.accepted() ? "accepted" : "rejected", report.samples,
                                 1e3 * report.resolution, report.seconds);
  for (const Violation& violation : report.violations) text += Line(violation);
  return text;
}

std::string FormatJson(const VerificationReport& report) {
  nlohmann::ordered_json json;
  json["accepted"] = report.accepted();
  json["samples"] = report.samples;
  json["resolution_s"] = report.resolution;
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
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace possibility::actions
