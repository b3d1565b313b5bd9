#include "experiments/report/cost_of_transport.h"

#include <cmath>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/report/plan_speeds.h"
#include "models/robot/mimic_joints.h"

namespace possibility::experiments {
namespace {

/// Of every motor, W.
Eigen::ArrayXd Powers(const models::RobotModel& robot, const actions::Knot& knot) {
  return models::MotorTorques(robot, knot.tau).array() * knot.v.tail(robot.num_joints()).array();
}

/// Integral of |p| over a unit of time in which p goes from p0 to p1 on a straight line.
double MeanMagnitude(double p0, double p1) {
  const double sum = std::abs(p0) + std::abs(p1);
  if (p0 * p1 >= 0) return sum / 2;
  return (p0 * p0 + p1 * p1) / (2 * sum);
}

double Weight(const models::RobotModel& robot) { return robot.TotalMass() * dynamics::kGravity; }

}  // namespace

double MotorWork(const models::RobotModel& robot, const actions::Segment& segment) {
  double work = 0;
  for (const actions::Phase& phase : segment.phases) {
    Eigen::ArrayXd before = Powers(robot, phase.knots.front());
    for (std::size_t k = 1; k < phase.knots.size(); ++k) {
      const Eigen::ArrayXd after = Powers(robot, phase.knots[k]);
      const double duration = phase.knots[k].t - phase.knots[k - 1].t;
      work += duration * before.binaryExpr(after, &MeanMagnitude).sum();
      before = after;
    }
  }
  return work;
}

std::optional<double> CostOfTransport(const models::RobotModel& robot, const actions::Plan& plan) {
  if (WaysByAction(plan).empty()) return std::nullopt;
  double work = 0;
  for (const actions::Segment& segment : plan.segments) work += MotorWork(robot, segment);
  return work / (Weight(robot) * PlanarLength(plan));
}

std::vector<std::pair<std::string, double>> CostsOfTransportByAction(
    const models::RobotModel& robot, const actions::Plan& plan) {
  std::vector<std::pair<std::string, double>> costs;
  for (const ActionWay& way : WaysByAction(plan)) {
    double work = 0;
    for (const actions::Segment& segment : plan.segments) {
      if (segment.action == way.action) work += MotorWork(robot, segment);
    }
    costs.emplace_back(way.action, work / (Weight(robot) * way.length));
  }
  return costs;
}

}  // namespace possibility::experiments
