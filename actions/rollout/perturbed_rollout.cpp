#include "actions/rollout/perturbed_rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <vector>

#include "dynamics/rollout/compliant_rollout.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Points that bear less, as a share of the weight, may slide.
constexpr double kBearing = 0.02;

/// How far bearing points slide from where they came to bear.
class SlideMeter {
 public:
  explicit SlideMeter(const RolloutReference& reference)
      : model_(*reference.model()),
        normal_(reference.normal()),
        kinematics_(model_.tree()),
        contacts_(reference.Contacts()),
        places_(contacts_.size()) {}

  void Measure(const dynamics::RobotMotion& motion, RolloutDrift* drift) {
    const double least = kBearing * kinematics_.total_mass() * dynamics::kGravity;
    kinematics_.SetPosition(model_.TreeConfiguration(motion.q));
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
      if (normal_.dot(motion.forces.col(static_cast<Eigen::Index>(i))) < least) {
        places_[i].reset();
        continue;
      }
      const dynamics::ContactPoint& point = contacts_[i].point;
      const Vector3d p = kinematics_.Position(point.link, point.p_L);
      if (!places_[i]) places_[i] = p;
      const Vector3d moved = p - *places_[i];
      drift->slide = std::max(drift->slide, (moved - normal_.dot(moved) * normal_).norm());
    }
  }

 private:
  const dynamics::MultibodyModel& model_;
  Vector3d normal_;
  dynamics::TreeKinematics kinematics_;
  std::vector<dynamics::RolloutContact> contacts_;
  std::vector<std::optional<Vector3d>> places_;
};

double TorqueUsed(const dynamics::RobotMotion& motion, const dynamics::MultibodyModel& model) {
  double used = 0;
  for (int i = 0; i < model.num_joints(); ++i) {
    const double limit = model.TorqueLimit(i, motion.torques[i], motion.v);
    if (limit > 0 && std::isfinite(limit))
      used = std::max(used, std::abs(motion.torques[i]) / limit);
  }
  return used;
}

dynamics::CompliantRolloutSettings SimulatorSettings(const RolloutReference& reference,
                                                     const PerturbedRolloutSettings& settings) {
  dynamics::CompliantRolloutSettings simulator;
  const dynamics::MultibodyModel& model = *reference.model();
  simulator.integration.relative_tolerance = settings.tolerance;
  simulator.integration.absolute_tolerances.resize(model.nq() + model.nv());
  simulator.integration.absolute_tolerances << VectorXd::Constant(model.nq(), settings.tolerance),
      VectorXd::Constant(model.nv(), settings.velocity_tolerance);
  simulator.integration.cancellation = settings.cancellation;
  simulator.push = reference.Push();
  simulator.until = [&reference](double t, const auto& q) { return reference.Uprightness(t, q); };
  return simulator;
}

/// Adds a rollout's departures to the drift.
void Record(const RolloutReference& reference, const dynamics::CompliantRollout& rollout,
            double start, double sample_time, dynamics::CompliantSimulator* simulator,
            SlideMeter* slides, RolloutDrift* drift) {
  const double end = rollout.trajectory.end_time();
  const auto samples = static_cast<int>(std::ceil((end - start) / sample_time));
  for (int i = 0; i <= samples; ++i) {
    const double t = std::min(end, start + i * sample_time);
    const dynamics::RobotMotion motion = simulator->MotionAt(rollout, t);
    if (t <= drift->end) reference.Compare(t, motion.q, drift);
    slides->Measure(motion, drift);
    drift->torque_used = std::max(drift->torque_used, TorqueUsed(motion, *reference.model()));
  }
}

void Simulate(const RolloutReference& reference, const PerturbedRolloutSettings& settings,
              RolloutDrift* drift) {
  drift->ends_at_rest = reference.ends_at_rest();
  StepFeedback steps(reference.segment(), reference.model()->tree());
  dynamics::CompliantSimulator simulator(reference.model(), reference.Contacts(),
                                         reference.Control(&steps),
                                         SimulatorSettings(reference, settings));
  std::vector<double> ends = steps.ticks();
  ends.push_back(drift->end + (drift->ends_at_rest ? settings.settling_time : 0));
  SlideMeter slides(reference);
  VectorXd q = reference.Configuration(drift->start);
  VectorXd v = reference.Velocity(drift->start);
  double time = drift->start;
  for (const double until : ends) {
    const dynamics::CompliantRollout rollout = simulator.Run(q, v, time, until);
    const double end = rollout.trajectory.end_time();
    if (settings.compares) {
      Record(reference, rollout, time, settings.sample_time, &simulator, &slides, drift);
    }
    q = rollout.Configuration(end);
    v = rollout.Velocity(end);
    time = end;
    if (rollout.end == dynamics::OdeEnd::kGuard) drift->fell_at = end;
    if (rollout.end == dynamics::OdeEnd::kCancelled) {
      drift->failure = fmt::format("ends at {:.3f} s: cancelled", end);
    }
    if (rollout.end != dynamics::OdeEnd::kTime) break;
    if (until < ends.back()) {
      steps.Sense(time, reference.Tilt(time, q, v),
                  reference.TreeConfiguration(steps.LandingAfter(time)), reference.normal());
    }
  }
  reference.CompareEnd(q, v, drift);
}

}  // namespace

RolloutDrift RollOutPerturbed(const Segment& segment, const models::RobotModel& robot,
                              const models::GroundMap& ground, const Perturbation& perturbation,
                              const PerturbedRolloutSettings& settings) {
  RolloutDrift drift;
  drift.start = segment.phases.front().knots.front().t;
  drift.end = segment.phases.back().knots.back().t;
  try {
    Simulate(RolloutReference(segment, robot, ground, perturbation, settings.gains), settings,
             &drift);
  } catch (const std::exception& error) {
    drift.failure = error.what();
  }
  return drift;
}

}  // namespace possibility::actions
