#include "experiments/viewer/viewer_phases.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "actions/plan/contact_name.h"

namespace possibility::experiments {
namespace {

struct Bearing {
  std::set<int> patches;
  bool is_partial = false;  ///< only some points of every patch
};

std::vector<Bearing> BearingOf(const models::RobotModel& robot, const actions::Segment& segment) {
  std::vector<Bearing> result;
  for (const actions::Phase& phase : segment.phases) {
    Bearing& bearing = result.emplace_back();
    bearing.is_partial = !phase.contacts.empty();
    for (const actions::BearingPatch& patch : actions::BearingPatches(robot, phase)) {
      bearing.patches.insert(patch.patch);
      if (patch.points.size() == robot.contacts[patch.patch].points.size()) {
        bearing.is_partial = false;
      }
    }
  }
  return result;
}

std::vector<std::string> NamesOfJump(const std::vector<Bearing>& bearings) {
  const auto flies = [](const Bearing& bearing) { return bearing.patches.empty(); };
  const auto flight = std::find_if(bearings.begin(), bearings.end(), flies);
  auto crouch = flight;
  while (crouch != bearings.begin() && (crouch == flight || crouch->is_partial)) --crouch;
  const Bearing* touchdown = nullptr;
  std::vector<std::string> names;
  for (auto bearing = bearings.begin(); bearing != bearings.end(); ++bearing) {
    if (flies(*bearing)) {
      names.emplace_back("flight");
      touchdown = nullptr;
    } else if (bearing < flight) {
      const bool is_crouch = bearing == crouch;
      names.emplace_back(bearing->is_partial ? "toes" : is_crouch ? "crouch" : "preparation");
    } else {
      if (touchdown == nullptr) touchdown = &*bearing;
      names.emplace_back(bearing->patches == touchdown->patches ? "settle" : "landing");
    }
  }
  return names;
}

std::string NameOnGround(const models::RobotModel& robot, const std::set<int>& all,
                         const std::set<int>& bearing) {
  std::vector<int> missing;
  std::set_difference(all.begin(), all.end(), bearing.begin(), bearing.end(),
                      std::back_inserter(missing));
  if (missing.empty()) return "stance";
  if (missing.size() == 1) return "swing " + robot.contacts[missing.front()].name;
  std::vector<std::string> names;
  for (const int patch : bearing) names.push_back(robot.contacts[patch].name);
  return fmt::format("on {}", fmt::join(names, ", "));
}

bool Flies(const actions::Segment& segment) {
  return std::any_of(segment.phases.begin(), segment.phases.end(),
                     [](const actions::Phase& phase) { return phase.contacts.empty(); });
}

}  // namespace

std::vector<std::string> PhaseNames(const models::RobotModel& robot,
                                    const actions::Segment& segment) {
  const std::vector<Bearing> bearings = BearingOf(robot, segment);
  if (Flies(segment)) return NamesOfJump(bearings);
  std::set<int> all;
  for (const Bearing& bearing : bearings) {
    all.insert(bearing.patches.begin(), bearing.patches.end());
  }
  std::vector<std::string> names;
  for (const Bearing& bearing : bearings) {
    names.push_back(NameOnGround(robot, all, bearing.patches));
  }
  return names;
}

}  // namespace possibility::experiments
