#include "actions/verifier_structure.h"

#include <fmt/format.h>

#include <cmath>

#include "actions/contact_name.h"
#include "models/input_error.h"

namespace possibility::actions {
namespace {

constexpr double kTimeTolerance = 1e-9;   // s
constexpr double kLongestInterval = 1.0;  // s, between two knots
constexpr double kQuaternionTolerance = 1e-6;
constexpr double kLargestNumber = 1e6;  // SI, of q, v, a, tau, forces and impulses
constexpr double kContinuity = 1e-6;    // m, rad, m/s, rad/s

/// Thrown out of the walk through the plan: one structural fault is enough.
struct Fault {
  Instant at;
  std::string quantity;
};

void Require(bool holds, const Instant& at, const std::string& quantity) {
  if (!holds) throw Fault{at, quantity};
}

int NumPoints(const models::RobotModel& robot, const Phase& phase, const Instant& at) {
  try {
    return static_cast<int>(CountPoints(robot, phase));
  } catch (const InputError& error) {
    throw Fault{at, error.what()};
  }
}

template <typename Matrix>
bool IsSane(const Matrix& numbers) {
  return numbers.allFinite() && (numbers.array().abs() <= kLargestNumber).all();
}

void CheckKnot(const Knot& knot, const models::RobotModel& robot, int num_points,
               const Instant& at) {
  Require(knot.q.size() == robot.nq() && knot.v.size() == robot.nv() &&
              knot.a.size() == robot.nv() && knot.tau.size() == robot.num_joints(),
          at, "size of q, v, a or tau is not the robot's");
  Require(knot.forces.cols() == num_points, at, "forces are not one per contact point");
  Require(
      IsSane(knot.q) && IsSane(knot.v) && IsSane(knot.a) && IsSane(knot.tau) && IsSane(knot.forces),
      at, "a number is not finite, or beyond 1e6");
  Require(std::abs(knot.q.head<4>().norm() - 1) <= kQuaternionTolerance, at,
          "root quaternion is not of unit length");
}

void CheckImpulses(const Phase& phase, int num_points, bool is_first, const Instant& at) {
  if (phase.impulses.cols() == 0) return;
  Require(!is_first, at, "impact before which there is no motion");
  Require(phase.impulses.cols() == num_points, at, "impulses are not one per contact point");
  Require(IsSane(phase.impulses), at, "an impulse is not finite, or beyond 1e6");
}

/// `end`: the time up to which the plan has come; moved on to the end of the phase.
void CheckPhase(const Phase& phase, const models::RobotModel& robot, int segment, bool is_first,
                double* end) {
  Require(phase.knots.size() >= 2, {segment, *end}, "phase of fewer than two knots");
  const int num_points = NumPoints(robot, phase, {segment, *end});
  CheckImpulses(phase, num_points, is_first, {segment, *end});
  const double start = phase.knots.front().t;
  Require(std::abs(start - *end) <= kTimeTolerance, {segment, *end},
          fmt::format("time jumps to {} s", start));
  for (std::size_t i = 0; i < phase.knots.size(); ++i) {
    const Knot& knot = phase.knots[i];
    const Instant at{segment, *end};
    if (i > 0) {
      Require(knot.t > *end, at, "time does not increase from knot to knot");
      Require(knot.t <= *end + kLongestInterval, at, "more than 1 s between two knots");
    }
    CheckKnot(knot, robot, num_points, at);
    *end = knot.t;
  }
}

void CheckPlan(const Plan& plan, const models::RobotModel& robot) {
  Require(!plan.segments.empty(), {}, "no segments");
  Require(plan.joints.size() == robot.joints.size(), {}, "number of joints is not the robot's");
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    Require(plan.joints[j] == robot.joints[j].name, {},
            fmt::format("joint {:?} is not the robot's {}", plan.joints[j], robot.joints[j].name));
  }
  double end = 0;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    const int segment = static_cast<int>(s);
    Require(!plan.segments[s].phases.empty(), {segment, end}, "segment without phases");
    for (const Phase& phase : plan.segments[s].phases) {
      const bool is_first = &phase == &plan.segments.front().phases.front();
      CheckPhase(phase, robot, segment, is_first, &end);
    }
  }
}

auto Jumps(const std::string& what) {
  return [what] { return what + " jumps between phases"; };
}

void CheckSamePosition(const Knot& before, const Knot& after, const models::RobotModel& robot,
                       const Instant& at, ViolationLog* log) {
  const Eigen::Quaterniond R0(before.q[0], before.q[1], before.q[2], before.q[3]);
  const Eigen::Quaterniond R1(after.q[0], after.q[1], after.q[2], after.q[3]);
  log->RequireAtMost(ViolationKind::kPositionContinuity, at, R0.angularDistance(R1), 0, kContinuity,
                     "rad", Jumps("root orientation"));
  log->RequireAtMost(ViolationKind::kPositionContinuity, at,
                     (after.q - before.q).segment<3>(4).norm(), 0, kContinuity, "m",
                     Jumps("root position"));
  for (int j = 0; j < robot.num_joints(); ++j) {
    log->RequireAtMost(ViolationKind::kPositionContinuity, at,
                       std::abs(after.q[7 + j] - before.q[7 + j]), 0, kContinuity, "rad",
                       Jumps(robot.joints[j].name));
  }
}

void CheckSameVelocity(const Knot& before, const Knot& after, const models::RobotModel& robot,
                       const Instant& at, ViolationLog* log) {
  const Eigen::VectorXd dv = after.v - before.v;
  log->RequireAtMost(ViolationKind::kVelocityContinuity, at, dv.head<3>().norm(), 0, kContinuity,
                     "rad/s", Jumps("root angular velocity"));
  log->RequireAtMost(ViolationKind::kVelocityContinuity, at, dv.segment<3>(3).norm(), 0,
                     kContinuity, "m/s", Jumps("root velocity"));
  for (int j = 0; j < robot.num_joints(); ++j) {
    log->RequireAtMost(ViolationKind::kVelocityContinuity, at, std::abs(dv[6 + j]), 0, kContinuity,
                       "rad/s", Jumps(robot.joints[j].name + " speed"));
  }
}

}  // namespace

void CheckFiles(const Plan& plan, const models::RobotModel& robot, const models::Scenario& scenario,
                ViolationLog* log) {
  const auto require_same = [log](const char* what, const std::string& hash,
                                  const std::string& planned) {
    if (hash == planned) return;
    log->Report(ViolationKind::kFileMismatch, {},
                fmt::format("{} is {}, the plan was made for {:?}: plan again, or verify with the "
                            "file that it was made for",
                            what, hash, planned));
  };
  require_same("robot", robot.content_hash, plan.robot_hash);
  require_same("scenario", scenario.content_hash, plan.scenario_hash);
  if (!scenario.robot_hash.empty() && scenario.robot_hash != robot.content_hash) {
    log->Report(ViolationKind::kFileMismatch, {},
                fmt::format("robot is {}, the scenario's is {}", robot.content_hash,
                            scenario.robot_hash));
  }
}

bool CheckStructure(const Plan& plan, const models::RobotModel& robot, ViolationLog* log) {
  try {
    CheckPlan(plan, robot);
  } catch (const Fault& fault) {
    log->Report(ViolationKind::kStructure, fault.at, fault.quantity);
    return false;
  }
  return true;
}

void CheckContinuity(const Plan& plan, const models::RobotModel& robot, ViolationLog* log) {
  const Knot* before = nullptr;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (const Phase& phase : plan.segments[s].phases) {
      const Knot& after = phase.knots.front();
      if (before != nullptr) {
        const Instant at{static_cast<int>(s), after.t};
        CheckSamePosition(*before, after, robot, at, log);
        if (phase.impulses.cols() == 0) CheckSameVelocity(*before, after, robot, at, log);
      }
      before = &phase.knots.back();
    }
  }
}

}  // namespace possibility::actions
