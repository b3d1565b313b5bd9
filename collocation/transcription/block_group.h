#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/problem/constraint_block.h"

namespace possibility::collocation {

/// Blocks of a program that share functions, and so workspaces: one thread evaluates them. Their
/// Hessians are summed up here first, so that the sum over all groups does not depend on which
/// thread was quicker.
struct BlockGroup {
  std::vector<int> blocks;         ///< ascending
  std::vector<int> hessian_slots;  ///< of the program's values, by element of `hessian`
  Eigen::VectorXd hessian;

  void AddHessianTo(Eigen::VectorXd* values) const;
};

/// The blocks by the functions that they share, the dearest group first. From here on, blocks add
/// their second derivatives to the `hessian` of their group.
std::vector<BlockGroup> GroupByFunction(std::vector<ConstraintBlock>* blocks);

}  // namespace possibility::collocation
