#include "experiments/viewer/viewer_motion.h"

#include <cmath>

#include "experiments/viewer/viewer_balance.h"
#include "experiments/viewer/viewer_momentum.h"
#include "experiments/viewer/viewer_phases.h"
#include "models/robot/mimic_joints.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// Linear interpolation over this time, s, is visually indistinguishable from the motion.
constexpr double kFrame = 0.04;
/// The same for a jump in slow motion; it is short, lasting no longer than a few strides.
constexpr double kFineFrame = 0.005;

/// Indices of knots at least `frame` apart, and of the last one.
std::vector<std::size_t> Frames(const actions::Phase& phase, double frame) {
  std::vector<std::size_t> frames;
  for (std::size_t k = 0; k < phase.knots.size(); ++k) {
    const bool at_end = k + 1 == phase.knots.size();
    if (!frames.empty() && !at_end && phase.knots[k].t - phase.knots[frames.back()].t < frame) {
      continue;
    }
    frames.push_back(k);
  }
  return frames;
}

}  // namespace

Json MotionPacker::Add(const actions::Segment& segment) {
  const std::vector<std::string> names = PhaseNames(robot_, segment);
  Json phases = Json::array();
  for (std::size_t i = 0; i < segment.phases.size(); ++i) {
    phases.push_back(AddPhase(segment.phases[i], HasFlightOrImpact(segment)));
    phases.back()["name"] = names[i];
  }
  return {{"action", segment.action}, {"phases", phases}};
}

Json MotionPacker::AddPhase(const actions::Phase& phase, bool is_dynamic) {
  Json contacts = Json::array();
  Json points = Json::array();
  bearing_ = actions::BearingPatches(robot_, phase);
  for (const actions::BearingPatch& bearing : bearing_) {
    contacts.push_back(bearing.patch);
    points.push_back(bearing.points);
  }
  const std::vector<std::size_t> frames = Frames(phase, is_dynamic ? kFineFrame : kFrame);
  AddKnots(phase, frames);
  Json json = {{"contacts", contacts}, {"points", points}, {"count", frames.size()}};
  if (phase.impulses.cols() > 0) {
    Json impulses = Json::array();
    for (const double impulse : phase.impulses.reshaped()) {
      impulses.push_back(std::round(1e5 * impulse) / 1e5);
    }
    json["impulses"] = impulses;
  }
  return json;
}

void MotionPacker::AddKnots(const actions::Phase& phase, const std::vector<std::size_t>& frames) {
  std::vector<std::vector<float>> courses;
  std::size_t first = 0;  // of the knots that a frame stands for
  for (const std::size_t k : frames) {
    const std::vector<float> drawn = Drawn(phase.knots[k], margins_.Worst(phase, first, k));
    first = k + 1;
    courses.resize(drawn.size());
    for (std::size_t i = 0; i < drawn.size(); ++i) courses[i].push_back(drawn[i]);
  }
  for (const std::vector<float>& course : courses) indices_.push_back(courses_.IndexOf(course));
}

std::vector<float> MotionPacker::Drawn(const actions::Knot& knot,
                                       const FrameMargins::Numbers& margins) {
  std::vector<float> drawn = {static_cast<float>(knot.t)};
  Append(knot.q, &drawn);
  const CentroidalState whole = CentroidalStateAt(knot, &kinematics_);
  Append(whole.position, &drawn);
  Append(whole.linear, &drawn);
  Append(whole.angular, &drawn);
  Append(knot.v.tail(robot_.num_joints()), &drawn);
  Append(models::MotorTorques(robot_, knot.tau), &drawn);
  const BalanceState balance = BalanceStateAt(bearing_, knot.forces, whole, kinematics_);
  Eigen::Matrix<double, 6, 1> numbers;
  numbers << balance.zmp, balance.margin, balance.capture;
  Append((numbers * 1e5).array().round() / 1e5, &drawn);
  Append(margins, &drawn);
  Append(knot.forces.reshaped(), &drawn);
  return drawn;
}

void MotionPacker::WriteTo(Json* data) const {
  (*data)["courses"] = courses_.ToJson();
  (*data)["indices"] = Packed(indices_);
}

}  // namespace possibility::experiments
