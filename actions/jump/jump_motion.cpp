#include "actions/jump/jump_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "actions/motion/free_flight.h"
#include "actions/motion/phase_sequence.h"
#include "actions/motion/toe_roll.h"
#include "actions/wholebody/motion_error.h"
#include "dynamics/contact/contact_feasibility.h"
#include "dynamics/forward/forward_dynamics.h"

namespace possibility::actions {
namespace {

using collocation::PhaseTrajectory;
using Eigen::VectorXd;

// Knot spacing where dynamics alone determines the motion, between the knots as well, s.
constexpr double kRollSpacing = 0.0025;
constexpr double kFlightSpacing = 0.005;

/// Passes of the landing's correction: at first with few knots.
struct Correction {
  double spacing;  ///< s, of the knots
  double error;    ///< rad, that is left
};
constexpr std::array<Correction, 2> kCorrections = {
    {{4 * kFlightSpacing, 1e-6}, {kFlightSpacing, 1e-10}}};

/// Rise and descent agree at the apex in position and speed only. A quintic blends them over this
/// time before and after it, s, because interpolation between knots cannot follow a jump in
/// acceleration.
constexpr double kApexBlend = 0.02;

int Intervals(double duration, double spacing) {
  return std::max(4, static_cast<int>(std::ceil(duration / spacing - 1e-9)));
}

/// Finds x at which change(x) = 0 (Broyden 1965, his first method), from a guess at which a step by
/// `change` is reasonable. What it has learnt of the Jacobian serves the next, similar function.
class FixedPoint {
 public:
  explicit FixedPoint(Eigen::Index n) : inverse_(Eigen::MatrixXd::Identity(n, n)) {}

  /// @throws MotionError if there is none nearby.
  VectorXd Solve(const std::function<VectorXd(const VectorXd&)>& change, VectorXd x,
                 double tolerance) {
    constexpr int kMostRounds = 40;
    VectorXd value = change(x);
    for (int round = 0; round < kMostRounds; ++round) {
      if (value.lpNorm<Eigen::Infinity>() < tolerance) return x;
      const VectorXd step = inverse_ * value;
      x += step;
      const VectorXd next = change(x);
      // With J the negative Jacobian of `change`: J step = value - next.
      const VectorXd mapped = inverse_ * (value - next);
      const double scale = step.dot(mapped);
      if (scale == 0) break;
      inverse_ += (step - mapped) * (step.transpose() * inverse_) / scale;
      value = next;
    }
    throw MotionError("the landing cannot be corrected in flight");
  }

 private:
  Eigen::MatrixXd inverse_;
};

}  // namespace

JumpMotion::JumpMotion(const models::RobotModel& robot, const SagittalModel& model,
                       const NominalStance& launch, const NominalStance& landing)
    : stance_(robot, model, launch, landing), spatial_(dynamics::MultibodyModel::Spatial(robot)) {}

// If joints turned while the robot crouches, the simulation would follow 35 jumps instead of 37.
std::optional<Phase> JumpMotion::Prepare() const {
  if (!stance_.NeedsPreparation()) return std::nullopt;
  return stance_.Prepare();
}

std::vector<Phase> JumpMotion::Realise(const JumpProblem& problem,
                                       const collocation::Trajectory& trajectory,
                                       const std::optional<Phase>& preparation,
                                       JumpMotionReport* report) {
  JumpMotionReport unused;
  if (!report) report = &unused;
  const auto& plans = trajectory.phases;
  const JumpTask& task = problem.task();
  const Support feet = stance_.LandingFeet(task.distance, task.height);
  const Support all = stance_.LandingAll(task.distance, task.height);
  std::vector<Phase> motion;
  const auto last = [&motion]() -> const Knot& { return motion.back().knots.back(); };
  if (preparation) Append(*preparation, &motion);
  const PhaseTrajectory& crouch = plans[JumpProblem::kCrouch];
  Append(stance_.Follow(crouch, stance_.PlannedKnot(crouch, 0), stance_.LaunchFeet()), &motion);
  Append(RollOverToes(plans[JumpProblem::kToes], last()), &motion);
  Append(Fly(plans[JumpProblem::kRise], plans[JumpProblem::kDescent], last(), feet, report),
         &motion);
  RequireLimits(motion.back(), problem.settings().limits.max_base_speed);
  Eigen::Matrix3Xd impulses;
  const Knot after = AfterImpact(last(), feet, &impulses, report);
  Append(stance_.FollowUntilPlaced(plans[JumpProblem::kSettle], after, feet, all), &motion);
  motion.back().impulses = impulses;
  Append(stance_.Follow(plans[JumpProblem::kLanding], last(), all), &motion);
  return motion;
}

Phase JumpMotion::RollOverToes(const PhaseTrajectory& plan, const Knot& from) const {
  const int n = stance_.robot().num_joints();
  const double duration = plan.duration;
  const Signal<VectorXd> planned = stance_.Joints(plan, 0);
  // Inverse kinematics has placed the legs; the plan's joints differ by the mesh error.
  const VectorXd offset = from.q.tail(n) - planned.value;
  const VectorXd drift = from.v.tail(n) - planned.rate;
  const JointMotion joints = [&](double t) {
    return stance_.Joints(plan, t) + DyingOut(offset, drift, t, duration);
  };
  const Support toes = stance_.Toes();
  Phase phase;
  phase.contacts = toes.names;
  phase.knots = ToeRoll(spatial_, toes.points, stance_.settings())
                    .Roll(from.q, from.v, joints, duration, Intervals(duration, kRollSpacing));
  return phase;
}

Phase JumpMotion::Fly(const PhaseTrajectory& rise, const PhaseTrajectory& descent, const Knot& from,
                      const Support& feet, JumpMotionReport* report) {
  const int n = stance_.robot().num_joints();
  const double duration = rise.duration + descent.duration;
  const double blend = std::min({kApexBlend, rise.duration / 2, descent.duration / 2});
  const Signal<VectorXd> before = stance_.Joints(rise, rise.duration - blend);
  const Signal<VectorXd> after = stance_.Joints(descent, blend);
  const auto plan = [&](double t) {
    const double past_apex = t - rise.duration;
    if (past_apex < -blend) return stance_.Joints(rise, t);
    if (past_apex > blend) return stance_.Joints(descent, past_apex);
    return Quintic(before, after, past_apex + blend, 2 * blend);
  };
  FreeFlight flight(spatial_);
  flight.TakeOff(from.q, from.v);
  FixedPoint fixed_point(n);
  VectorXd correction = VectorXd::Zero(n);
  Phase phase;
  for (const auto& [spacing, error] : kCorrections) {
    const int intervals = Intervals(duration, spacing);
    // Every correction needs the plan at the same times: those of Runge and Kutta's method.
    const double half_step = duration / intervals / 2;
    std::vector<Signal<VectorXd>> planned;
    for (int i = 0; i <= 2 * intervals; ++i) planned.push_back(plan(i * half_step));
    const JointMotion joints = [&](double t) {
      const auto i = static_cast<std::size_t>(std::lround(t / half_step));
      return planned[i] +
             BlendVector<VectorXd>(VectorXd::Zero(n), correction, RestToRest(t, duration));
    };
    const auto change = [&](const VectorXd& tried) -> VectorXd {
      correction = tried;
      const Knot landing = flight.Land(joints, duration, intervals);
      return (stance_.StateAt(landing, feet).q - landing.q).tail(n);
    };
    correction = fixed_point.Solve(change, correction, error);
    if (spacing == kFlightSpacing) phase.knots = flight.Fly(joints, duration, intervals);
  }
  report->landing_correction = correction.lpNorm<Eigen::Infinity>();
  return phase;
}

void JumpMotion::RequireLimits(const Phase& flight, double max_base_speed) const {
  const models::RobotModel& robot = stance_.robot();
  const MotionSettings& settings = stance_.settings();
  for (const Knot& knot : flight.knots) {
    RequireJointLimits(robot, knot.q, knot.v, settings.speed_margin, knot.t);
    const double base_speed = knot.v.segment<3>(3).norm();
    if (base_speed > settings.speed_margin * max_base_speed) {
      throw MotionError(
          fmt::format("the root flies at {:.1f} m/s at {:.2f} s of the flight, faster "
                      "than {:.1f}",
                      base_speed, knot.t, settings.speed_margin * max_base_speed));
    }
    for (int j = 0; j < robot.num_joints(); ++j) {
      const models::Joint& joint = robot.joints[j];
      const double limit =
          settings.torque_margin * joint.actuator.Limit(joint.effort, knot.tau[j], knot.v[6 + j]);
      if (std::abs(knot.tau[j]) > limit) {
        throw MotionError(fmt::format("{} needs {:.1f} at {:.2f} s of the flight, more than {:.1f}",
                                      joint.name, knot.tau[j], knot.t, limit));
      }
    }
  }
}

Knot JumpMotion::AfterImpact(const Knot& touchdown, const Support& support,
                             Eigen::Matrix3Xd* impulses, JumpMotionReport* report) const {
  dynamics::ForwardDynamics dynamics(spatial_);
  dynamics.SetState(touchdown.q, touchdown.v);
  const dynamics::Impact impact = dynamics.Hit(support.points);
  const dynamics::ImpulseFeasibility feasibility =
      dynamics::CheckImpact(&dynamics, impact, support.points, stance_.robot().friction);
  report->impact_friction = std::max(report->impact_friction, feasibility.friction_fraction);
  report->energy_lost += impact.energy_lost;
  if (!feasibility.feasible) {
    throw MotionError(fmt::format("the impact of {} needs {:.2f} of the friction there is",
                                  fmt::join(support.names, ", "), feasibility.friction_fraction));
  }
  *impulses = feasibility.impulses;
  Knot after = touchdown;
  after.v = impact.velocity;
  return after;
}

}  // namespace possibility::actions
