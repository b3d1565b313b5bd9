#include "actions/transition/sit_down_problem.h"

#include "actions/sagittal/motion_identity.h"

namespace possibility::actions {

using collocation::At;

namespace {

/// Of the problem's equations; stored solutions of another version are stale.
constexpr double kVersion = 2;

}  // namespace

double SitDownProblem::Displacement(const SagittalModel& model) {
  return model.Position(model.heel(), model.ready()).x() -
         model.Position(model.heel(), model.landed()).x();
}

std::string SitDownIdentity(const models::RobotModel& robot, const SitDownSettings& settings) {
  return MotionIdentity(
      robot, settings,
      {kVersion, settings.sit.lower, settings.sit.upper, settings.bear.lower, settings.bear.upper});
}

SitDownProblem::SitDownProblem(const SagittalModel& model, const SitDownSettings& settings)
    : SagittalProblem("sit down", model, Displacement(model), 0, settings) {
  AddPhase("sit", Feet(), Times(settings.sit));
  AddPhase("bear", FeetAndHands(), Times(settings.bear));
  collocation::ContinueRobot(&problem_, phases_[kSit], phases_[kBear], true);
  ContinueAccelerations(kSit, kBear);
  StartAtRest(kSit);
  HoldSoles(kSit, At::kAfterStart);
  KeepHandsAbove(kSit, settings.hand_approach, At::kInside);
  StartPlaced(kBear, 2);
  StartHeld(kBear, HeldHands(model.hands().size()));  // the soles already are
  HoldFeetAndHands(kBear, At::kBeforeEnd);
  EndAtRest(kBear);
  for (int phase = 0; phase < kNumPhases; ++phase) {
    const At at = phase == kSit ? At::kAfterStart : At::kEverywhere;
    KeepBodyAbove(phase, at);
    StayWithinRanges(phase, at);
  }
  AddCosts();
  GuessLine(kSit, 4.6, 0, 0.8);
  GuessLine(kBear, 3.1, 0.8, 1);
}

}  // namespace possibility::actions
