// Balances of forces and of impulses.
#include "collocation/robot/balance_functions.h"

#include <Eigen/Core>
#include <array>

#include "collocation/robot/planar_function.h"

namespace possibility::collocation {

namespace {

using dynamics::ContactPoint;
using dynamics::PointTerm;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// World axes in the plane, in the order of a point's components.
const std::array<Vector3d, 2>& Axes() {
  static const std::array<Vector3d, 2> axes = {Vector3d::UnitX(), Vector3d::UnitZ()};
  return axes;
}

/// A balance of forces or impulses: a function of q, v, a (or of q and two velocities) minus J' f.
/// The inputs end with f of all points.
class BalanceFunction : public PlanarFunction {
 public:
  BalanceFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : PlanarFunction(model, points, 3 * model->nv() + 2 * static_cast<int>(points.size()),
                       model->nv()) {}

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), true);
    mask.bottomRightCorner(num_inputs() - n_, num_inputs() - n_).setConstant(false);
    return mask;
  }

 protected:
  VectorXd PointForces(const VectorXd& z) const {
    VectorXd forces = VectorXd::Zero(n_);
    for (int i = 0; i < num_points(); ++i) {
      dynamics_.AddPointForce(points_[i], ForceOn(i, z), forces);
    }
    return forces;
  }

  void SubtractForceJacobian(const VectorXd& z, MatrixXd* J) {
    MatrixXd jacobian(3, n_);
    for (int i = 0; i < num_points(); ++i) {
      dynamics_.AddPointForceDerivative(points_[i], -ForceOn(i, z), J->leftCols(n_));
      dynamics_.Jacobian(points_[i], jacobian);
      for (int k = 0; k < 2; ++k) {
        J->col(ForceColumn(i) + k) = -jacobian.transpose() * Axes()[k];
      }
    }
  }

  /// The terms that -lambda' J' f adds to the second derivatives with respect to q.
  std::vector<PointTerm> MinusForceTerms(const VectorXd& z) const {
    return Terms(&PointTerm::force, -z.tail(2 * num_points()));
  }

  /// d2(-lambda' J' f) / dq df into both triangles of H.
  void SubtractForceHessian(const VectorXd& lambda, MatrixXd* H) {
    MatrixXd dq(n_, n_);
    for (int i = 0; i < num_points(); ++i) {
      for (int k = 0; k < 2; ++k) {
        dq.setZero();
        dynamics_.AddPointForceDerivative(points_[i], Axes()[k], dq);
        const int column = ForceColumn(i) + k;
        H->block(0, column, n_, 1) = -dq.transpose() * lambda;
        H->block(column, 0, 1, n_) = H->block(0, column, n_, 1).transpose();
      }
    }
  }

 private:
  int ForceColumn(int point) const { return 3 * n_ + 2 * point; }
  Vector3d ForceOn(int point, const VectorXd& z) const {
    return {z[ForceColumn(point)], 0, z[ForceColumn(point) + 1]};
  }
};

class EquationOfMotionFunction : public BalanceFunction {
 public:
  using BalanceFunction::BalanceFunction;

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    SetPositionVelocityAcceleration(z);
    *y = dynamics_.InverseDynamics() - PointForces(z);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    SetPositionVelocityAcceleration(z);
    const dynamics::InverseDynamicsDerivatives& D = dynamics_.Differentiate();
    J->leftCols(n_) = D.dq;
    J->middleCols(n_, n_) = D.dv;
    J->middleCols(2 * n_, n_) = D.da;
    SubtractForceJacobian(z, J);
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    SetPositionVelocityAcceleration(z);
    PutHessian(dynamics_.Hessian(multipliers, MinusForceTerms(z)), H);
    SubtractForceHessian(multipliers, H);
  }

  // Forces depend neither on the robot's position nor on its linear velocity as a whole, so the
  // columns of x, z are zero. The points' Jacobians do not depend on them either.
  Mask JacobianMask() const override { return JacobianMaskWithoutBase(2); }

  Mask HessianMask() const override {
    Mask mask = BalanceFunction::HessianMask();
    mask.block(n_, n_, n_, n_).setConstant(true);
    MaskBase(2, &mask);
    return mask;
  }
};

class ImpactMapFunction : public BalanceFunction {
 public:
  using BalanceFunction::BalanceFunction;

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z.head(n_), VectorXd::Zero(n_));
    *y = dynamics_.MassMatrix() * Change(z) - PointForces(z);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    // At rest ID(q, 0, a) = M a + g, so the part of the derivative that is due to a is that of M a.
    dynamics_.SetState(z.head(n_), VectorXd::Zero(n_), Change(z));
    const MatrixXd with_change = dynamics_.Differentiate().dq;
    const MatrixXd M = dynamics_.MassMatrix();
    dynamics_.SetAcceleration(VectorXd::Zero(n_));
    J->leftCols(n_) = with_change - dynamics_.Differentiate().dq;
    J->middleCols(n_, n_) = -M;
    J->middleCols(2 * n_, n_) = M;
    SubtractForceJacobian(z, J);
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    dynamics_.SetState(z.head(n_), VectorXd::Zero(n_), Change(z));
    const dynamics::HessianProduct products = dynamics_.Hessian(multipliers, MinusForceTerms(z));
    dynamics_.SetAcceleration(VectorXd::Zero(n_));
    H->setZero();
    H->topLeftCorner(n_, n_) = products.qq - dynamics_.Hessian(multipliers).qq;
    PutPair(-products.qa, 0, n_, H);
    PutPair(products.qa, 0, 2 * n_, H);
    SubtractForceHessian(multipliers, H);
  }

 private:
  VectorXd Change(const VectorXd& z) const { return z.segment(2 * n_, n_) - z.segment(n_, n_); }
};

}  // namespace

std::shared_ptr<Function> EquationOfMotion(const PlanarModel& model,
                                           const std::vector<ContactPoint>& points) {
  return std::make_shared<EquationOfMotionFunction>(model, points);
}

std::shared_ptr<Function> ImpactMap(const PlanarModel& model,
                                    const std::vector<ContactPoint>& points) {
  return std::make_shared<ImpactMapFunction>(model, points);
}

}  // namespace possibility::collocation
