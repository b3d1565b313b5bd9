#include "actions/checks/flight_check.h"

#include <algorithm>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr double kPathTolerance = 1e-4;      // m
constexpr double kMomentumTolerance = 1e-3;  // of the angular momentum
/// s: a robot with an angular momentum below weight x 1 m x this hardly turns.
constexpr double kLeastMomentum = 1e-3;

}  // namespace

std::vector<std::optional<Flight>> FollowFlights(const Plan& plan, StateEvaluator* evaluator) {
  std::vector<std::optional<Flight>> result;
  std::optional<Flight> flight;
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      if (!phase.contacts.empty()) {
        flight.reset();
      } else if (!flight) {
        const Knot& knot = phase.knots.front();
        evaluator->Evaluate(knot);
        const dynamics::SimbodyDynamics& dynamics = evaluator->dynamics();
        flight = Flight{knot.t, dynamics.CentreOfMass(), dynamics.CentreOfMassVelocity(),
                        dynamics.CentroidalMomentum().head<3>()};
      }
      result.push_back(flight);
    }
  }
  return result;
}

void CheckFlight(const VerifierState& state, const Flight& flight, const models::RobotModel& robot,
                 const dynamics::SimbodyDynamics& dynamics, const Instant& at, ViolationLog* log) {
  const double t = state.knot.t - flight.start;
  const Vector3d expected =
      flight.position + t * flight.velocity - Vector3d(0, 0, dynamics::kGravity * t * t / 2);
  log->RequireAtMost(ViolationKind::kFlight, at, (dynamics.CentreOfMass() - expected).norm(), 0,
                     kPathTolerance, "m",
                     [] { return std::string("centre of mass off its parabola"); });
  const Vector3d change = dynamics.CentroidalMomentum().head<3>() - flight.angular_momentum;
  const double weight = robot.TotalMass() * dynamics::kGravity;
  const double scale = std::max(flight.angular_momentum.norm(), kLeastMomentum * weight);
  log->RequireAtMost(ViolationKind::kFlight, at, change.norm(), 0, kMomentumTolerance * scale,
                     "kg m^2/s",
                     [] { return std::string("change of angular momentum in flight"); });
}

}  // namespace possibility::actions
