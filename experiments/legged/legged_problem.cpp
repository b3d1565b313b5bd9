#include "experiments/legged/legged_problem.h"

#include <memory>

#include "collocation/problem/function.h"

namespace possibility::experiments {

using namespace collocation;  // reads like the mathematics

namespace {

std::shared_ptr<Function> Square() {
  return Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; });
}

}  // namespace

Variables Joined(std::initializer_list<const Variables*> groups) {
  Variables all;
  for (const Variables* group : groups) all.insert(all.end(), group->begin(), group->end());
  return all;
}

std::vector<VariableAt> EndsOf(const Variables& variables, At at) {
  std::vector<VariableAt> ends;
  for (const Variable& variable : variables) ends.push_back({variable, at});
  return ends;
}

void Append(const std::vector<VariableAt>& more, std::vector<VariableAt>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

Variables AddMotors(const dynamics::MultibodyModel& model, const std::vector<Motor>& motors,
                    Phase* phase) {
  Variables efforts;
  for (int i = 0; i < model.num_joints(); ++i) {
    const double effort = model.effort()[i];
    efforts.push_back(phase->AddControl("effort " + model.tree().joints[model.joints()[i]].name,
                                        {-effort, effort}, motors[i].scale));
    phase->Guess(efforts.back(), 0);
    phase->AddIntegralCost("effort", Square(), {efforts.back()}, motors[i].weight);
  }
  return efforts;
}

}  // namespace possibility::experiments
