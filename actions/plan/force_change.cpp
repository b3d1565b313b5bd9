#include "actions/plan/force_change.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace possibility::actions {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kLeastLoad = 1e-3;       // of the weight per point, see ChangeWeights
constexpr double kRankTolerance = 1e-13;  // relative, squared singular values

/// Weight of a change of a point's force: the square of its load. A foot about to lift off must not
/// be required to pull.
VectorXd ChangeWeights(const Matrix3Xd& forces, double weight) {
  VectorXd weights(forces.cols());
  for (Eigen::Index i = 0; i < forces.cols(); ++i) {
    const double load = std::max(forces(2, i) / weight, 0.0) + kLeastLoad / forces.cols();
    weights[i] = load * load;
  }
  return weights;
}

}  // namespace

Vector6d WrenchOf(const Matrix3Xd& arms, const Matrix3Xd& forces) {
  Vector6d wrench = Vector6d::Zero();
  for (Eigen::Index i = 0; i < arms.cols(); ++i) {
    const Vector3d arm = arms.col(i);
    const Vector3d force = forces.col(i);
    wrench.head<3>() += arm.cross(force);
    wrench.tail<3>() += force;
  }
  return wrench;
}

Matrix3Xd LeastForceChange(const Matrix3Xd& arms, const Matrix3Xd& forces, double weight,
                           const Vector6d& missing) {
  const VectorXd weights = ChangeWeights(forces, weight);
  Matrix6d gram = Matrix6d::Zero();
  for (Eigen::Index i = 0; i < arms.cols(); ++i) {
    Eigen::Matrix<double, 6, 3> G;
    const Vector3d arm = arms.col(i);
    G.topRows<3>() << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    G.bottomRows<3>().setIdentity();
    gram += weights[i] * G * G.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(gram);
  const double cutoff = kRankTolerance * eigen.eigenvalues().maxCoeff();
  Vector6d coordinates = eigen.eigenvectors().transpose() * missing;
  for (int i = 0; i < 6; ++i) {
    const double value = eigen.eigenvalues()[i];
    coordinates[i] = value > cutoff ? coordinates[i] / value : 0;
  }
  const Vector6d multiplier = eigen.eigenvectors() * coordinates;
  Matrix3Xd change(3, arms.cols());
  for (Eigen::Index i = 0; i < arms.cols(); ++i) {
    const Vector3d arm = arms.col(i);
    change.col(i) = weights[i] * (multiplier.tail<3>() + Vector3d(multiplier.head<3>()).cross(arm));
  }
  return change;
}

}  // namespace possibility::actions
