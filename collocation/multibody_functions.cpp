#include "collocation/multibody_functions.h"

#include <array>
#include <stdexcept>

namespace possibility::collocation {

namespace {

using dynamics::ContactPoint;
using dynamics::MultibodyDynamics;
using dynamics::PointTerm;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

const PlanarModel& Checked(const PlanarModel& model) {
  if (model->base() != dynamics::Base::kPlanar) {
    throw std::invalid_argument("a function of a planar system: the model's base is not planar");
  }
  return model;
}

/// World axes in the plane, in the order of a point's components.
const std::array<Vector3d, 2>& Axes() {
  static const std::array<Vector3d, 2> axes = {Vector3d::UnitX(), Vector3d::UnitZ()};
  return axes;
}

Vector3d InPlane(double x, double z) { return {x, 0, z}; }

class MultibodyFunction : public Function {
 public:
  MultibodyFunction(const PlanarModel& model, const std::vector<ContactPoint>& points,
                    int num_inputs, int num_outputs)
      : Function(num_inputs, num_outputs),
        n_(Checked(model)->nv()),
        dynamics_(model),
        points_(points) {}

 protected:
  /// The matrix's columns `first` ... are those of -J' f with respect to each component of f.
  void SubtractForceColumns(int first, MatrixXd* J) {
    MatrixXd jacobian(3, n_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      dynamics_.Jacobian(points_[i], jacobian);
      for (int k = 0; k < 2; ++k) {
        J->col(first + 2 * static_cast<int>(i) + k) = -jacobian.transpose() * Axes()[k];
      }
    }
  }
  /// d2(-lambda' J' f) / dq df into both triangles of H; f is from input `first` on.
  void SubtractForceHessian(const VectorXd& lambda, int first, MatrixXd* H) {
    MatrixXd dq(n_, n_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      for (int k = 0; k < 2; ++k) {
        dq.setZero();
        dynamics_.AddPointForceDerivative(points_[i], Axes()[k], dq);
        const int column = first + 2 * static_cast<int>(i) + k;
        H->block(0, column, n_, 1) = -dq.transpose() * lambda;
        H->block(column, 0, 1, n_) = H->block(0, column, n_, 1).transpose();
      }
    }
  }
  VectorXd PointForces(const VectorXd& z, int first) const {
    VectorXd forces = VectorXd::Zero(n_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      dynamics_.AddPointForce(points_[i], ForceOn(z, first, i), forces);
    }
    return forces;
  }
  static Vector3d ForceOn(const VectorXd& z, int first, std::size_t point) {
    const int at = first + 2 * static_cast<int>(point);
    return InPlane(z[at], z[at + 1]);
  }

  int n_;
  MultibodyDynamics dynamics_;
  std::vector<ContactPoint> points_;
};

class EquationOfMotionFunction : public MultibodyFunction {
 public:
  EquationOfMotionFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : MultibodyFunction(model, points, 3 * model->nv() + 2 * static_cast<int>(points.size()),
                          model->nv()) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    Set(z);
    *y = dynamics_.InverseDynamics() - PointForces(z, 3 * n_);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    Set(z);
    const dynamics::InverseDynamicsDerivatives& D = dynamics_.Differentiate();
    J->leftCols(n_) = D.dq;
    J->middleCols(n_, n_) = D.dv;
    J->middleCols(2 * n_, n_) = D.da;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      dynamics_.AddPointForceDerivative(points_[i], -ForceOn(z, 3 * n_, i), J->leftCols(n_));
    }
    SubtractForceColumns(3 * n_, J);
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    Set(z);
    std::vector<PointTerm> terms(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      terms[i].link = points_[i].link;
      terms[i].p_L = points_[i].p_L;
      terms[i].force = -ForceOn(z, 3 * n_, i);
    }
    const dynamics::HessianProduct& products = dynamics_.Hessian(multipliers, terms);
    H->setZero();
    H->block(0, 0, n_, n_) = products.qq;
    H->block(0, n_, n_, n_) = products.qv;
    H->block(n_, 0, n_, n_) = products.qv.transpose();
    H->block(n_, n_, n_, n_) = products.vv;
    H->block(0, 2 * n_, n_, n_) = products.qa;
    H->block(2 * n_, 0, n_, n_) = products.qa.transpose();
    SubtractForceHessian(multipliers, 3 * n_, H);
  }

  Mask JacobianMask() const override {
    // Neither where the robot is nor how fast it moves as a whole matters to its forces: columns
    // of x, z (but for the points' Jacobians, which do not depend on them either) are zero.
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), true);
    mask.middleCols(1, 2).setConstant(false);
    mask.middleCols(n_ + 1, 2).setConstant(false);
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), true);
    mask.bottomRightCorner(num_inputs() - n_, num_inputs() - n_).setConstant(false);
    mask.block(n_, n_, n_, n_).setConstant(true);
    for (const int unmoving : {1, 2, n_ + 1, n_ + 2}) {
      mask.row(unmoving).setConstant(false);
      mask.col(unmoving).setConstant(false);
    }
    return mask;
  }

 private:
  void Set(const VectorXd& z) {
    dynamics_.SetState(z.head(n_), z.segment(n_, n_), z.segment(2 * n_, n_));
  }
};

class PointPositionsFunction : public MultibodyFunction {
 public:
  PointPositionsFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : MultibodyFunction(model, points, model->nv(), 2 * static_cast<int>(points.size())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector3d p = dynamics_.Position(points_[i]);
      y->segment<2>(2 * static_cast<Eigen::Index>(i)) << p.x(), p.z();
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    MatrixXd jacobian(3, n_);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      dynamics_.Jacobian(points_[i], jacobian);
      J->row(2 * static_cast<Eigen::Index>(i)) = jacobian.row(0);
      J->row(2 * static_cast<Eigen::Index>(i) + 1) = jacobian.row(2);
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    std::vector<PointTerm> terms(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      terms[i].link = points_[i].link;
      terms[i].p_L = points_[i].p_L;
      terms[i].on_position = ForceOn(multipliers, 0, i);
    }
    *H = dynamics_.Hessian(VectorXd::Zero(n_), terms).qq;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(n_, n_, true);
    mask.middleRows(1, 2).setConstant(false);
    mask.middleCols(1, 2).setConstant(false);
    return mask;
  }
};

/// |p_0 - p_1|^2: wherever the base is.
class SquaredDistanceFunction : public MultibodyFunction {
 public:
  SquaredDistanceFunction(const PlanarModel& model, const ContactPoint& from,
                          const ContactPoint& to)
      : MultibodyFunction(model, {from, to}, model->nv(), 1) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = Difference(z).squaredNorm(); }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    const Vector3d difference = Difference(z);
    *J = 2 * difference.transpose() * DifferenceJacobian();
    J->leftCols(3).setZero();  // what the base moves cancels but for rounding
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const Vector3d gradient = 2 * multipliers[0] * Difference(z);
    std::vector<PointTerm> terms(2);
    for (int i = 0; i < 2; ++i) {
      terms[i].link = points_[i].link;
      terms[i].p_L = points_[i].p_L;
      terms[i].on_position = i == 0 ? gradient : Vector3d(-gradient);
    }
    const MatrixXd J = DifferenceJacobian();
    *H = dynamics_.Hessian(VectorXd::Zero(n_), terms).qq + 2 * multipliers[0] * J.transpose() * J;
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

class PointVelocitiesFunction : public MultibodyFunction {
 public:
  PointVelocitiesFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : MultibodyFunction(model, points, 2 * model->nv(), 2 * static_cast<int>(points.size())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector3d velocity = dynamics_.Velocity(points_[i]);
      y->segment<2>(2 * static_cast<Eigen::Index>(i)) << velocity.x(), velocity.z();
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const dynamics::PointDerivatives& D = dynamics_.DifferentiatePoint(points_[i]);
      for (int k = 0; k < 2; ++k) {
        J->row(2 * static_cast<Eigen::Index>(i) + k) << D.velocity_dq.row(2 * k),
            D.jacobian.row(2 * k);
      }
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    std::vector<PointTerm> terms(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      terms[i].link = points_[i].link;
      terms[i].p_L = points_[i].p_L;
      terms[i].on_velocity = ForceOn(multipliers, 0, i);
    }
    const dynamics::HessianProduct& products = dynamics_.Hessian(VectorXd::Zero(n_), terms);
    H->setZero();
    H->topLeftCorner(n_, n_) = products.qq;
    H->topRightCorner(n_, n_) = products.qv;
    H->bottomLeftCorner(n_, n_) = products.qv.transpose();
  }

  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), true);
    mask.middleCols(1, 2).setConstant(false);
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(2 * n_, 2 * n_, true);
    mask.bottomRightCorner(n_, n_).setConstant(false);
    for (const int unmoving : {1, 2, n_ + 1, n_ + 2}) {
      mask.row(unmoving).setConstant(false);
      mask.col(unmoving).setConstant(false);
    }
    return mask;
  }
};

class PointAccelerationsFunction : public MultibodyFunction {
 public:
  PointAccelerationsFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : MultibodyFunction(model, points, 3 * model->nv(), 2 * static_cast<int>(points.size())) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    Set(z);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Vector3d acceleration = dynamics_.Acceleration(points_[i]);
      y->segment<2>(2 * static_cast<Eigen::Index>(i)) << acceleration.x(), acceleration.z();
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    Set(z);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const dynamics::PointDerivatives& D = dynamics_.DifferentiatePoint(points_[i]);
      for (int k = 0; k < 2; ++k) {
        J->row(2 * static_cast<Eigen::Index>(i) + k) << D.acceleration_dq.row(2 * k),
            D.acceleration_dv.row(2 * k), D.jacobian.row(2 * k);
      }
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    Set(z);
    std::vector<PointTerm> terms(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      terms[i].link = points_[i].link;
      terms[i].p_L = points_[i].p_L;
      terms[i].on_acceleration = ForceOn(multipliers, 0, i);
    }
    const dynamics::HessianProduct& products = dynamics_.Hessian(VectorXd::Zero(n_), terms);
    H->setZero();
    H->block(0, 0, n_, n_) = products.qq;
    H->block(0, n_, n_, n_) = products.qv;
    H->block(n_, 0, n_, n_) = products.qv.transpose();
    H->block(n_, n_, n_, n_) = products.vv;
    H->block(0, 2 * n_, n_, n_) = products.qa;
    H->block(2 * n_, 0, n_, n_) = products.qa.transpose();
  }

  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), true);
    mask.middleCols(1, 2).setConstant(false);
    mask.middleCols(n_ + 1, 2).setConstant(false);
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), true);
    mask.bottomRightCorner(n_, n_).setConstant(false);
    for (int part = 0; part < 3; ++part) {
      mask.middleRows(part * n_ + 1, 2).setConstant(false);
      mask.middleCols(part * n_ + 1, 2).setConstant(false);
    }
    mask.block(n_, 2 * n_, n_, n_).setConstant(false);
    mask.block(2 * n_, n_, n_, n_).setConstant(false);
    return mask;
  }

 private:
  void Set(const VectorXd& z) {
    dynamics_.SetState(z.head(n_), z.segment(n_, n_), z.segment(2 * n_, n_));
  }
};

class ImpactMapFunction : public MultibodyFunction {
 public:
  ImpactMapFunction(const PlanarModel& model, const std::vector<ContactPoint>& points)
      : MultibodyFunction(model, points, 3 * model->nv() + 2 * static_cast<int>(points.size()),
                          model->nv()) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z.head(n_), VectorXd::Zero(n_));
    *y = dynamics_.MassMatrix() * Change(z) - PointForces(z, 3 * n_);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    // At rest ID(q, 0, a) = M a + g: what a adds to its derivative is that of M a.
    dynamics_.SetState(z.head(n_), VectorXd::Zero(n_), Change(z));
    const MatrixXd with_change = dynamics_.Differentiate().dq;
    const MatrixXd M = dynamics_.MassMatrix();
    dynamics_.SetAcceleration(VectorXd::Zero(n_));
    J->leftCols(n_) = with_change - dynamics_.Differentiate().dq;
    J->middleCols(n_, n_) = -M;
    J->middleCols(2 * n_, n_) = M;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      dynamics_.AddPointForceDerivative(points_[i], -ForceOn(z, 3 * n_, i), J->leftCols(n_));
    }
    SubtractForceColumns(3 * n_, J);
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    std::vector<PointTerm> terms(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      terms[i].link = points_[i].link;
      terms[i].p_L = points_[i].p_L;
      terms[i].force = -ForceOn(z, 3 * n_, i);
    }
    dynamics_.SetState(z.head(n_), VectorXd::Zero(n_), Change(z));
    const dynamics::HessianProduct& products = dynamics_.Hessian(multipliers, terms);
    const MatrixXd with_change = products.qq;
    const MatrixXd qa = products.qa;
    dynamics_.SetAcceleration(VectorXd::Zero(n_));
    const MatrixXd qq = with_change - dynamics_.Hessian(multipliers).qq;
    H->setZero();
    H->topLeftCorner(n_, n_) = qq;
    H->block(0, n_, n_, n_) = -qa;
    H->block(n_, 0, n_, n_) = -qa.transpose();
    H->block(0, 2 * n_, n_, n_) = qa;
    H->block(2 * n_, 0, n_, n_) = qa.transpose();
    SubtractForceHessian(multipliers, 3 * n_, H);
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), true);
    mask.bottomRightCorner(num_inputs() - n_, num_inputs() - n_).setConstant(false);
    return mask;
  }

 private:
  VectorXd Change(const VectorXd& z) const { return z.segment(2 * n_, n_) - z.segment(n_, n_); }
};

}  // namespace

std::shared_ptr<Function> EquationOfMotion(const PlanarModel& model,
                                           const std::vector<ContactPoint>& points) {
  return std::make_shared<EquationOfMotionFunction>(Checked(model), points);
}

std::shared_ptr<Function> PointPositions(const PlanarModel& model,
                                         const std::vector<ContactPoint>& points) {
  return std::make_shared<PointPositionsFunction>(Checked(model), points);
}

std::shared_ptr<Function> SquaredDistance(const PlanarModel& model, const ContactPoint& from,
                                          const ContactPoint& to) {
  return std::make_shared<SquaredDistanceFunction>(model, from, to);
}

std::shared_ptr<Function> PointVelocities(const PlanarModel& model,
                                          const std::vector<ContactPoint>& points) {
  return std::make_shared<PointVelocitiesFunction>(Checked(model), points);
}

std::shared_ptr<Function> PointAccelerations(const PlanarModel& model,
                                             const std::vector<ContactPoint>& points) {
  return std::make_shared<PointAccelerationsFunction>(model, points);
}

std::shared_ptr<Function> ImpactMap(const PlanarModel& model,
                                    const std::vector<ContactPoint>& points) {
  return std::make_shared<ImpactMapFunction>(Checked(model), points);
}

}  // namespace possibility::collocation
