#include "actions/crossing/step_over.h"

#include <fmt/format.h>

#include <memory>

#include "actions/conditions/fixed_manoeuvre.h"
#include "actions/crossing/step_over_motion.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

int GaitOnTwoFeet(const LocomotionModel& model) {
  for (std::size_t i = 0; i < model.gaits.size(); ++i) {
    if (model.gaits[i]->gait.limbs.size() == 2) return static_cast<int>(i);
  }
  throw InputError(fmt::format("{}: '{}' needs a gait on two feet among the actions",
                               model.robot->file.string(), kStepOver));
}

std::shared_ptr<Manoeuvre> MakeStepOver(const PlanningContext& context) {
  const int gait = GaitOnTwoFeet(*context.model);
  const auto problem =
      std::make_shared<StepOverProblem>(*context.model->robot, *context.model->gaits[gait]);
  FixedManoeuvreShape shape;
  shape.name = kStepOver;
  shape.from = shape.to = gait;
  shape.displacement = problem->displacement();
  shape.is_reversible = true;
  shape.duration = problem->schedule().duration();
  shape.flight = FlightBounds{};  // a foot bears at all times
  const Beam& beam = problem->beam();
  shape.over = CrossedSpace{beam.begin, beam.end, beam.height};
  const std::filesystem::path library =
      context.solved_motions ? context.library : std::filesystem::path();
  return std::make_shared<FixedManoeuvre>(
      context, shape, [problem, library](double, const CancellationToken& cancellation) {
        return StepOverMotion(*problem, library, cancellation).phases();
      });
}

}  // namespace

ManoeuvreFactory StepOverFactory() { return {kStepOver, MakeStepOver}; }

}  // namespace possibility::actions
