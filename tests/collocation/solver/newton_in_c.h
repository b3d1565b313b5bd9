#pragma once

#include "collocation/solver/nonlinear_program_c.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A solver in C: one Newton step on the first-order conditions of a program whose rows are all
 * equalities and whose bounds either fix a variable or do not matter. Solves quadratic programs.
 * Dense. x: the starting point, then the solution. Returns 0, or 1 if an evaluation fails or the
 * matrix is singular. */
int newton_in_c(possibility_program* program, double* x);

#ifdef __cplusplus
}
#endif
