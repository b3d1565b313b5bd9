#include "actions/conditions/manoeuvre.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/motion_job.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

std::shared_ptr<const QuasiStaticAction> GaitOf(const PlanningContext& context,
                                                const std::string& name, int gait) {
  if (gait < 0 || gait >= static_cast<int>(context.gaits.size())) {
    throw InputError(
        fmt::format("{}: action '{}' starts from or ends in a gait that is not planned with",
                    context.model->robot->file.string(), name));
  }
  return context.gaits[static_cast<size_t>(gait)];
}

}  // namespace

Manoeuvre::Manoeuvre(const PlanningContext& context, std::string name, int from, int to)
    : name_(std::move(name)),
      from_(from),
      to_(to),
      model_(context.model),
      world_(context.world),
      launch_(GaitOf(context, name_, from)),
      landing_(GaitOf(context, name_, to)),
      checker_(std::make_shared<models::CollisionChecker>(*model_->robot, *world_.environment)) {}

bool Manoeuvre::CN(const graph::Point& vertex) const {
  return launch_->CS(vertex) || landing_->CS(vertex);
}

bool Manoeuvre::Explorable(const graph::Edge& edge) const {
  return LaunchStance(edge.from) && LandingStance(edge.to) && CN(edge);
}

std::unique_ptr<graph::ConfirmationJob> Manoeuvre::SpawnConfirmationJob(
    const graph::Edge& edge) const {
  if (!CN(edge)) return nullptr;
  return std::make_unique<MotionJob>(*this, checker_, edge);
}

bool Manoeuvre::ReplaceGuesses(const CancellationToken&) { return false; }

std::optional<GroundedStance> Manoeuvre::LaunchStance(const graph::Point& v) const {
  return AsStance(*model_, from_, ToPose(v));
}

std::optional<GroundedStance> Manoeuvre::LandingStance(const graph::Point& v) const {
  return AsStance(*model_, to_, ToPose(v));
}

graph::Point Manoeuvre::PointOf(const GroundedStance& stance) const {
  return ToPoint(model_->gaits[stance.gait]->stance.RootPose(stance.pose, stance.z));
}

std::vector<std::shared_ptr<Manoeuvre>> MakeManoeuvres(
    const std::vector<ManoeuvreFactory>& factories, const std::vector<std::string>& actions,
    const PlanningContext& context, const std::string& where) {
  std::vector<std::shared_ptr<Manoeuvre>> made;
  for (const ManoeuvreFactory& factory : factories) {
    if (std::find(actions.begin(), actions.end(), factory.name) == actions.end()) continue;
    const std::shared_ptr<Manoeuvre> manoeuvre = factory.make ? factory.make(context) : nullptr;
    if (!manoeuvre) {
      throw InputError(fmt::format("{}: the factory of action '{}' {}, expected a manoeuvre", where,
                                   factory.name, factory.make ? "made nothing" : "is empty"));
    }
    if (manoeuvre->name() != factory.name) {
      throw InputError(fmt::format("{}: the factory of action '{}' made one called '{}'", where,
                                   factory.name, manoeuvre->name()));
    }
    made.push_back(manoeuvre);
  }
  return made;
}

}  // namespace possibility::actions
