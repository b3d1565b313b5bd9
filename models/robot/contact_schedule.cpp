#include "models/robot/contact_schedule.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace possibility::models {
namespace {

using Bearing = std::optional<Eigen::Isometry3d>;

/// Tolerance of poses that are the same, m and rad.
constexpr double kSamePose = 1e-9;

[[noreturn]] void Fail(const std::string& fault) {
  throw std::invalid_argument("contact schedule: " + fault);
}

void CheckInterval(const ContactInterval& interval, std::size_t k, std::size_t contacts) {
  if (!(interval.duration > 0 && std::isfinite(interval.duration))) {
    Fail(fmt::format("interval {} lasts {} s, expected more than 0", k, interval.duration));
  }
  if (interval.bearing.size() != contacts) {
    Fail(fmt::format("interval {} has {} entries, expected {}, one per contact", k,
                     interval.bearing.size(), contacts));
  }
}

}  // namespace

double ContactSchedule::duration() const {
  double duration = 0;
  for (const ContactInterval& interval : intervals) duration += interval.duration;
  return duration;
}

const Eigen::Isometry3d& ContactSchedule::Before(int k, int contact) const {
  while (!intervals[k].bearing[contact]) --k;
  return *intervals[k].bearing[contact];
}

const Eigen::Isometry3d& ContactSchedule::After(int k, int contact) const {
  while (!intervals[k].bearing[contact]) ++k;
  return *intervals[k].bearing[contact];
}

void CheckContactSchedule(const ContactSchedule& schedule) {
  if (schedule.contacts.empty()) Fail("no contacts");
  if (schedule.intervals.empty()) Fail("no intervals");
  std::set<std::string> names;
  for (const std::string& contact : schedule.contacts) {
    if (!names.insert(contact).second) Fail(contact + " is listed twice");
  }
  for (std::size_t k = 0; k < schedule.intervals.size(); ++k) {
    CheckInterval(schedule.intervals[k], k, schedule.contacts.size());
    if (k == 0) continue;
    for (std::size_t contact = 0; contact < schedule.contacts.size(); ++contact) {
      const Bearing& before = schedule.intervals[k - 1].bearing[contact];
      const Bearing& now = schedule.intervals[k].bearing[contact];
      if (before && now && !before->isApprox(*now, kSamePose)) {
        Fail(fmt::format("{} moves at the start of interval {} without a swing",
                         schedule.contacts[contact], k));
      }
    }
  }
}

}  // namespace possibility::models
