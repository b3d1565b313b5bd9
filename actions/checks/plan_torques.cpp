#include "actions/checks/plan_torques.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "actions/checks/forces_check.h"
#include "actions/evidence/verifier_state.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

/// The phase's bearing points; none if its motion is not one of the robot's.
std::optional<std::vector<BearingPoint>> PointsOf(const models::RobotModel& robot,
                                                  const Phase& phase) {
  std::vector<BearingPoint> points;
  try {
    points = BearingPoints(robot, phase);
  } catch (const InputError&) {
    return std::nullopt;
  }
  const auto n = static_cast<Eigen::Index>(points.size());
  const bool fits = std::all_of(phase.knots.begin(), phase.knots.end(), [&](const Knot& knot) {
    return knot.q.size() == robot.nq() && knot.v.size() == robot.nv() &&
           knot.a.size() == robot.nv() && knot.forces.cols() == n && knot.q.allFinite() &&
           knot.v.allFinite() && knot.a.allFinite() && knot.forces.allFinite() &&
           std::abs(knot.q.head<4>().norm() - 1) < 1e-3;
  });
  return fits ? std::optional(std::move(points)) : std::nullopt;
}

Eigen::VectorXd TorquesAt(const Knot& knot, const std::vector<BearingPoint>& points,
                          const models::RobotModel& robot, StateEvaluator* evaluator) {
  const VerifierState state = evaluator->Evaluate(knot);
  return RealiseForces(state, points, robot, evaluator->dynamics()).torques;
}

}  // namespace

void CompleteTorques(const models::RobotModel& robot, Plan* plan) {
  std::optional<StateEvaluator> evaluator;  // most plans have their torques
  for (Segment& segment : plan->segments) {
    for (Phase& phase : segment.phases) {
      const auto is_without = [](const Knot& knot) { return knot.tau.size() == 0; };
      if (std::none_of(phase.knots.begin(), phase.knots.end(), is_without)) continue;
      const auto points = PointsOf(robot, phase);
      if (!points) continue;
      if (!evaluator) evaluator.emplace(robot);
      for (Knot& knot : phase.knots) {
        if (is_without(knot)) knot.tau = TorquesAt(knot, *points, robot, &*evaluator);
      }
    }
  }
}

PackedTorques TorquesToPack(const models::RobotModel& robot, const Plan& plan) {
  if (plan.version != 2) return PackedTorques::kStored;
  const double step = std::ldexp(1.0, kTorqueBitsFewer - plan.force_bits);
  StateEvaluator evaluator(robot);
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      const auto points = PointsOf(robot, phase);
      if (!points) return PackedTorques::kStored;
      for (const Knot& knot : phase.knots) {
        if (knot.tau.size() != robot.num_joints()) return PackedTorques::kStored;
        const Eigen::VectorXd tau = TorquesAt(knot, *points, robot, &evaluator);
        if (!((knot.tau - tau).cwiseAbs().maxCoeff() <= step)) return PackedTorques::kStored;
      }
    }
  }
  return PackedTorques::kLeftOut;
}

}  // namespace possibility::actions
