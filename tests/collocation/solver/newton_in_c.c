#include "tests/collocation/solver/newton_in_c.h"

#include <math.h>
#include <stdlib.h>

typedef struct {
  int n, m, size; /* size = n + m */
  double *lower, *upper, *row_lower, *row_upper, *gradient, *g, *multipliers;
  double *matrix, *right; /* the Newton system, row by row */
} newton;

static double* numbers(int count) { return calloc((size_t)count + 1, sizeof(double)); }
static int* indices(int count) { return calloc((size_t)count + 1, sizeof(int)); }

static newton begin(const possibility_program* program) {
  newton it;
  it.n = possibility_num_variables(program);
  it.m = possibility_num_constraints(program);
  it.size = it.n + it.m;
  it.lower = numbers(it.n);
  it.upper = numbers(it.n);
  it.row_lower = numbers(it.m);
  it.row_upper = numbers(it.m);
  it.gradient = numbers(it.n);
  it.g = numbers(it.m);
  it.multipliers = numbers(it.m);
  it.matrix = numbers(it.size * it.size);
  it.right = numbers(it.size);
  possibility_bounds(program, it.lower, it.upper);
  possibility_constraint_bounds(program, it.row_lower, it.row_upper);
  return it;
}

static void end(newton* it) {
  free(it->lower);
  free(it->upper);
  free(it->row_lower);
  free(it->row_upper);
  free(it->gradient);
  free(it->g);
  free(it->multipliers);
  free(it->matrix);
  free(it->right);
}

static int add_hessian(possibility_program* program, const double* x, newton* it) {
  const int entries = possibility_hessian_entries(program);
  int *rows = indices(entries), *columns = indices(entries), k;
  double* values = numbers(entries);
  const int failed = possibility_hessian(program, x, 1, it->multipliers, values);
  possibility_hessian_pattern(program, rows, columns);
  for (k = 0; k < entries; ++k) {
    it->matrix[rows[k] * it->size + columns[k]] += values[k];
    if (rows[k] != columns[k]) it->matrix[columns[k] * it->size + rows[k]] += values[k];
  }
  free(rows);
  free(columns);
  free(values);
  return failed;
}

static int add_jacobian(possibility_program* program, const double* x, newton* it) {
  const int entries = possibility_jacobian_entries(program);
  int *rows = indices(entries), *columns = indices(entries), k;
  double* values = numbers(entries);
  const int failed = possibility_jacobian(program, x, values);
  possibility_jacobian_pattern(program, rows, columns);
  for (k = 0; k < entries; ++k) {
    const int row = it->n + rows[k];
    it->matrix[row * it->size + columns[k]] += values[k];
    it->matrix[columns[k] * it->size + row] += values[k];
  }
  free(rows);
  free(columns);
  free(values);
  return failed;
}

static int add_right_side(possibility_program* program, const double* x, newton* it) {
  int i, j;
  if (possibility_gradient(program, x, it->gradient)) return 1;
  if (possibility_constraints(program, x, it->g)) return 1;
  for (i = 0; i < it->n; ++i) it->right[i] = -it->gradient[i];
  for (i = 0; i < it->m; ++i) it->right[it->n + i] = it->row_lower[i] - it->g[i];
  for (i = 0; i < it->n; ++i) {
    if (it->lower[i] != it->upper[i]) continue;
    for (j = 0; j < it->size; ++j) it->matrix[i * it->size + j] = i == j;
    it->right[i] = it->lower[i] - x[i];
  }
  return 0;
}

/* Gauss, with the largest pivot of each column. */
static int eliminate(newton* it) {
  const int size = it->size;
  int column, row, j;
  for (column = 0; column < size; ++column) {
    int best = column;
    double swap;
    for (row = column; row < size; ++row) {
      if (fabs(it->matrix[row * size + column]) > fabs(it->matrix[best * size + column]))
        best = row;
    }
    if (fabs(it->matrix[best * size + column]) < 1e-14) return 1;
    for (j = 0; j < size; ++j) {
      swap = it->matrix[column * size + j];
      it->matrix[column * size + j] = it->matrix[best * size + j];
      it->matrix[best * size + j] = swap;
    }
    swap = it->right[column];
    it->right[column] = it->right[best];
    it->right[best] = swap;
    for (row = 0; row < size; ++row) {
      const double factor = it->matrix[row * size + column] / it->matrix[column * size + column];
      if (row == column || factor == 0) continue;
      for (j = column; j < size; ++j) {
        it->matrix[row * size + j] -= factor * it->matrix[column * size + j];
      }
      it->right[row] -= factor * it->right[column];
    }
  }
  return 0;
}

int newton_in_c(possibility_program* program, double* x) {
  newton it = begin(program);
  int i, failed;
  possibility_starting_point(program, x);
  failed = add_hessian(program, x, &it) || add_jacobian(program, x, &it) ||
           add_right_side(program, x, &it) || eliminate(&it);
  if (!failed) {
    for (i = 0; i < it.n; ++i) x[i] += it.right[i] / it.matrix[i * it.size + i];
  }
  end(&it);
  return failed;
}
