#pragma once

#include <initializer_list>
#include <vector>

#include "collocation/problem/optimal_control_problem.h"
#include "dynamics/tree/multibody_model.h"

namespace possibility::experiments {

/// Parts of optimal-control problems of legged systems (legged_models.h).

using Variables = std::vector<collocation::Variable>;

Variables Joined(std::initializer_list<const Variables*> groups);

std::vector<collocation::VariableAt> EndsOf(const Variables& variables, collocation::At at);
void Append(const std::vector<collocation::VariableAt>& more,
            std::vector<collocation::VariableAt>* all);

/// A motor: typical size of its torque or force, and the weight of its square in the cost.
struct Motor {
  double scale;
  double weight;
};

/// Adds one control per joint, within its effort limit, and its square to the cost. Returned by
/// joint.
Variables AddMotors(const dynamics::MultibodyModel& model, const std::vector<Motor>& motors,
                    collocation::Phase* phase);

}  // namespace possibility::experiments
