#include "actions/wholebody/motion_builder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>

#include "actions/plan/interpolation.h"
#include "actions/wholebody/force_fault.h"
#include "actions/wholebody/forces_between.h"
#include "actions/wholebody/motion_error.h"
#include "models/robot/mimic_joints.h"

namespace possibility::actions {
namespace {

/// Share of the forces (contact_forces.h) of a patch that is about to lift, or has just come down.
constexpr double kLeastShare = 0.05;

/// On slopes much of the friction bears the weight, and on slippery ground there is little: of a
/// cone with 8 edges 8 % would be missing.
constexpr int kManyEdges = 16;

bool Contains(const MotionPhase* phase, int contact) {
  return phase == nullptr || std::find(phase->contacts.begin(), phase->contacts.end(), contact) !=
                                 phase->contacts.end();
}

/// " of phase 3, in which right_sole swings".
std::string PhaseText(const models::RobotModel& robot, const MotionPhase& phase,
                      const MotionPhase* before, const MotionPhase* after, std::size_t index) {
  std::set<std::string> swinging;
  for (const MotionPhase* neighbour : {before, after}) {
    if (neighbour == nullptr) continue;
    for (const int contact : neighbour->contacts) {
      if (!Contains(&phase, contact)) swinging.insert(robot.contacts[contact].name);
    }
  }
  std::string text = fmt::format(" of phase {}", index);
  if (swinging.empty()) return text;
  return fmt::format("{}, in which {} swing{}", text, fmt::join(swinging, " and "),
                     swinging.size() == 1 ? "s" : "");
}

}  // namespace

/// The points that bear in a phase, and how their loads change.
struct MotionBuilder::Bearing {
  std::vector<dynamics::ContactPoint> points;
  std::vector<bool> comes_down;  ///< by point: did not bear in the phase before
  std::vector<bool> lifts;       ///< by point: will not bear in the phase after

  bool IsTilted() const {
    return std::any_of(points.begin(), points.end(), [](const dynamics::ContactPoint& point) {
      return point.normal_W != Eigen::Vector3d::UnitZ();
    });
  }

  bool IsSlippery(double robots_friction) const {
    return std::any_of(points.begin(), points.end(), [&](const dynamics::ContactPoint& point) {
      return point.friction < robots_friction;
    });
  }

  /// `s`: part of the phase that has passed.
  std::vector<double> Shares(double s) const {
    const double passed = std::clamp(RestToRest(s, 1).value, 0.0, 1.0);
    std::vector<double> shares;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double share = 1;
      if (comes_down[i]) share = passed;
      if (lifts[i]) share *= 1 - passed;
      shares.push_back(std::max(share, kLeastShare));
    }
    return shares;
  }
};

int NumIntervals(double duration, double spacing, int least) {
  constexpr double kRounding = 1e-9;
  return std::max(least, static_cast<int>(std::ceil(duration / spacing - kRounding)));
}

std::shared_ptr<const dynamics::MultibodyModel> UncoupledModel(models::RobotModel robot) {
  for (models::Joint& joint : robot.joints) joint.mimic.reset();
  return dynamics::MultibodyModel::Spatial(robot);
}

/// How often an interval is halved where forces fail between knots.
constexpr int kMostHalvings = 2;

/// Between two knots the motion is looked at in so many places, as closely as by the verifier.
constexpr int kPlacesBetween = 4;

void RequireRange(const models::Joint& joint, double position, double t) {
  if (position >= joint.lower && position <= joint.upper) return;
  throw MotionError(fmt::format("{} at {:.4f} leaves its limits {:.4f} to {:.4f} at {:.2f} s",
                                joint.name, position, joint.lower, joint.upper, t),
                    -1, MotionError::Limit::kJointRange);
}

/// Between two knots, which are within the limits. `t`: s, of the first one in its phase.
void RequireRangesBetween(const models::RobotModel& robot, const Knot& from, const Knot& to,
                          double t) {
  const KnotInterpolant motion(from, to);
  const KnotInterpolant::Coefficients bounds = motion.ControlPoints();
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const auto row = bounds.row(6 + j);
    if (row.minCoeff() >= joint.lower && row.maxCoeff() <= joint.upper) continue;
    for (int i = 1; i < kPlacesBetween; ++i) {
      const double passed = motion.duration() * i / kPlacesBetween;
      RequireRange(joint, motion.ConfigurationAt(from.t + passed)[7 + j], t + passed);
    }
  }
}

void RequireJointLimits(const models::RobotModel& robot, const Eigen::VectorXd& q,
                        const Eigen::VectorXd& v, double speed_margin, double t) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    RequireRange(joint, q[7 + j], t);
    const double rate = v[6 + j];
    if (std::abs(rate) > speed_margin * joint.velocity) {
      throw MotionError(fmt::format("{} at {:.3f}/s is faster than {:.3f}/s at {:.2f} s",
                                    joint.name, rate, speed_margin * joint.velocity, t));
    }
  }
}

MotionBuilder::MotionBuilder(const models::RobotModel& robot, const MotionSettings& settings)
    : robot_(&robot), settings_(settings), solver_(robot), dynamics_(UncoupledModel(robot)) {}

std::vector<Phase> MotionBuilder::Build(const std::vector<MotionPhase>& phases,
                                        const Eigen::VectorXd& guess,
                                        const CancellationToken& cancellation) {
  std::vector<Phase> result;
  Eigen::VectorXd q = guess;
  double start = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    cancellation.ThrowIfCancelled();
    const MotionPhase* before = i > 0 ? &phases[i - 1] : nullptr;
    const MotionPhase* after = i + 1 < phases.size() ? &phases[i + 1] : nullptr;
    try {
      result.push_back(BuildPhase(phases[i], before, after, start, &q));
    } catch (const MotionError& error) {
      throw MotionError(std::string(error.what()) + PhaseText(*robot_, phases[i], before, after, i),
                        static_cast<int>(i), error.limit(), error.share());
    }
    start += phases[i].duration;
  }
  return result;
}

Phase MotionBuilder::BuildPhase(const MotionPhase& phase, const MotionPhase* before,
                                const MotionPhase* after, double start, Eigen::VectorXd* guess) {
  Phase result;
  Bearing bearing;
  for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
    const int contact = phase.contacts[i];
    const models::ContactPatch& patch = robot_->contacts[contact];
    const Eigen::Vector3d normal =
        phase.normals.empty() ? Eigen::Vector3d(Eigen::Vector3d::UnitZ()) : phase.normals[i];
    const double friction = phase.friction.empty() ? robot_->friction : phase.friction[i];
    result.contacts.push_back(patch.name);
    for (const Eigen::Vector3d& p : patch.points) {
      bearing.points.push_back({patch.link, p, normal, friction});
      const auto& down = phase.coming_down;
      bearing.comes_down.push_back(!Contains(before, contact) ||
                                   std::find(down.begin(), down.end(), contact) != down.end());
      bearing.lifts.push_back(!Contains(after, contact));
    }
  }
  const int intervals =
      NumIntervals(phase.duration, settings_.knot_spacing, settings_.minimum_intervals);
  const double spacing = phase.duration / intervals;
  for (int i = 0; i <= intervals; ++i) {
    const double share = static_cast<double>(i) / intervals;
    Knot knot;
    try {
      knot = MakeKnot(phase, bearing, phase.duration * share, guess);
      knot.t += start;
      if (i < intervals) *guess = GuessAfter({knot.q, knot.v, knot.a}, spacing);
      Append(phase, bearing, start, std::move(knot), kMostHalvings, &result.knots);
    } catch (const MotionError& error) {
      throw MotionError(error.what(), -1, error.limit(), share);
    }
  }
  return result;
}

void MotionBuilder::Append(const MotionPhase& phase, const Bearing& bearing, double start,
                           Knot knot, int halvings, std::vector<Knot>* knots) {
  if (knots->empty()) return knots->push_back(std::move(knot));
  const double t = knots->back().t - start;
  RequireRangesBetween(*robot_, knots->back(), knot, t);
  if (settings_.tests_between_knots) {
    const std::optional<MotionError> fault =
        ForceFaultBetween(*robot_, bearing.points, knots->back(), knot, t, &dynamics_);
    if (fault && halvings == 0) throw *fault;
    if (fault) {
      Eigen::VectorXd guess = (knots->back().q + knot.q) / 2;
      Knot middle = MakeKnot(phase, bearing, (t + knot.t - start) / 2, &guess);
      middle.t += start;
      Append(phase, bearing, start, std::move(middle), halvings - 1, knots);
      return Append(phase, bearing, start, std::move(knot), halvings - 1, knots);
    }
  }
  knots->push_back(std::move(knot));
}

Knot MotionBuilder::MakeKnot(const MotionPhase& phase, const Bearing& bearing, double t,
                             Eigen::VectorXd* guess) {
  const WholeBodyState state = solver_.Solve(phase.task(t), *guess);
  *guess = state.q;
  RequireJointLimits(*robot_, state.q, state.v, settings_.speed_margin, t);
  dynamics::ContactForceSettings force_settings;
  force_settings.friction = robot_->friction;
  force_settings.friction_margin = settings_.friction_margin;
  force_settings.normal_reserve =
      settings_.normal_reserve * robot_->TotalMass() * dynamics::kGravity;
  force_settings.torque_margin = settings_.torque_margin;
  if (bearing.IsTilted() || bearing.IsSlippery(robot_->friction)) {
    force_settings.cone_edges = kManyEdges;
  }
  force_settings.shares = bearing.Shares(t / phase.duration);
  dynamics_.SetState(state.q, state.v, state.a);
  const std::optional<dynamics::ContactForces> forces =
      dynamics::DistributeContactForces(&dynamics_, bearing.points, force_settings);
  if (!forces) {
    const MotionError fault = ForceFault(&dynamics_, bearing.points, force_settings);
    throw MotionError(fmt::format("{} at {:.2f} s", fault.what(), t), -1, fault.limit());
  }
  CheckCoupledTorques(forces->torques, state.v, t);
  Knot knot;
  knot.t = t;
  knot.q = state.q;
  knot.v = state.v;
  knot.a = state.a;
  knot.tau = forces->torques;
  knot.forces = forces->forces;
  return knot;
}

void MotionBuilder::CheckCoupledTorques(const Eigen::VectorXd& torques, const Eigen::VectorXd& v,
                                        double t) const {
  const Eigen::VectorXd borne = models::MotorTorques(*robot_, torques);
  for (int j = 0; j < robot_->num_joints(); ++j) {
    const models::Joint& joint = robot_->joints[j];
    const double limit =
        settings_.torque_margin * joint.actuator.Limit(joint.effort, borne[j], v[6 + j]);
    if (joint.mimic || std::abs(borne[j]) <= limit) continue;
    throw MotionError(fmt::format("{} and its mimics need {:.1f}, more than {:.1f}, at {:.2f} s",
                                  joint.name, borne[j], limit, t));
  }
}

std::vector<Phase> Reversed(const models::RobotModel& robot, const std::vector<Phase>& phases) {
  std::vector<Phase> result(phases.rbegin(), phases.rend());
  if (result.empty()) return result;
  const double end = phases.back().knots.back().t;
  for (Phase& phase : result) {
    std::reverse(phase.knots.begin(), phase.knots.end());
    for (Knot& knot : phase.knots) {
      knot.t = end - knot.t;
      knot.v = -knot.v;
      // Friction alone does not run backwards.
      for (int j = 0; j < robot.num_joints(); ++j) {
        const models::Actuator& actuator = robot.joints[j].actuator;
        if (actuator.HasLosses()) knot.tau[j] += 2 * actuator.Friction(knot.v[6 + j]);
      }
    }
  }
  return result;
}

}  // namespace possibility::actions
