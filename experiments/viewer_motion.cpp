#include "experiments/viewer_motion.h"

#include <cmath>

#include "actions/contact_name.h"
#include "experiments/viewer_momentum.h"
#include "experiments/viewer_phases.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

/// Linear interpolation over this time, s, cannot be told from the motion itself by eye.
constexpr double kFrame = 0.04;
/// The same of a jump, which lasts no longer than a few strides, slowed down.
constexpr double kFineFrame = 0.005;

}  // namespace

Json MotionPacker::Add(const actions::Segment& segment) {
  const std::vector<std::string> names = PhaseNames(robot_, segment);
  const double frame = IsDynamic(segment) ? kFineFrame : kFrame;
  Json phases = Json::array();
  for (std::size_t i = 0; i < segment.phases.size(); ++i) {
    phases.push_back(AddPhase(segment.phases[i], frame));
    phases.back()["name"] = names[i];
  }
  return {{"action", segment.action}, {"phases", phases}};
}

Json MotionPacker::AddPhase(const actions::Phase& phase, double frame) {
  Json contacts = Json::array();
  Json points = Json::array();
  for (const actions::BearingPatch& bearing : actions::BearingPatches(robot_, phase)) {
    contacts.push_back(bearing.patch);
    points.push_back(bearing.points);
  }
  const int first = count_;
  const std::size_t first_force = forces_.size();
  const actions::Knot* kept = nullptr;
  for (const actions::Knot& knot : phase.knots) {
    const bool at_end = &knot == &phase.knots.back();
    if (kept != nullptr && !at_end && knot.t - kept->t < frame) continue;
    kept = &knot;
    AddKnot(knot);
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
  Append(knot.q, &knots_);
  Append(knot.forces.reshaped(), &forces_);
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
  (*data)["forces"] = Packed(forces_);
  (*data)["centres"] = Packed(centres_);
  (*data)["momenta"] = momenta_.ToJson();
  (*data)["rates"] = rates_.ToJson();
  (*data)["torques"] = torques_.ToJson();
}

}  // namespace possibility::experiments
