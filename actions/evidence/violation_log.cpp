#include "actions/evidence/violation_log.h"

#include <cmath>
#include <tuple>

namespace possibility::actions {

void ViolationLog::Report(ViolationKind kind, const Instant& at, const std::string& quantity) {
  Add({kind, at.segment, at.time, quantity, 1, 0, ""}, std::numeric_limits<double>::infinity());
}

void ViolationLog::Merge(const ViolationLog& other) {
  for (const auto& [kind, entry] : other.worst_) Add(entry.violation, entry.severity);
}

std::vector<Violation> ViolationLog::Worst() const {
  std::vector<Violation> violations;
  for (const auto& [kind, entry] : worst_) violations.push_back(entry.violation);
  return violations;
}

void ViolationLog::Add(const Violation& violation, double severity) {
  const Entry entry{violation,
                    std::isnan(severity) ? std::numeric_limits<double>::infinity() : severity};
  const auto [place, is_first] = worst_.emplace(violation.kind, entry);
  if (!is_first && IsWorse(entry, place->second)) place->second = entry;
}

bool ViolationLog::IsWorse(const Entry& a, const Entry& b) {
  if (a.severity != b.severity) return a.severity > b.severity;
  return std::tie(a.violation.segment, a.violation.time, a.violation.quantity) <
         std::tie(b.violation.segment, b.violation.time, b.violation.quantity);
}

}  // namespace possibility::actions
