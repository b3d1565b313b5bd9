#include "actions/plan/contact_schedule_json.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "actions/plan/contact_name.h"
#include "actions/plan/plan_digits.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Json = nlohmann::ordered_json;
using models::JsonCursor;

constexpr double kQuaternionTolerance = 1e-6;

/// [x, y, z, qw, qx, qy, qz], or null.
Json ToJson(const std::optional<Isometry3d>& pose) {
  if (!pose) return nullptr;
  const Eigen::Vector3d& p = pose->translation();
  const Eigen::Quaterniond R(pose->linear());
  Json numbers = Json::array();
  for (const double number : {p.x(), p.y(), p.z(), R.w(), R.x(), R.y(), R.z()}) {
    numbers.push_back(Rounded(number, PlanDigits::kPosition));
  }
  return numbers;
}

std::optional<Isometry3d> ReadPose(const JsonCursor& cursor) {
  if (cursor.value().is_null()) return std::nullopt;
  std::array<double, 7> n{};
  if (cursor.ArraySize() != n.size()) cursor.Fail("expected [x, y, z, qw, qx, qy, qz] or null");
  for (std::size_t i = 0; i < n.size(); ++i) n[i] = cursor[i].Number();
  const Eigen::Quaterniond R(n[3], n[4], n[5], n[6]);
  if (!(std::abs(R.norm() - 1) <= kQuaternionTolerance)) {
    cursor.Fail("expected a unit quaternion (w, x, y, z) after the position");
  }
  Isometry3d pose(R.normalized());
  pose.translation() << n[0], n[1], n[2];
  return pose;
}

models::ContactInterval ReadInterval(const JsonCursor& cursor, std::size_t contacts) {
  cursor.ExpectKeys({"duration_s", "bearing"});
  models::ContactInterval interval;
  interval.duration = cursor["duration_s"].Number();
  const JsonCursor bearing = cursor["bearing"];
  if (bearing.ArraySize() != contacts) {
    bearing.Fail(
        fmt::format("expected {} entries, one per contact, got {}", contacts, bearing.ArraySize()));
  }
  for (std::size_t i = 0; i < contacts; ++i) interval.bearing.push_back(ReadPose(bearing[i]));
  return interval;
}

}  // namespace

Json ToJson(const models::ContactSchedule& schedule) {
  Json json;
  json["contacts"] = schedule.contacts;
  json["intervals"] = Json::array();
  for (const models::ContactInterval& interval : schedule.intervals) {
    if (!std::isfinite(interval.duration)) {
      throw std::invalid_argument("a schedule holds a duration that is not finite");
    }
    Json bearing = Json::array();
    for (const std::optional<Isometry3d>& pose : interval.bearing) bearing.push_back(ToJson(pose));
    json["intervals"].push_back({{"duration_s", interval.duration}, {"bearing", bearing}});
  }
  return json;
}

models::ContactSchedule ReadContactSchedule(const JsonCursor& cursor) {
  cursor.ExpectKeys({"contacts", "intervals"});
  models::ContactSchedule schedule;
  const JsonCursor contacts = cursor["contacts"];
  for (std::size_t i = 0, n = contacts.ArraySize(); i < n; ++i) {
    schedule.contacts.push_back(contacts[i].String());
    try {
      ParseContactName(schedule.contacts.back());
    } catch (const InputError& error) {
      contacts[i].Fail(error.what());
    }
  }
  const JsonCursor intervals = cursor["intervals"];
  for (std::size_t i = 0, n = intervals.ArraySize(); i < n; ++i) {
    schedule.intervals.push_back(ReadInterval(intervals[i], schedule.contacts.size()));
  }
  try {
    models::CheckContactSchedule(schedule);
  } catch (const std::invalid_argument& error) {
    cursor.Fail(error.what());
  }
  return schedule;
}

}  // namespace possibility::actions
