#include "experiments/examples/step_up.h"

#include <memory>

#include "actions/conditions/fixed_manoeuvre.h"
#include "actions/gait/stepped_motion.h"
#include "common/cancellation_token.h"

namespace possibility::actions {
namespace {

/// Walked before the step, because the stance keeps farther from the edge; step of each foot, m.
constexpr double kApproach = 0.24, kStep = 0.26;
constexpr int kFirst = 0, kSecond = 1;

// Postures for DRC-HUBO1, found in 800 random trials. They work within 0.85 of its torque limits
// and 0.95 of its friction for all tested rises up to 0.15 m.
constexpr BodyShift kFirstFootUp{.over = kSecond, .lift = 0.114, .lean = -0.138, .ahead = 0.054};
constexpr BodyShift kSecondFootLeaves{
    .over = kFirst, .lift = -0.041, .lean = 0.236, .ahead = 0.014};
constexpr BodyShift kSecondFootUp{.over = kFirst, .lift = 0.004, .lean = 0.177, .ahead = -0.003};

SteppedMotion StepOnto(const LocomotionModel& model, double rise) {
  SteppedMotion step(*model.robot, model.gaits[model.GaitIndex("walk")]->stance, 1.4);
  step.Walk(kApproach)
      .Shift(kFirstFootUp, 1.2)
      .Swing(kFirst, {.ahead = kStep, .rise = rise}, kFirstFootUp)
      .Shift(kSecondFootLeaves, 1.2)
      .Swing(kSecond, {.ahead = kStep, .rise = rise}, kSecondFootUp)
      .Rest(1.2);
  return step;
}

}  // namespace

ManoeuvreFactory StepUpFactory() {
  return {"step_up", [](const PlanningContext& context) {
            const LocomotionModel& model = *context.model;
            FixedManoeuvreShape shape;
            shape.name = "step_up";
            shape.from = shape.to = model.GaitIndex("walk");
            shape.displacement.x = kApproach + kStep;
            shape.lowest = 0.01;
            shape.highest = 0.15;
            shape.is_reversible = true;
            shape.duration = StepOnto(model, 0).duration();
            shape.flight = FlightBounds{};  // a foot bears at all times
            return std::make_shared<FixedManoeuvre>(
                context, shape, [&model](double rise, const CancellationToken& cancellation) {
                  return StepOnto(model, rise).Build(cancellation);
                });
          }};
}

}  // namespace possibility::actions
