#include "actions/jump/jump_problem.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/sagittal/motion_identity.h"
#include "collocation/problem/function.h"
#include "collocation/robot/balance_functions.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/point_functions.h"
#include "models/input/file_contents.h"
#include "models/robot/rotors.h"

namespace possibility::actions {
namespace {

using collocation::At;
using collocation::Bounds;
using collocation::Differentiated;
using collocation::kInfinity;
using collocation::PointVelocities;
using collocation::Variable;
using collocation::VariableAt;

constexpr Bounds kZero = {0, 0};

// Multiples of NaturalUnits.
constexpr double kImpulse = 0.1;  // typical
constexpr Bounds kImpulseAlong = {-1.8, 1.8};
constexpr Bounds kImpulseUp = {0, 2.7};
constexpr double kShortest = 0.1;  // of phases whose durations the motion decides
constexpr double kHalfFlight = 0.65;

}  // namespace

JumpSettings JumpSettings::For(const models::RobotModel& robot, const NominalStance& launch,
                               const NominalStance& landing) {
  // With 90 %, motors a tenth weaker and a body 5 % heavier let jumps fall.
  constexpr double kTorqueFraction = 0.85;
  // On ground that rises along the jump it lands early, and needs torque to stop tilting back.
  constexpr double kSettlingTorque = 0.75;
  constexpr double kTimeWeight = 0.05;  // 1/s; from 0.2 on the whole robot cannot follow
  JumpSettings settings;
  if (models::HasRotors(robot)) {
    settings.limits.torque_fraction = kTorqueFraction;
    settings.settling_torque = kSettlingTorque;
  }
  if (landing.gait->limbs.size() == launch.gait->limbs.size()) settings.time_weight = kTimeWeight;
  return settings;
}

std::string JumpIdentity(const models::RobotModel& robot, const JumpSettings& settings,
                         const std::string& from, const std::string& to) {
  std::vector<double> own = {settings.min_stance_pitch,  settings.max_stance_pitch,
                             settings.max_contact_speed, settings.leg_reach,
                             settings.longest_toe_push,  settings.settling.heel,
                             settings.settling.toe,      settings.time_weight};
  // Libraries of robots without rotors are older than this setting.
  if (settings.settling_torque < 1) own.push_back(settings.settling_torque);
  return models::HashOfParts({from, to, MotionIdentity(robot, settings, own)});
}

JumpProblem::JumpProblem(const SagittalModel& model, const JumpTask& task,
                         const JumpSettings& settings)
    : SagittalProblem(fmt::format("jump of {:.3f} m by {:.3f} m", task.distance, task.height),
                      model, task.distance, task.height, settings) {
  AddPhases(settings);
  Push(settings);
  Fly(settings);
  Land(settings);
  for (int phase = 0; phase < kNumPhases; ++phase) {
    const At at = phase == kCrouch ? At::kAfterStart : At::kEverywhere;
    KeepBodyAbove(phase, at);
    StayWithinRanges(phase, at);
  }
  AddCosts();
  if (settings.time_weight > 0) {
    for (const collocation::RobotPhase& phase : phases_) {
      problem_.AddCost({phase.phase->duration(), At::kStart}, settings.time_weight);
    }
  }
  GuessMotion();
}

void JumpProblem::AddPhases(const JumpSettings& settings) {
  AddPhase("crouch", Feet(), Times({1.2, 3.9}));
  AddPhase("toes", {model_.toe()}, Times({kShortest, settings.longest_toe_push}));
  AddPhase("rise", {}, Times({kShortest, kLongestHalfFlight}));
  AddPhase("descent", {}, Times({kShortest, kLongestHalfFlight}));
  AddPhase("settle", Feet(), Times({kShortest, 4.6}), settings.settling_torque);
  AddPhase("landing", FeetAndHands(), Times({1.2, 5.8}));
  for (int phase = 1; phase < kNumPhases; ++phase) {
    collocation::ContinueRobot(&problem_, phases_[phase - 1], phases_[phase], phase != kSettle);
  }
}

void JumpProblem::Push(const JumpSettings& settings) {
  StartAtRest(kCrouch);
  HoldSoles(kCrouch, At::kAfterStart);
  HoldPoints(kToes, {kZero, kZero}, At::kAfterStart);
  StartHeld(kToes, {kZero, kZero});
  KeepAbove(kToes, "heels", {model_.heel()}, 0, At::kAfterStart);
  for (const int phase : {kCrouch, kToes}) {
    phases_[phase].phase->Bound(phases_[phase].q[0],
                                {settings.min_stance_pitch, settings.max_stance_pitch});
    KeepAbove(phase, "hands", model_.hands(), settings.hand_clearance,
              phase == kCrouch ? At::kAfterStart : At::kEverywhere);
  }
}

void JumpProblem::Fly(const JumpSettings& settings) {
  problem_.Link("halves of the flight",
                Differentiated<2, 1>([](const auto& t, auto* y) { (*y)[0] = t[0] - t[1]; }),
                {{phases_[kRise].phase->duration(), At::kStart},
                 {phases_[kDescent].phase->duration(), At::kStart}},
                {kZero});
  KeepAbove(kRise, "feet", Feet(), 0, At::kAfterStart);
  KeepAbove(kRise, "hands", model_.hands(), settings.hand_clearance, At::kEverywhere);
  KeepAbove(kDescent, "feet", Feet(), 0, At::kInside);
  KeepHandsAbove(kDescent, settings.hand_approach, At::kInside);
}

void JumpProblem::Land(const JumpSettings& settings) {
  const collocation::RobotPhase& descent = phases_[kDescent];
  const double speed = settings.max_contact_speed * model_.units().speed();
  descent.phase->Constrain("touchdown speed", PointVelocities(model_.planar(), Feet()),
                           descent.State(), {{-speed, speed}}, At::kEnd);
  StartPlaced(kSettle, 0);
  AddImpact();
  KeepBent(kSettle, "leg", model_.leg(), settings.leg_reach, At::kStart);
  StartHeld(kSettle, HeldSoles());
  HoldSoles(kSettle, At::kEverywhere, settings.settling);
  KeepHandsAbove(kSettle, settings.hand_approach, At::kBeforeEnd);
  // The feet stay in place; the hands, if it lands on them, are set down at zero speed.
  if (!model_.hands().empty()) StartPlaced(kLanding, 2);
  StartHeld(kLanding, HeldSolesAnd(model_.hands().size()));
  HoldFeetAndHands(kLanding, At::kBeforeEnd);
  EndAtRest(kLanding);
}

void JumpProblem::AddImpact() {
  const collocation::RobotPhase& before = phases_[kDescent];
  const collocation::RobotPhase& after = phases_[kSettle];
  const double friction = settings_.limits.friction * settings_.limits.friction_fraction;
  const double unit = model_.units().impulse();
  const double typical = kImpulse * unit;
  std::vector<VariableAt> impact;
  for (const Variable& q : after.q) impact.push_back({q, At::kStart});
  for (const Variable& v : before.v) impact.push_back({v, At::kEnd});
  for (const Variable& v : after.v) impact.push_back({v, At::kStart});
  for (std::size_t i = 0; i < after.points.size(); ++i) {
    const std::string name = fmt::format("impulse {}", i);
    const auto bounds = [unit](const Bounds& share) {
      return Bounds{share.lower * unit, share.upper * unit};
    };
    const Variable x = problem_.AddParameter(name + " x", bounds(kImpulseAlong), typical);
    const Variable z = problem_.AddParameter(name + " z", bounds(kImpulseUp), typical, typical);
    problem_.Link(name + " cone", Differentiated<2, 2>([friction, typical](const auto& f, auto* g) {
                    (*g)[0] = (friction * f[1] + f[0]) / typical;
                    (*g)[1] = (friction * f[1] - f[0]) / typical;
                  }),
                  {{x, At::kStart}, {z, At::kStart}}, {{0, kInfinity}});
    // The distribution of impulses along a sole is not unique; the least impulses are chosen.
    problem_.AddCost(name, Differentiated<2, 1>([unit](const auto& f, auto* y) {
                       (*y)[0] = (f[0] * f[0] + f[1] * f[1]) / (unit * unit);
                     }),
                     {{x, At::kStart}, {z, At::kStart}});
    for (const Variable& impulse : {x, z}) {
      impulses_.push_back(impulse);
      impact.push_back({impulse, At::kStart});
    }
  }
  problem_.Link("impact", collocation::ImpactMap(model_.planar(), after.points), impact, {kZero});
}

void JumpProblem::GuessMotion() {
  // Straight lines from stance to stance, with most of the distance in the air; there, the root
  // moves along a parabola.
  GuessLine(kCrouch, 3, 0, 0);
  GuessLine(kToes, 0.5, 0, 0.1);
  GuessLine(kRise, kHalfFlight, 0.1, 0.5);
  GuessLine(kDescent, kHalfFlight, 0.5, 0.8);
  GuessLine(kSettle, 1.2, 0.8, 1);
  GuessLine(kLanding, 2.3, 1, 1);
  const double apex = model_.units().length * kHalfFlight * kHalfFlight / 2;
  GuessHeight(kRise, 0.1, 0.5, [apex](double s) { return apex * (1 - (1 - s) * (1 - s)); });
  GuessHeight(kDescent, 0.5, 0.8, [apex](double s) { return apex * (1 - s * s); });
}

void JumpProblem::GuessHeight(int phase, double from, double to,
                              const std::function<double(double)>& above) {
  const double begin = model_.ready()[2];
  const double change = model_.landed()[2] + height_ - begin;
  phases_[phase].phase->Guess(phases_[phase].q[2], [=](double s) {
    return begin + (from + s * (to - from)) * change + above(s);
  });
}

Eigen::Matrix2Xd JumpProblem::Impulses(const collocation::Trajectory& trajectory) const {
  Eigen::Matrix2Xd impulses(2, phases_[kSettle].points.size());
  for (std::size_t i = 0; i < impulses_.size(); ++i) {
    impulses(static_cast<int>(i % 2), static_cast<int>(i / 2)) =
        trajectory.parameters[impulses_[i].index];
  }
  return impulses;
}

}  // namespace possibility::actions
