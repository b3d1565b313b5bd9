#pragma once

#include <Eigen/Core>
#include <string>

#include "collocation/problem/nonlinear_program.h"
#include "collocation/solver/nonlinear_program_c.h"

/// A program behind its C interface: pass its address to C. Both must outlive the use.
struct possibility_program {
  /// `starting_point`: num_variables.
  /// @throws std::invalid_argument if its size is another.
  possibility_program(possibility::collocation::NonlinearProgram* program,
                      Eigen::VectorXd starting_point);
  possibility_program(const possibility_program&) = delete;
  possibility_program& operator=(const possibility_program&) = delete;

  possibility::collocation::NonlinearProgram* const program;
  const Eigen::VectorXd starting_point;
  std::string error;
  std::string name;
};
