#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

namespace possibility::dynamics {

/// The matrix I - gamma J of Newton's iteration (BDF), factorised. The rates of the first
/// `positions` components depend on the other components alone, J = [0 N; A B], as those of a
/// mechanical system do. Then only the Schur complement of the positions needs a factorisation,
/// I - gamma B - gamma^2 A N, for which A N is formed once per Jacobian.
class NewtonMatrix {
 public:
  NewtonMatrix(Eigen::Index size, Eigen::Index positions);

  /// J (size x size), to be written before Update.
  Eigen::MatrixXd& jacobian() { return jacobian_; }
  /// Takes over a new J. @throws std::invalid_argument if a rate of a position depends on a
  /// position.
  void Update();
  /// False if the matrix is singular.
  bool Factor(double gamma);
  /// Overwrites b (size) with the solution.
  void Solve(Eigen::Ref<Eigen::VectorXd> b) const;

 private:
  Eigen::Index positions_;
  double gamma_ = 0;
  Eigen::MatrixXd jacobian_;
  Eigen::MatrixXd through_positions_;  // A N
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
};

}  // namespace possibility::dynamics
