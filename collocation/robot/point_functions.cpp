// Positions, velocities and accelerations of points.
#include "collocation/robot/point_functions.h"

#include <Eigen/Core>

#include "collocation/robot/robot_function.h"

namespace possibility::collocation {

namespace {

using dynamics::ContactPoint;
using dynamics::PointTerm;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Components of a quantity of points that depends on the first `parts` of q, v, a.
class PointFunction : public RobotFunction {
 public:
  PointFunction(const RobotSystem& model, const std::vector<PointComponent>& components, int parts)
      : RobotFunction(model, components, parts * model->nv(), static_cast<int>(components.size())) {
  }

  Mask JacobianMask() const override {
    Mask mask(num_outputs(), num_inputs());
    const int parts = num_inputs() / n_;
    for (int part = 0; part < parts; ++part) {
      mask.middleCols(part * n_, n_) = part == parts - 1 ? DriveMask() : TurnMask();
    }
    return mask;
  }

 protected:
  template <typename Quantity>
  void PutComponents(const Quantity& quantity, VectorXd* y) const {
    for (const Point& point : points_) {
      const Vector3d value = quantity(point.point);
      for (const int i : point.components) (*y)[i] = components_[i].axis.dot(value);
    }
  }
  Eigen::RowVector3d Axis(int component) const { return components_[component].axis.transpose(); }
};

class PointPositionsFunction : public PointFunction {
 public:
  PointPositionsFunction(const RobotSystem& model, const std::vector<PointComponent>& components)
      : PointFunction(model, components, 1) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    PutComponents([this](const ContactPoint& point) { return dynamics_.Position(point); }, y);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    MatrixXd jacobian(3, n_);
    for (const Point& point : points_) {
      dynamics_.Jacobian(point.point, jacobian);
      for (const int i : point.components) J->row(i) = Axis(i) * jacobian;
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    *H = dynamics_.Hessian(VectorXd::Zero(n_), Terms(&PointTerm::on_position, multipliers)).qq;
  }

  Mask HessianMask() const override { return PointPairMask(); }
};

/// |p_0 - p_1|^2; independent of the base and of what moves both points as one body.
class SquaredDistanceFunction : public RobotFunction {
 public:
  SquaredDistanceFunction(const RobotSystem& model, const ContactPoint& from,
                          const ContactPoint& to)
      : RobotFunction(model, ComponentsOf(*model, {from, to}), model->nv(), 1),
        from_(from),
        to_(to) {
    for (int i = 0; i < n_; ++i) bends_.push_back(model->MovesApart(i, from.link, to.link));
  }

  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = Difference(z).squaredNorm(); }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    const Vector3d difference = Difference(z);
    *J = 2 * difference.transpose() * DifferenceJacobian();
    // Other contributions cancel but for rounding.
    for (int i = 0; i < n_; ++i) {
      if (!bends_[i]) (*J)(0, i) = 0;
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const Vector3d gradient = 2 * multipliers[0] * Difference(z);
    std::vector<PointTerm> terms(2);
    terms[0] = {.link = from_.link, .p_L = from_.p_L, .on_position = gradient};
    terms[1] = {.link = to_.link, .p_L = to_.p_L, .on_position = -gradient};
    const MatrixXd J = DifferenceJacobian();
    *H = dynamics_.Hessian(VectorXd::Zero(n_), terms).qq + 2 * multipliers[0] * J.transpose() * J;
    for (int i = 0; i < n_; ++i) {
      if (bends_[i]) continue;
      H->row(i).setZero();
      H->col(i).setZero();
    }
  }

  Mask JacobianMask() const override {
    Mask mask(1, n_);
    for (int i = 0; i < n_; ++i) mask(0, i) = bends_[i];
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask(n_, n_);
    for (int r = 0; r < n_; ++r) {
      for (int c = 0; c < n_; ++c) mask(r, c) = bends_[r] && bends_[c];
    }
    return mask;
  }

 private:
  Vector3d Difference(const VectorXd& z) {
    dynamics_.SetState(z, VectorXd::Zero(n_));
    return dynamics_.Position(from_) - dynamics_.Position(to_);
  }

  MatrixXd DifferenceJacobian() {
    MatrixXd first(3, n_);
    MatrixXd second(3, n_);
    dynamics_.Jacobian(from_, first);
    dynamics_.Jacobian(to_, second);
    return first - second;
  }

  ContactPoint from_, to_;
  std::vector<bool> bends_;
};

class PointVelocitiesFunction : public PointFunction {
 public:
  PointVelocitiesFunction(const RobotSystem& model, const std::vector<PointComponent>& components)
      : PointFunction(model, components, 2) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    PutComponents([this](const ContactPoint& point) { return dynamics_.Velocity(point); }, y);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    dynamics_.SetState(z.head(n_), z.tail(n_));
    for (const Point& point : points_) {
      const dynamics::PointDerivatives& D = dynamics_.DifferentiatePoint(point.point);
      for (const int i : point.components) {
        J->row(i) << Axis(i) * D.velocity_dq, Axis(i) * D.jacobian;
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

  Mask HessianMask() const override {
    Mask mask = PointPairMask().replicate(2, 2);
    mask.bottomRightCorner(n_, n_).setConstant(false);
    return mask;
  }
};

class PointAccelerationsFunction : public PointFunction {
 public:
  PointAccelerationsFunction(const RobotSystem& model,
                             const std::vector<PointComponent>& components)
      : PointFunction(model, components, 3) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    SetPositionVelocityAcceleration(z);
    PutComponents([this](const ContactPoint& point) { return dynamics_.Acceleration(point); }, y);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    SetPositionVelocityAcceleration(z);
    for (const Point& point : points_) {
      const dynamics::PointDerivatives& D = dynamics_.DifferentiatePoint(point.point);
      for (const int i : point.components) {
        J->row(i) << Axis(i) * D.acceleration_dq, Axis(i) * D.acceleration_dv, Axis(i) * D.jacobian;
      }
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    SetPositionVelocityAcceleration(z);
    PutHessian(
        dynamics_.Hessian(VectorXd::Zero(n_), Terms(&PointTerm::on_acceleration, multipliers)), H);
  }

  Mask HessianMask() const override {
    const Mask pairs = PointPairMask();
    Mask mask = pairs.replicate(3, 3);
    mask.bottomRightCorner(2 * n_, 2 * n_).setConstant(false);
    mask.block(n_, n_, n_, n_) = pairs;
    return mask;
  }
};

}  // namespace

std::shared_ptr<Function> PointPositions(const RobotSystem& model,
                                         const std::vector<PointComponent>& components) {
  return std::make_shared<PointPositionsFunction>(model, components);
}

std::shared_ptr<Function> PointPositions(const RobotSystem& model,
                                         const std::vector<ContactPoint>& points) {
  return PointPositions(model, ComponentsOf(*model, points));
}

std::shared_ptr<Function> SquaredDistance(const RobotSystem& model, const ContactPoint& from,
                                          const ContactPoint& to) {
  return std::make_shared<SquaredDistanceFunction>(model, from, to);
}

std::shared_ptr<Function> PointVelocities(const RobotSystem& model,
                                          const std::vector<PointComponent>& components) {
  return std::make_shared<PointVelocitiesFunction>(model, components);
}

std::shared_ptr<Function> PointVelocities(const RobotSystem& model,
                                          const std::vector<ContactPoint>& points) {
  return PointVelocities(model, ComponentsOf(*model, points));
}

std::shared_ptr<Function> PointAccelerations(const RobotSystem& model,
                                             const std::vector<PointComponent>& components) {
  return std::make_shared<PointAccelerationsFunction>(model, components);
}

std::shared_ptr<Function> PointAccelerations(const RobotSystem& model,
                                             const std::vector<ContactPoint>& points) {
  return PointAccelerations(model, ComponentsOf(*model, points));
}

}  // namespace possibility::collocation
