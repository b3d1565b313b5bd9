#include "dynamics/ode/state_vector.h"

#include <nvector/nvector_serial.h>

#include <cmath>

namespace possibility::dynamics {
namespace {

constexpr int kDone = 0;

void LinearSum(realtype a, N_Vector x, realtype b, N_Vector y, N_Vector z) noexcept {
  AsVector(z) = a * AsVector(x) + b * AsVector(y);
}

void Scale(realtype c, N_Vector x, N_Vector z) noexcept { AsVector(z) = c * AsVector(x); }

realtype WeightedNorm(N_Vector x, N_Vector weights) noexcept {
  const auto values = AsVector(x);
  return std::sqrt(values.cwiseProduct(AsVector(weights)).squaredNorm() /
                   static_cast<double>(values.size()));
}

/// Of the vectors only the first may be z.
int LinearCombination(int count, realtype* factors, N_Vector* vectors, N_Vector z) noexcept {
  auto sum = AsVector(z);
  sum = factors[0] * AsVector(vectors[0]);
  for (int i = 1; i < count; ++i) sum += factors[i] * AsVector(vectors[i]);
  return kDone;
}

int AddMultiples(int count, realtype* factors, N_Vector x, N_Vector* y, N_Vector* z) noexcept {
  for (int i = 0; i < count; ++i) AsVector(z[i]) = factors[i] * AsVector(x) + AsVector(y[i]);
  return kDone;
}

}  // namespace

N_Vector MakeStateVector(const Eigen::VectorXd& values, SUNContext context) {
  N_Vector vector = N_VNew_Serial(values.size(), context);
  if (vector == nullptr) return nullptr;
  vector->ops->nvlinearsum = &LinearSum;
  vector->ops->nvscale = &Scale;
  vector->ops->nvwrmsnorm = &WeightedNorm;
  vector->ops->nvlinearcombination = &LinearCombination;
  vector->ops->nvscaleaddmulti = &AddMultiples;
  AsVector(vector) = values;
  return vector;
}

Eigen::Map<Eigen::VectorXd> AsVector(N_Vector vector) {
  return {NV_DATA_S(vector), NV_LENGTH_S(vector)};
}

}  // namespace possibility::dynamics
