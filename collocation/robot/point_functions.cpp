// Positions, velocities and accelerations of points.
#include "collocation/robot/point_functions.h"

#include <Eigen/Core>

#include "collocation/robot/planar_function.h"

namespace possibility::collocation {

namespace {

using dynamics::ContactPoint;
using dynamics::PointTerm;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

Vector2d InPlane(const Vector3d& vector) { return {vector.x(), vector.z()}; }

class PointPositionsFunction : public PlanarFunction {
 public:
  PointPositionsFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : PlanarFunction(model, points, model->nv(), 2 * static_cast<int>(points.size())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    for (int i = 0; i < num_points(); ++i) {
      y->segment<2>(2 * i) = InPlane(dynamics_.Position(points_[i]));
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    MatrixXd jacobian(3, n_);
    for (int i = 0; i < num_points(); ++i) {
      dynamics_.Jacobian(points_[i], jacobian);
      J->row(2 * i) = jacobian.row(0);
      J->row(2 * i + 1) = jacobian.row(2);
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    *H = dynamics_.Hessian(VectorXd::Zero(n_), Terms(&PointTerm::on_position, multipliers)).qq;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(n_, n_, true);
    MaskBase(1, &mask);
    return mask;
  }
};

/// |p_0 - p_1|^2; independent of the base.
class SquaredDistanceFunction : public PlanarFunction {
 public:
  SquaredDistanceFunction(const PlanarModel& model, const ContactPoint& from,
                          const ContactPoint& to)
      : PlanarFunction(model, {from, to}, model->nv(), 1) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = Difference(z).squaredNorm(); }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    const Vector3d difference = Difference(z);
    *J = 2 * difference.transpose() * DifferenceJacobian();
    J->leftCols(3).setZero();  // the base's contributions cancel but for rounding
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const Vector2d gradient = 2 * multipliers[0] * InPlane(Difference(z));
    VectorXd gradients(4);
    gradients << gradient, -gradient;
    const MatrixXd J = DifferenceJacobian();
    *H = dynamics_.Hessian(VectorXd::Zero(n_), Terms(&PointTerm::on_position, gradients)).qq +
         2 * multipliers[0] * J.transpose() * J;
    H->topRows(3).setZero();
    H->leftCols(3).setZero();
  }

  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(1, n_, true);
    mask.leftCols(3).setConstant(false);
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(n_, n_, true);
    mask.topRows(3).setConstant(false);
    mask.leftCols(3).setConstant(false);
    return mask;
  }

 private:
  Vector3d Difference(const VectorXd& z) {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    return dynamics_.Position(points_[0]) - dynamics_.Position(points_[1]);
  }

  MatrixXd DifferenceJacobian() {
    MatrixXd first(3, n_);
    MatrixXd second(3, n_);
    dynamics_.Jacobian(points_[0], first);
    dynamics_.Jacobian(points_[1], second);
    return first - second;
  }
};

class PointVelocitiesFunction : public PlanarFunction {
 public:
  PointVelocitiesFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : PlanarFunction(model, points, 2 * model->nv(), 2 * static_cast<int>(points.size())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    for (int i = 0; i < num_points(); ++i) {
      y->segment<2>(2 * i) = InPlane(dynamics_.Velocity(points_[i]));
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    for (int i = 0; i < num_points(); ++i) {
      const dynamics::PointDerivatives& D = dynamics_.DifferentiatePoint(points_[i]);
      for (int k = 0; k < 2; ++k) {
        J->row(2 * i + k) << D.velocity_dq.row(2 * k), D.jacobian.row(2 * k);
      }
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    const dynamics::HessianProduct& products =
        dynamics_.Hessian(VectorXd::Zero(n_), Terms(&PointTerm::on_velocity, multipliers));
    H->setZero();
    H->topLeftCorner(n_, n_) = products.qq;
    PutPair(products.qv, 0, n_, H);
  }

  Mask JacobianMask() const override { return JacobianMaskWithoutBase(1); }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(2 * n_, 2 * n_, true);
    mask.bottomRightCorner(n_, n_).setConstant(false);
    MaskBase(2, &mask);
    return mask;
  }
};

class PointAccelerationsFunction : public PlanarFunction {
 public:
  PointAccelerationsFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : PlanarFunction(model, points, 3 * model->nv(), 2 * static_cast<int>(points.size())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    SetPositionVelocityAcceleration(z);
    for (int i = 0; i < num_points(); ++i) {
      y->segment<2>(2 * i) = InPlane(dynamics_.Acceleration(points_[i]));
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    SetPositionVelocityAcceleration(z);
    for (int i = 0; i < num_points(); ++i) {
      const dynamics::PointDerivatives& D = dynamics_.DifferentiatePoint(points_[i]);
      for (int k = 0; k < 2; ++k) {
        J->row(2 * i + k) << D.acceleration_dq.row(2 * k), D.acceleration_dv.row(2 * k),
            D.jacobian.row(2 * k);
      }
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    SetPositionVelocityAcceleration(z);
    PutHessian(
        dynamics_.Hessian(VectorXd::Zero(n_), Terms(&PointTerm::on_acceleration, multipliers)), H);
  }

  Mask JacobianMask() const override { return JacobianMaskWithoutBase(2); }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), true);
    mask.bottomRightCorner(2 * n_, 2 * n_).setConstant(false);
    mask.block(n_, n_, n_, n_).setConstant(true);
    MaskBase(3, &mask);
    return mask;
  }
};

}  // namespace

std::shared_ptr<Function> PointPositions(const PlanarModel& model,
                                         const std::vector<ContactPoint>& points) {
  return std::make_shared<PointPositionsFunction>(model, points);
}

std::shared_ptr<Function> SquaredDistance(const PlanarModel& model, const ContactPoint& from,
                                          const ContactPoint& to) {
  return std::make_shared<SquaredDistanceFunction>(model, from, to);
}

std::shared_ptr<Function> PointVelocities(const PlanarModel& model,
                                          const std::vector<ContactPoint>& points) {
  return std::make_shared<PointVelocitiesFunction>(model, points);
}

std::shared_ptr<Function> PointAccelerations(const PlanarModel& model,
                                             const std::vector<ContactPoint>& points) {
  return std::make_shared<PointAccelerationsFunction>(model, points);
}

}  // namespace possibility::collocation
