#include "experiments/viewer_motion.h"

#include <cmath>

#include "actions/contact_name.h"
#include "experiments/knot_thinning.h"
#include "experiments/viewer_momentum.h"
#include "experiments/viewer_phases.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// Linear interpolation over this time, s, cannot be told from the motion itself by eye.
constexpr double kFrame = 0.04;
/// The same of a jump, which lasts no longer than a few strides, slowed down.
constexpr double kFineFrame = 0.005;

/// Knots at least `frame` apart, and the last one.
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
    phases.push_back(AddPhase(segment.phases[i], IsDynamic(segment)));
    phases.back()["name"] = names[i];
  }
  return {{"action", segment.action}, {"phases", phases}};
}

Json MotionPacker::AddPhase(const actions::Phase& phase, bool is_dynamic) {
  Json contacts = Json::array();
  Json points = Json::array();
  for (const actions::BearingPatch& bearing : actions::BearingPatches(robot_, phase)) {
    contacts.push_back(bearing.patch);
    points.push_back(bearing.points);
  }
  const int first = count_;
  const std::size_t first_force = 3 * forces_.size();
  const std::vector<std::size_t> frames = Frames(phase, is_dynamic ? kFineFrame : kFrame);
  for (const std::size_t k : is_dynamic ? frames : KnotsToDraw(robot_, phase, frames)) {
    AddKnot(phase.knots[k]);
  }
  Json json = {{"contacts", contacts},
               {"points", points},
               {"first", first},
               {"count", count_ - first},
               {"forces", first_force}};
  if (phase.impulses.cols() > 0) {
    Json impulses = Json::array();
    for (const double impulse : phase.impulses.reshaped()) {
      impulses.push_back(std::round(1e5 * impulse) / 1e5);
    }
    json["impulses"] = impulses;
  }
  return json;
}

void MotionPacker::AddKnot(const actions::Knot& knot) {
  knots_.push_back(static_cast<float>(knot.t));
  Append(knot.q.head<7>(), &knots_);
  positions_.Add(knot.q.tail(robot_.num_joints()));
  for (const auto force : knot.forces.colwise()) forces_.Add(force);
  const CentroidalState whole = CentroidalStateAt(knot, &kinematics_);
  Append(whole.position, &centres_);
  Eigen::Matrix<double, 6, 1> momenta;
  momenta << whole.linear, whole.angular;
  momenta_.Add(momenta);
  rates_.Add(knot.v.tail(robot_.num_joints()));
  torques_.Add(MotorTorques(robot_, knot.tau));
  ++count_;
}

void MotionPacker::WriteTo(Json* data) const {
  (*data)["knots"] = Packed(knots_);
  (*data)["positions"] = positions_.ToJson();
  (*data)["forces"] = forces_.ToJson();
  (*data)["centres"] = Packed(centres_);
  (*data)["momenta"] = momenta_.ToJson();
  (*data)["rates"] = rates_.ToJson();
  (*data)["torques"] = torques_.ToJson();
}

}  // namespace possibility::experiments
