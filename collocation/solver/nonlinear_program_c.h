#pragma once

/* A nonlinear program for code in C, or in any language that calls C: minimise f(x) subject to
 * lower <= x <= upper and constraint_lower <= g(x) <= constraint_upper. Infinite bounds are
 * +-HUGE_VAL. Arrays belong to the caller and have the sizes given here; indices begin at 0. A
 * program belongs to one thread at a time. program_handle.h makes one in C++. */

#ifdef __cplusplus
extern "C" {
#endif

typedef struct possibility_program possibility_program;

int possibility_num_variables(const possibility_program* program);   /* n */
int possibility_num_constraints(const possibility_program* program); /* m */

void possibility_bounds(const possibility_program* program, double* lower /* n */,
                        double* upper /* n */);
void possibility_constraint_bounds(const possibility_program* program, double* lower /* m */,
                                   double* upper /* m */);
void possibility_starting_point(const possibility_program* program, double* x /* n */);

/* Places of the entries of the Jacobian of g, m x n, and of the lower triangle of the Hessian of
 * the Lagrangian, n x n. Entries at one place add up. */
int possibility_jacobian_entries(const possibility_program* program);
void possibility_jacobian_pattern(const possibility_program* program, int* rows, int* columns);
int possibility_hessian_entries(const possibility_program* program);
void possibility_hessian_pattern(const possibility_program* program, int* rows, int* columns);

/* Each returns 0, or another number if a function is undefined at x or not finite; nothing is
 * written then, and possibility_error has the reason. */
int possibility_objective(possibility_program* program, const double* x, double* value);
int possibility_gradient(possibility_program* program, const double* x, double* gradient /* n */);
int possibility_constraints(possibility_program* program, const double* x, double* g /* m */);
int possibility_jacobian(possibility_program* program, const double* x,
                         double* values /* jacobian_entries */);
/* Of objective_factor f + multipliers' g. */
int possibility_hessian(possibility_program* program, const double* x, double objective_factor,
                        const double* multipliers /* m */, double* values /* hessian_entries */);

/* Why the last evaluation failed. Texts are valid until the next call that returns a text; a name
 * for an index out of range is empty. */
const char* possibility_error(possibility_program* program);
const char* possibility_variable_name(possibility_program* program, int variable);
const char* possibility_constraint_name(possibility_program* program, int constraint);

#ifdef __cplusplus
}
#endif
