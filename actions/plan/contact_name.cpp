#include "actions/plan/contact_name.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <numeric>
#include <set>
#include <string_view>

#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

[[noreturn]] void Refuse(const std::string& text) {
  throw InputError(fmt::format(
      "contact {:?}, expected a patch, or a patch and ascending points of it as in \"sole[0,3]\"",
      text));
}

/// Accepts one spelling per number: no sign, no space, no leading zero.
std::optional<int> ParseIndex(std::string_view digits) {
  int index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const bool is_whole = error == std::errc() && end == digits.data() + digits.size();
  if (!is_whole || digits.front() == '-' || (digits.front() == '0' && digits.size() > 1)) {
    return std::nullopt;
  }
  return index;
}

BearingPatch Resolve(const models::RobotModel& robot, const std::string& text) {
  const ContactName name = ParseContactName(text);
  const auto found = std::find_if(robot.contacts.begin(), robot.contacts.end(),
                                  [&](const auto& patch) { return patch.name == name.patch; });
  if (found == robot.contacts.end()) {
    throw InputError(
        fmt::format("contact {:?} unknown to the robot, expected a patch of its own", text));
  }
  const int num_points = static_cast<int>(found->points.size());
  BearingPatch bearing;
  bearing.patch = static_cast<int>(found - robot.contacts.begin());
  if (!name.points) {
    bearing.points.resize(num_points);
    std::iota(bearing.points.begin(), bearing.points.end(), 0);
    return bearing;
  }
  if (name.points->back() >= num_points) {
    throw InputError(fmt::format("contact {:?}, expected points from 0 to {}, as {} has them", text,
                                 num_points - 1, name.patch));
  }
  bearing.points = *name.points;
  return bearing;
}

}  // namespace

ContactName ParseContactName(const std::string& text) {
  if (text.empty()) Refuse(text);
  if (text.back() != ']') return {text, std::nullopt};
  const std::size_t bracket = text.rfind('[');
  if (bracket == std::string::npos || bracket == 0) Refuse(text);
  ContactName name{text.substr(0, bracket), std::vector<int>()};
  std::string_view rest(text);
  rest.remove_prefix(bracket + 1);
  rest.remove_suffix(1);
  for (;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view digits = rest.substr(0, comma);
    const std::optional<int> index = digits.empty() ? std::nullopt : ParseIndex(digits);
    if (!index || (!name.points->empty() && *index <= name.points->back())) Refuse(text);
    name.points->push_back(*index);
    if (comma == std::string_view::npos) return name;
    rest.remove_prefix(comma + 1);
  }
}

std::string FormatContactName(const std::string& patch, const std::vector<int>& points) {
  return fmt::format("{}[{}]", patch, fmt::join(points, ","));
}

std::vector<BearingPatch> BearingPatches(const models::RobotModel& robot, const Phase& phase) {
  std::vector<BearingPatch> patches;
  std::set<int> seen;
  for (const std::string& name : phase.contacts) {
    patches.push_back(Resolve(robot, name));
    if (!seen.insert(patches.back().patch).second) {
      throw InputError(
          fmt::format("contact {:?} of a patch that is listed twice, expected once", name));
    }
  }
  return patches;
}

models::ContactPatch PatchOf(const models::RobotModel& robot, const BearingPatch& bearing) {
  models::ContactPatch patch = robot.contacts[bearing.patch];
  std::vector<Eigen::Vector3d> points;
  for (const int point : bearing.points) points.push_back(patch.points[point]);
  patch.points = std::move(points);
  return patch;
}

Eigen::Index CountPoints(const models::RobotModel& robot, const Phase& phase) {
  Eigen::Index count = 0;
  for (const BearingPatch& bearing : BearingPatches(robot, phase)) {
    count += static_cast<Eigen::Index>(bearing.points.size());
  }
  return count;
}

}  // namespace possibility::actions
