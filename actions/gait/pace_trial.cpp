#include "actions/gait/pace_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"

namespace possibility::actions {
namespace {

constexpr double kMargin = 0.92;
/// Of joint speeds and torques, where their shares are measured.
constexpr double kUnlimited = 100;
/// Where links are closer than they must be, a millimetre counts as this share.
constexpr double kSharePerMillimetre = 0.04;

}  // namespace

PaceTrial::PaceTrial(const models::RobotModel& robot, const NominalStance& stance)
    : robot_(&robot), gait_(robot, stance, {}), clearance_(robot, {stance.q}) {}

std::string PaceTrial::WhyNot(const Pace& pace, const PlanarPose& step, double clearance) const {
  MotionSettings settings = gait_.Settings();
  settings.speed_margin = settings.torque_margin = kMargin;
  try {
    return CloseLinks(Motion(pace, step, kSteps, settings), clearance);
  } catch (const MotionError& error) {
    return error.what();
  }
}

double PaceTrial::Load(const Pace& pace, const PlanarPose& step, int steps) const {
  MotionSettings settings = gait_.Settings();
  settings.speed_margin = settings.torque_margin = kUnlimited;
  settings.friction_margin *= kMargin;
  try {
    double load = 0;
    for (const Phase& phase : Motion(pace, step, steps, settings)) {
      for (const Knot& knot : phase.knots) load = std::max(load, LoadOf(knot));
    }
    return load;
  } catch (const MotionError&) {
    return std::numeric_limits<double>::infinity();
  }
}

double PaceTrial::LoadOf(const Knot& knot) const {
  double load = 0;
  for (int i = 0; i < robot_->num_joints(); ++i) {
    const models::Joint& joint = robot_->joints[i];
    load = std::max({load, std::abs(knot.v[6 + i]) / (kMargin * joint.velocity),
                     std::abs(knot.tau[i]) / (kMargin * joint.effort)});
  }
  for (const SelfClearance::Fault& fault : clearance_.Faults(knot.q, kFittedClearance)) {
    const double missing = fault.required - fault.pair.distance;
    load = std::max(load, 1 + 1e3 * missing * kSharePerMillimetre);
  }
  return load;
}

std::vector<Phase> PaceTrial::Motion(const Pace& pace, const PlanarPose& step, int steps,
                                     const MotionSettings& settings) const {
  std::vector<PlanarPose> way = {PlanarPose()};
  for (int i = 0; i < steps; ++i) way.push_back(way.back() * step);
  return gait_.MotionAt(pace, way, settings, false);
}

std::string PaceTrial::CloseLinks(const std::vector<Phase>& motion, double clearance) const {
  for (const Phase& phase : motion) {
    for (const Knot& knot : phase.knots) {
      const auto faults = clearance_.Faults(knot.q, clearance);
      if (faults.empty()) continue;
      const models::Proximity& pair = faults.front().pair;
      return fmt::format("{} is {:.1f} mm from {} at {:.2f} s, expected {:.1f}",
                         robot_->links[pair.link].name, 1e3 * pair.distance,
                         robot_->links[pair.other].name, knot.t, 1e3 * faults.front().required);
    }
  }
  return "";
}

}  // namespace possibility::actions
