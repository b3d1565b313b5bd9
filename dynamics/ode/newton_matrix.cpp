#include "dynamics/ode/newton_matrix.h"

#include <stdexcept>

namespace possibility::dynamics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

NewtonMatrix::NewtonMatrix(Index size, Index positions)
    : positions_(positions),
      jacobian_(MatrixXd::Zero(size, size)),
      through_positions_(MatrixXd::Zero(size - positions, size - positions)) {}

void NewtonMatrix::Update() {
  if (!jacobian_.topLeftCorner(positions_, positions_).isZero(0)) {
    throw std::invalid_argument("Integrate: the rate of a position depends on a position");
  }
  const Index others = jacobian_.rows() - positions_;
  if (positions_ == 0) return;
  through_positions_.noalias() =
      jacobian_.bottomLeftCorner(others, positions_) * jacobian_.topRightCorner(positions_, others);
}

bool NewtonMatrix::Factor(double gamma) {
  gamma_ = gamma;
  const Index others = jacobian_.rows() - positions_;
  MatrixXd complement =
      -gamma * (jacobian_.bottomRightCorner(others, others) + gamma * through_positions_);
  complement.diagonal().array() += 1;
  lu_.compute(complement);
  return (lu_.matrixLU().diagonal().array() != 0).all();
}

void NewtonMatrix::Solve(Eigen::Ref<VectorXd> b) const {
  const Index others = jacobian_.rows() - positions_;
  auto at_positions = b.head(positions_);
  auto at_others = b.tail(others);
  at_others.noalias() += gamma_ * (jacobian_.bottomLeftCorner(others, positions_) * at_positions);
  at_others = lu_.solve(at_others).eval();
  at_positions.noalias() += gamma_ * (jacobian_.topRightCorner(positions_, others) * at_others);
}

}  // namespace possibility::dynamics
