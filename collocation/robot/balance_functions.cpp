// Balances of forces and of impulses.
#include "collocation/robot/balance_functions.h"

#include <Eigen/Core>

#include "collocation/robot/robot_function.h"

namespace possibility::collocation {

namespace {

using dynamics::ContactPoint;
using dynamics::PointTerm;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// A balance of forces or impulses: a function of q, v, a (or of q and two velocities) minus J' f.
/// After q, v, a come f of all points and perhaps other forces.
class BalanceFunction : public RobotFunction {
 public:
  /// `num_other_rows`: outputs beside the balance itself.
  BalanceFunction(const RobotSystem& model, const std::vector<ContactPoint>& points,
                  int num_other = 0, int num_other_rows = 0)
      : RobotFunction(
            model, ComponentsOf(*model, points),
            3 * model->nv() + static_cast<int>(ComponentsOf(*model, points).size()) + num_other,
            model->nv() + num_other_rows) {}

 protected:
  VectorXd PointForces(const VectorXd& z) const {
    VectorXd forces = VectorXd::Zero(n_);
    for (const Point& point : points_) {
      dynamics_.AddPointForce(point.point, ForceOn(point, z), forces);
    }
    return forces;
  }

  void SubtractForceJacobian(const VectorXd& z, MatrixXd* J) {
    MatrixXd jacobian(3, n_);
    for (const Point& point : points_) {
      dynamics_.AddPointForceDerivative(point.point, -ForceOn(point, z), J->topLeftCorner(n_, n_));
      dynamics_.Jacobian(point.point, jacobian);
      for (const int i : point.components) {
        J->col(3 * n_ + i).head(n_) = -jacobian.transpose() * components_[i].axis;
      }
    }
  }

  /// The terms that -lambda' J' f adds to the second derivatives with respect to q.
  std::vector<PointTerm> MinusForceTerms(const VectorXd& z) const {
    return Terms(&PointTerm::force, -ForcesIn(z));
  }

  /// d2(-lambda' J' f) / dq df into both triangles of H, after dynamics_.Hessian with lambda.
  void SubtractForceHessian(MatrixXd* H) {
    for (const Point& point : points_) {
      const MatrixXd& dq = dynamics_.DifferentiateVirtualVelocity(point.point);
      for (const int i : point.components) {
        const int column = 3 * n_ + i;
        H->block(0, column, n_, 1) = -dq.transpose() * components_[i].axis;
        H->block(column, 0, 1, n_) = H->block(0, column, n_, 1).transpose();
      }
    }
  }

  /// The columns of q and of f.
  Mask BalanceMask() const {
    Mask mask = Mask::Constant(n_, num_inputs(), false);
    mask.leftCols(n_) = RelatedMask(true, false);
    mask.middleCols(3 * n_, num_components()) = DriveMask().transpose();
    return mask;
  }

  /// The blocks of q with q, `parts` more of v, a, and f.
  Mask BalanceHessianMask(int parts) const {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), false);
    const auto pair = [&](int column, const Mask& block) {
      mask.block(0, column, n_, block.cols()) = block;
      mask.block(column, 0, block.cols(), n_) = block.transpose();
    };
    pair(0, RelatedMask(false, false));
    for (int part = 0; part < parts; ++part) pair((1 + part) * n_, RelatedMask(false, true));
    pair(3 * n_, TurnMask().transpose());
    return mask;
  }

 private:
  VectorXd ForcesIn(const VectorXd& z) const { return z.segment(3 * n_, num_components()); }
  Vector3d ForceOn(const Point& point, const VectorXd& z) const {
    return Combined(point, ForcesIn(z));
  }
};

class EquationOfMotionFunction : public BalanceFunction {
 public:
  /// `with_torques`: the joint torques are the last inputs.
  EquationOfMotionFunction(const RobotSystem& model, const std::vector<ContactPoint>& points,
                           bool with_torques, const std::vector<TorqueSpeedRow>& rows)
      : BalanceFunction(model, points, with_torques ? model->num_joints() : 0,
                        static_cast<int>(rows.size())),
        num_torques_(with_torques ? model->num_joints() : 0),
        rows_(rows) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    SetPositionVelocityAcceleration(z);
    y->head(n_) = dynamics_.InverseDynamics() - PointForces(z);
    y->segment(n_ - num_torques_, num_torques_) -= z.tail(num_torques_);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const int i = VelocityOf(rows_[k]);
      (*y)[RowOf(k)] = (*y)[i] + rows_[k].slope * z[n_ + i];
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    SetPositionVelocityAcceleration(z);
    const dynamics::InverseDynamicsDerivatives& D = dynamics_.Differentiate();
    J->topLeftCorner(n_, n_) = D.dq;
    J->block(0, n_, n_, n_) = D.dv;
    J->block(0, 2 * n_, n_, n_) = D.da;
    SubtractForceJacobian(z, J);
    J->rightCols(num_torques_).setZero();
    J->block(n_ - num_torques_, num_inputs() - num_torques_, num_torques_, num_torques_)
        .diagonal()
        .setConstant(-1);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      const int i = VelocityOf(rows_[k]);
      J->row(RowOf(k)) = J->row(i);
      (*J)(RowOf(k), n_ + i) += rows_[k].slope;
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    SetPositionVelocityAcceleration(z);
    VectorXd lambda = multipliers.head(n_);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      lambda[VelocityOf(rows_[k])] += multipliers[RowOf(k)];
    }
    PutHessian(dynamics_.Hessian(lambda, MinusForceTerms(z)), H);
    SubtractForceHessian(H);
  }

  // Forces depend neither on the robot's position nor on its linear velocity as a whole.
  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), false);
    mask.topRows(n_) = BalanceMask();
    mask.block(0, n_, n_, n_) = RelatedMask(true, false);
    mask.block(0, 2 * n_, n_, n_) = RelatedMask(true, true);
    mask.block(n_ - num_torques_, num_inputs() - num_torques_, num_torques_, num_torques_)
        .matrix()
        .diagonal()
        .setConstant(true);
    for (std::size_t k = 0; k < rows_.size(); ++k) {
      mask.row(RowOf(k)) = mask.row(VelocityOf(rows_[k]));
      mask(RowOf(k), n_ + VelocityOf(rows_[k])) = true;
    }
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = BalanceHessianMask(2);
    const Mask related = RelatedMask(false, false);
    mask.block(n_, n_, n_, n_) = related;
    mask.block(0, n_, n_, n_) = mask.block(n_, 0, n_, n_) = related;
    return mask;
  }

 private:
  int VelocityOf(const TorqueSpeedRow& row) const {
    return model().num_base_velocities() + row.joint;
  }
  Eigen::Index RowOf(std::size_t row) const { return n_ + static_cast<Eigen::Index>(row); }

  int num_torques_;
  std::vector<TorqueSpeedRow> rows_;
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
    SubtractForceHessian(H);
  }

  Mask JacobianMask() const override {
    Mask mask = BalanceMask();
    mask.middleCols(n_, n_) = mask.middleCols(2 * n_, n_) = RelatedMask(true, true);
    return mask;
  }

  Mask HessianMask() const override { return BalanceHessianMask(2); }

 private:
  VectorXd Change(const VectorXd& z) const { return z.segment(2 * n_, n_) - z.segment(n_, n_); }
};

}  // namespace

std::shared_ptr<Function> EquationOfMotion(const RobotSystem& model,
                                           const std::vector<ContactPoint>& points,
                                           const std::vector<TorqueSpeedRow>& rows) {
  return std::make_shared<EquationOfMotionFunction>(model, points, false, rows);
}

std::shared_ptr<Function> ActuatedMotion(const RobotSystem& model,
                                         const std::vector<ContactPoint>& points) {
  return std::make_shared<EquationOfMotionFunction>(model, points, true,
                                                    std::vector<TorqueSpeedRow>());
}

std::shared_ptr<Function> ImpactMap(const RobotSystem& model,
                                    const std::vector<ContactPoint>& points) {
  return std::make_shared<ImpactMapFunction>(model, points);
}

}  // namespace possibility::collocation
