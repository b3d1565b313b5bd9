#pragma once

#include <vector>

#include "actions/wholebody/signal.h"

namespace possibility::actions {

/// A quantity that changes now and then, each time from rest to rest. Changes may overlap.
class GradualChanges {
 public:
  /// `start`, `duration`: s.
  void Add(double start, double duration, double change) {
    if (change != 0) changes_.push_back({start, duration, change});
  }
  bool empty() const { return changes_.empty(); }

  /// Added to `from`.
  ScalarSignal At(double t, double from = 0) const {
    ScalarSignal sum = Constant(from);
    for (const Change& change : changes_) {
      sum = sum + Blend(0, change.amount, RestToRest(t - change.start, change.duration));
    }
    return sum;
  }

 private:
  struct Change {
    double start = 0;
    double duration = 0;
    double amount = 0;
  };
  std::vector<Change> changes_;
};

}  // namespace possibility::actions
