#pragma once

#include <limits>
#include <map>
#include <string>
#include <vector>

#include "actions/evidence/violation.h"

namespace possibility::actions {

/// Time of a check.
struct Instant {
  int segment = -1;
  double time = 0;  ///< s
};

/// Keeps the worst violation of each kind: the one that exceeds its limit by the most tolerances,
/// and among equals the earliest, so that the order of reports does not matter.
class ViolationLog {
 public:
  /// Reports `value` > limit + tolerance, NaN included. `name()` describes the quantity and is only
  /// called then. `tolerance` > 0.
  template <typename Name>
  bool RequireAtMost(ViolationKind kind, const Instant& at, double value, double limit,
                     double tolerance, const char* unit, Name&& name) {
    if (value <= limit + tolerance) return true;
    Add({kind, at.segment, at.time, name(), value, limit + tolerance, unit},
        (value - limit) / tolerance);
    return false;
  }

  /// Reports `value` < limit - tolerance, NaN included.
  template <typename Name>
  bool RequireAtLeast(ViolationKind kind, const Instant& at, double value, double limit,
                      double tolerance, const char* unit, Name&& name) {
    if (value >= limit - tolerance) return true;
    Add({kind, at.segment, at.time, name(), value, limit - tolerance, unit},
        (limit - value) / tolerance);
    return false;
  }

  /// Reports a violation without a measure; `quantity` describes it.
  void Report(ViolationKind kind, const Instant& at, const std::string& quantity);

  void Merge(const ViolationLog& other);
  bool Has(ViolationKind kind) const { return worst_.count(kind) > 0; }
  std::vector<Violation> Worst() const;

 private:
  struct Entry {
    Violation violation;
    double severity = 0;
  };

  void Add(const Violation& violation, double severity);
  static bool IsWorse(const Entry& a, const Entry& b);

  std::map<ViolationKind, Entry> worst_;
};

}  // namespace possibility::actions
