#include "actions/spatial/spatial_problem.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "actions/wholebody/limb_bend.h"
#include "collocation/problem/function.h"
#include "collocation/robot/point_functions.h"
#include "dynamics/tree/base_joints.h"
#include "dynamics/tree/floating_motion.h"

namespace possibility::actions {
namespace {

using namespace collocation;  // reads like the mathematics
using dynamics::kNumBaseJoints;
using Eigen::VectorXd;
using models::ContactSchedule;

constexpr int kHeight = 2;  // indices into q
constexpr int kYaw = 3;
constexpr int kRoll = 4;
constexpr int kPitch = 5;

// Typical sizes in the cost.
constexpr double kTorque = 50;        // N m
constexpr double kAcceleration = 10;  // rad/s^2, m/s^2
constexpr double kForce = 400;        // N

/// How far the contacts have come, between 0 and 1, where an interval begins and ends: the mean of
/// their ways, each swing at constant speed.
class Progress {
 public:
  explicit Progress(const ContactSchedule& schedule) {
    const int contacts = static_cast<int>(schedule.contacts.size());
    at_.assign(schedule.intervals.size() + 1, 0);
    for (std::size_t k = 0; k < schedule.intervals.size(); ++k) {
      at_[k + 1] = at_[k];
      for (int contact = 0; contact < contacts; ++contact) {
        if (!schedule.intervals[k].bearing[contact]) at_[k + 1] += schedule.intervals[k].duration;
      }
    }
    // Without a swing, evenly.
    if (at_.back() == 0) {
      for (std::size_t k = 0; k < at_.size(); ++k) at_[k] = static_cast<double>(k);
    }
    for (double& progress : at_) progress /= at_.back();
  }

  double At(int interval, double share) const {
    return at_[interval] + share * (at_[interval + 1] - at_[interval]);
  }

 private:
  std::vector<double> at_;
};

class Builder {
 public:
  Builder(const models::RobotModel& robot, const models::Gait& limbs,
          const ContactSchedule& schedule, const VectorXd& from, const VectorXd& to,
          const SpatialSettings& settings)
      : robot_(robot),
        limbs_(limbs),
        schedule_(schedule),
        settings_(settings),
        progress_(schedule) {
    for (const models::GaitLimb& limb : limbs.limbs) {
      if (const auto bend = BendOf(robot, limb)) bends_.push_back(*bend);
    }
    stated_.problem = std::make_unique<OptimalControlProblem>("motion in space");
    stated_.model = dynamics::MultibodyModel::OnJoints(robot, settings.locked);
    from_ = dynamics::FromFloating(*stated_.model, from);
    to_ = dynamics::FromFloating(*stated_.model, to);
    // The shorter way round.
    to_[kYaw] += 2 * M_PI * std::round((from_[kYaw] - to_[kYaw]) / (2 * M_PI));
  }

  SpatialProblem Build() {
    stated_.phases =
        AddContactSequence(stated_.problem.get(), stated_.model, schedule_, settings_.sequence);
    for (std::size_t k = 0; k < stated_.phases.size(); ++k) {
      BoundTrunk(stated_.phases[k]);
      KeepBent(stated_.phases[k]);
      AddCosts(static_cast<int>(k));
      GuessLine(static_cast<int>(k));
    }
    if (settings_.beam) {
      KeepOffBeam(*settings_.beam, settings_.beam_clearance, robot_, limbs_, schedule_,
                  stated_.model, stated_.phases);
    }
    Rest(stated_.phases.front(), from_, At::kStart);
    Rest(stated_.phases.back(), to_, At::kEnd);
    return std::move(stated_);
  }

 private:
  static void Rest(const RobotPhase& robot, const VectorXd& q, At at) {
    for (std::size_t i = 0; i < robot.q.size(); ++i) {
      robot.phase->Fix(robot.q[i], q[static_cast<Eigen::Index>(i)], at);
      robot.phase->Fix(robot.v[i], 0, at);
      robot.phase->Fix(robot.a[i], 0, at);
    }
  }

  void BoundTrunk(const RobotPhase& robot) const {
    const auto around = [this](int i, double margin) {
      return Bounds{std::min(from_[i], to_[i]) - margin, std::max(from_[i], to_[i]) + margin};
    };
    robot.phase->Bound(robot.q[kRoll], around(kRoll, settings_.tilt));
    robot.phase->Bound(robot.q[kPitch], around(kPitch, settings_.tilt));
    robot.phase->Bound(robot.q[kYaw], around(kYaw, settings_.turn));
    robot.phase->Bound(robot.q[kHeight],
                       {-kInfinity, std::max(from_[kHeight], to_[kHeight]) + settings_.rise});
  }

  /// Away from the rests, which are as they are.
  void KeepBent(const RobotPhase& robot) {
    for (const LimbBend& bend : bends_) {
      const auto point = [](int link, const Eigen::Vector3d& at) {
        return dynamics::ContactPoint{link + kNumBaseJoints, at};
      };
      const double most = settings_.reach * bend.length;
      robot.phase->ConstrainKnots(
          "reach of " + bend.name,
          SquaredDistance(stated_.model, point(bend.before, Eigen::Vector3d::Zero()),
                          point(bend.after, bend.end)),
          robot.Positions(), {{-kInfinity, most * most}}, At::kInside);
    }
  }

  void AddCosts(int k) {
    const RobotPhase& robot = stated_.phases[k];
    AddSquareCost("torque", robot.torques, kTorque, settings_.torque_weight, robot.phase);
    AddSquareCost("acceleration", robot.a, kAcceleration, settings_.acceleration_weight,
                  robot.phase);
    AddSquareCost("force", robot.f, kForce, settings_.force_weight, robot.phase);
    for (int i = kNumBaseJoints; i < stated_.model->nv(); ++i) {
      const double begin = Line(k, 0)[i];
      const double change = Line(k, 1)[i] - begin;
      robot.phase->AddIntegralCost("posture", FunctionOf([begin, change](auto q, auto share) {
                                     const auto off = q - begin - change * share;
                                     return off * off;
                                   }),
                                   {robot.q[i], robot.phase->share()}, settings_.posture_weight);
    }
    if (settings_.time_weight > 0) {
      stated_.problem->AddCost({robot.phase->duration(), At::kEnd}, settings_.time_weight);
    }
  }

  VectorXd Line(int k, double share) const {
    return from_ + progress_.At(k, share) * (to_ - from_);
  }

  void GuessLine(int k) {
    const RobotPhase& robot = stated_.phases[k];
    const VectorXd begin = Line(k, 0);
    const VectorXd change = Line(k, 1) - begin;
    for (int i = 0; i < stated_.model->nv(); ++i) {
      robot.phase->Guess(robot.q[i], [start = begin[i], change = change[i]](double s) {
        return start + s * change;
      });
      robot.phase->Guess(robot.v[i], change[i] / schedule_.intervals[k].duration);
    }
  }

  const models::RobotModel& robot_;
  const models::Gait& limbs_;
  const ContactSchedule& schedule_;
  const SpatialSettings& settings_;
  Progress progress_;
  std::vector<LimbBend> bends_;
  SpatialProblem stated_;
  VectorXd from_, to_;
};

}  // namespace

SpatialProblem StateSpatialProblem(const models::RobotModel& robot, const models::Gait& limbs,
                                   const models::ContactSchedule& schedule, const VectorXd& from,
                                   const VectorXd& to, const SpatialSettings& settings) {
  return Builder(robot, limbs, schedule, from, to, settings).Build();
}

}  // namespace possibility::actions
