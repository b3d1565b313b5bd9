#include "actions/checks/structure_check.h"

#include <fmt/format.h>

#include <cmath>

#include "actions/plan/contact_name.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using Eigen::VectorXd;

constexpr double kOrderTolerance = 1e-9;   // s
constexpr double kLongestInterval = 1.0;  // s, between two knots
constexpr double kQuaternionTolerance = 1e-6;
constexpr double kLargestNumber = 1e6;  // SI, of q, v, a, tau, forces and impulses
constexpr double kContinuity = 1e-6;    // m, rad, m/s, rad/s, over the whole plan

/// Thrown to end the walk through the plan: one structural fault is enough.
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

/// `end`: end time of the plan so far; set to the end of the phase.
void CheckPhase(const Phase& phase, const models::RobotModel& robot, int segment, bool is_first,
                double* end) {
  Require(phase.knots.size() >= 2, {segment, *end}, "phase of fewer than two knots");
  const int num_points = NumPoints(robot, phase, {segment, *end});
  CheckImpulses(phase, num_points, is_first, {segment, *end});
  const double start = phase.knots.front().t;
  Require(std::abs(start - *end) <= kOrderTolerance, {segment, *end},
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
  return [what] { return what + " jumps between phases, in all"; };
}

/// Discontinuities between phases and segments, summed over the plan: a jump below the tolerance at
/// every phase could carry a robot anywhere.
class Jumped {
 public:
  explicit Jumped(const models::RobotModel& robot)
      : robot_(robot),
        position_(VectorXd::Zero(robot.num_joints())),
        velocity_(VectorXd::Zero(robot.num_joints())) {}

  void AddPosition(const Knot& before, const Knot& after, const Instant& at, ViolationLog* log) {
    const Eigen::Quaterniond R0(before.q[0], before.q[1], before.q[2], before.q[3]);
    const Eigen::Quaterniond R1(after.q[0], after.q[1], after.q[2], after.q[3]);
    root_.turned += R0.angularDistance(R1);
    root_.moved += (after.q - before.q).segment<3>(4).norm();
    position_ += (after.q - before.q).tail(robot_.num_joints()).cwiseAbs();
    const auto require = [&](double sum, const char* unit, const std::string& what) {
      log->RequireAtMost(ViolationKind::kPositionContinuity, at, sum, 0, kContinuity, unit,
                         Jumps(what));
    };
    require(root_.turned, "rad", "root orientation");
    require(root_.moved, "m", "root position");
    for (int j = 0; j < robot_.num_joints(); ++j) {
      require(position_[j], "rad", robot_.joints[j].name);
    }
  }

  void AddVelocity(const Knot& before, const Knot& after, const Instant& at, ViolationLog* log) {
    const VectorXd dv = after.v - before.v;
    root_.angular_velocity += dv.head<3>().norm();
    root_.velocity += dv.segment<3>(3).norm();
    velocity_ += dv.tail(robot_.num_joints()).cwiseAbs();
    const auto require = [&](double sum, const char* unit, const std::string& what) {
      log->RequireAtMost(ViolationKind::kVelocityContinuity, at, sum, 0, kContinuity, unit,
                         Jumps(what));
    };
    require(root_.angular_velocity, "rad/s", "root angular velocity");
    require(root_.velocity, "m/s", "root velocity");
    for (int j = 0; j < robot_.num_joints(); ++j) {
      require(velocity_[j], "rad/s", robot_.joints[j].name + " speed");
    }
  }

 private:
  struct Root {
    double turned = 0;            // rad
    double moved = 0;             // m
    double angular_velocity = 0;  // rad/s
    double velocity = 0;          // m/s
  };

  const models::RobotModel& robot_;
  Root root_;
  VectorXd position_;  // by joint, rad or m
  VectorXd velocity_;  // likewise, rad/s or m/s
};

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
    log->Report(
        ViolationKind::kFileMismatch, {},
        fmt::format("robot is {}, the scenario's is {}", robot.content_hash, scenario.robot_hash));
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
  Jumped jumped(robot);
  const Knot* before = nullptr;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (const Phase& phase : plan.segments[s].phases) {
      const Knot& after = phase.knots.front();
      if (before != nullptr) {
        const Instant at{static_cast<int>(s), after.t};
        jumped.AddPosition(*before, after, at, log);
        if (phase.impulses.cols() == 0) jumped.AddVelocity(*before, after, at, log);
      }
      before = &phase.knots.back();
    }
  }
}

}  // namespace possibility::actions
