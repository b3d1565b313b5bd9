#include "experiments/knot_thinning.h"

#include <algorithm>
#include <cmath>

#include "dynamics/tree_kinematics.h"

namespace possibility::experiments {
namespace {

constexpr double kPosition = 1e-3;     // m
constexpr double kOrientation = 5e-4;  // of a quaternion: a milliradian
constexpr double kJoint = 2e-3;        // rad, m
constexpr double kShare = 0.01;        // of limits
constexpr double kShareOfWeight = 0.005;

/// A limit that is none counts as 1.
double ShareOf(double limit) { return kShare * (std::isfinite(limit) && limit > 0 ? limit : 1); }

/// What is drawn of a knot, in units of what can just be told apart.
Eigen::VectorXd Drawn(const models::RobotModel& robot, const actions::Knot& knot) {
  const Eigen::Index n = robot.num_joints();
  Eigen::VectorXd drawn(7 + 3 * n + knot.forces.size());
  drawn.head<4>() = knot.q.head<4>() / kOrientation;
  drawn.segment<3>(4) = knot.q.segment<3>(4) / kPosition;
  drawn.segment(7, n) = knot.q.tail(n) / kJoint;
  for (Eigen::Index i = 0; i < n; ++i) {
    drawn[7 + n + i] = knot.v[6 + i] / ShareOf(robot.joints[i].velocity);
    drawn[7 + 2 * n + i] = knot.tau[i] / ShareOf(robot.joints[i].effort);
  }
  const double weight = dynamics::kGravity * robot.TotalMass();
  drawn.tail(knot.forces.size()) = knot.forces.reshaped() / (kShareOfWeight * weight);
  return drawn;
}

}  // namespace

std::vector<std::size_t> KnotsToDraw(const models::RobotModel& robot, const actions::Phase& phase,
                                     const std::vector<std::size_t>& knots) {
  std::vector<Eigen::VectorXd> drawn;
  for (const std::size_t k : knots) drawn.push_back(Drawn(robot, phase.knots[k]));
  const auto is_line = [&](std::size_t begin, std::size_t end) {
    const double t0 = phase.knots[knots[begin]].t;
    const double duration = phase.knots[knots[end]].t - t0;
    for (std::size_t i = begin + 1; i < end; ++i) {
      const double s = (phase.knots[knots[i]].t - t0) / duration;
      const Eigen::VectorXd error = drawn[i] - (1 - s) * drawn[begin] - s * drawn[end];
      if (error.cwiseAbs().maxCoeff() > 1) return false;
    }
    return true;
  };
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < knots.size();) {
    kept.push_back(knots[i]);
    std::size_t next = i + 1;
    while (next + 1 < knots.size() && is_line(i, next + 1)) ++next;
    i = next;
  }
  return kept;
}

}  // namespace possibility::experiments
