#include "actions/onboarding/pace_limits.h"

#include <vector>

#include "actions/motion/motion_builder.h"

namespace possibility::actions {
namespace {

constexpr double kFittedMargin = 0.92;  // as DynamicGait fits paces
constexpr int kTriedSteps = 4;
constexpr double kQuicker = 1.1;

}  // namespace

Pace PaceOf(const models::Gait& gait, double length, double swing, double rise) {
  const models::GaitParameters& p = gait.parameters;
  Pace pace;
  pace.bounds = {length * p.forward, p.lateral, p.turn};
  pace.timing.swing = swing * p.swing_time;
  pace.timing.swing_length = pace.bounds.forward;
  pace.timing.double_support = 0.12 * p.swing_time;
  pace.timing.start = 0.7 * p.swing_time;
  pace.rise = rise * gait.posture.root_height;
  return pace;
}

std::string WhyNot(const DynamicGait& gait, const Pace& pace, const PlanarPose& step) {
  std::vector<PlanarPose> way = {PlanarPose()};
  for (int i = 0; i < kTriedSteps; ++i) way.push_back(way.back() * step);
  MotionSettings settings;
  settings.knot_spacing = 0.02;
  settings.minimum_intervals = 4;
  settings.speed_margin = settings.torque_margin = kFittedMargin;
  try {
    gait.MotionAt(pace, way, settings, false);
    return "";
  } catch (const MotionError& error) {
    return error.what();
  }
}

std::string BindingLimit(const DynamicGait& gait, const models::Gait& of) {
  Pace pace = PaceOf(of, 0.8, 1, 0);
  if (!gait.paces().empty()) {
    pace = gait.paces().front();
    pace.bounds.forward *= kQuicker;
    pace.timing.swing_length = pace.bounds.forward;
  }
  for (const PlanarPose& step :
       {PlanarPose{pace.bounds.forward, 0, 0}, PlanarPose{0, of.parameters.lateral, 0},
        PlanarPose{0, 0, of.parameters.turn}}) {
    if (std::string why = WhyNot(gait, pace, step); !why.empty()) return why;
  }
  return "the clearance between links, or the family of paces ends";
}

}  // namespace possibility::actions
