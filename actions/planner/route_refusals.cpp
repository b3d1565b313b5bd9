#include "actions/planner/route_refusals.h"

#include <fmt/format.h>

#include <algorithm>

namespace possibility::actions {
namespace {

/// The earliest violation that belongs to a leg; if none does, the earliest.
const Violation& First(const std::vector<Violation>& violations) {
  return *std::min_element(violations.begin(), violations.end(),
                           [](const Violation& a, const Violation& b) {
                             if ((a.segment < 0) != (b.segment < 0)) return a.segment >= 0;
                             return a.time < b.time;
                           });
}

std::string Times(int count, const char* what) {
  return count == 0 ? std::string() : fmt::format(", {} {}", count, what);
}

}  // namespace

std::string Describe(const Violation& violation) {
  std::string words = fmt::format("{}, {}", ToString(violation.kind), violation.quantity);
  std::replace(words.begin(), words.end(), '_', ' ');
  if (violation.unit.empty()) return words;
  return words + fmt::format(", {:.4g} {} (limit {:.4g})", violation.value, violation.unit,
                             violation.limit);
}

void RouteRefusals::ByMotion(const std::string& leg, const std::string& why) {
  ++by_motion_;
  Add(fmt::format("{}: {}", leg, why));
}

void RouteRefusals::ByVerification(const VerificationReport& report,
                                   const std::vector<std::string>& legs) {
  if (report.violations.empty()) return;
  ++by_verification_;
  const Violation& violation = First(report.violations);
  const bool is_of_a_leg =
      violation.segment >= 0 && violation.segment < static_cast<int>(legs.size());
  Add(is_of_a_leg ? fmt::format("{}: {}", legs[violation.segment], Describe(violation))
                  : Describe(violation));
}

void RouteRefusals::Add(const std::string& what) {
  if (first_.empty()) first_ = what;
}

std::string RouteRefusals::Explain() const {
  const int count = by_motion_ + by_verification_;
  if (count == 0) return {};
  return fmt::format(" {} came to nothing{}{}; the first in {}.",
                     count == 1 ? "1 confirmed route" : fmt::format("{} confirmed routes", count),
                     Times(by_motion_, "without a motion"),
                     Times(by_verification_, "refused by verification"), first_);
}

}  // namespace possibility::actions
