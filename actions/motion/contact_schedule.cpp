#include "actions/motion/contact_schedule.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace possibility::actions {
namespace {

using Bearing = std::optional<Eigen::Isometry3d>;

/// Tolerance of poses that are the same, m and rad.
constexpr double kSamePose = 1e-9;

[[noreturn]] void Fail(const std::string& fault) {
  throw std::invalid_argument("contact schedule: " + fault);
}

void CheckInterval(const ContactInterval& interval, std::size_t k, std::size_t limbs) {
  if (!(interval.duration > 0 && std::isfinite(interval.duration))) {
    Fail(fmt::format("interval {} lasts {} s, expected more than 0", k, interval.duration));
  }
  if (interval.bearing.size() != limbs) {
    Fail(fmt::format("interval {} has {} limbs, expected {}", k, interval.bearing.size(), limbs));
  }
}

bool IsBorneByAll(const ContactInterval& interval) {
  for (const Bearing& bearing : interval.bearing) {
    if (!bearing) return false;
  }
  return true;
}

}  // namespace

double ContactSchedule::duration() const {
  double duration = 0;
  for (const ContactInterval& interval : intervals) duration += interval.duration;
  return duration;
}

const Eigen::Isometry3d& ContactSchedule::Before(int k, int limb) const {
  while (!intervals[k].bearing[limb]) --k;
  return *intervals[k].bearing[limb];
}

const Eigen::Isometry3d& ContactSchedule::After(int k, int limb) const {
  while (!intervals[k].bearing[limb]) ++k;
  return *intervals[k].bearing[limb];
}

void CheckContactSchedule(const ContactSchedule& schedule) {
  if (schedule.intervals.size() < 2) Fail("fewer than two intervals");
  const std::size_t limbs = schedule.intervals.front().bearing.size();
  if (limbs == 0) Fail("no limbs");
  for (std::size_t k = 0; k < schedule.intervals.size(); ++k) {
    CheckInterval(schedule.intervals[k], k, limbs);
    if (k == 0) continue;
    for (std::size_t limb = 0; limb < limbs; ++limb) {
      const Bearing& before = schedule.intervals[k - 1].bearing[limb];
      const Bearing& now = schedule.intervals[k].bearing[limb];
      if (before && now && !before->isApprox(*now, kSamePose)) {
        Fail(fmt::format("limb {} moves at the start of interval {} without a swing", limb, k));
      }
    }
  }
  if (!IsBorneByAll(schedule.intervals.front()) || !IsBorneByAll(schedule.intervals.back())) {
    Fail("a limb swings in the first or the last interval");
  }
}

}  // namespace possibility::actions
