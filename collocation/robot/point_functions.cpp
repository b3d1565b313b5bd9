// Positions, velocities and accelerations of points.
#include "collocation/robot/point_functions.h"

#include <Eigen/Core>

#include "collocation/robot/robot_function.h"
#include "dynamics/tree/multibody_points.h"

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
      : PointFunction(model, components, 1), positions_(model) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    positions_.SetPosition(z);
    PutComponents([this](const ContactPoint& point) { return positions_.Position(point); }, y);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    positions_.SetPosition(z);
    for (const Point& point : points_) {
      const MatrixXd& jacobian = positions_.Jacobian(point.point);
      for (const int i : point.components) J->row(i) = Axis(i) * jacobian;
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    positions_.SetPosition(z);
    *H = positions_.Hessian(Terms(&PointTerm::on_position, multipliers));
  }

  Mask HessianMask() const override { return PointPairMask(); }

 private:
  dynamics::MultibodyPoints positions_;
};

/// weight * |p_from - p_to|^2, a part of an output.
struct WeightedSquare {
  ContactPoint from, to;
  double weight = 1;
  int output = 0;
};

/// Sums of weighted squared distances; independent of the base and of what moves both points of
/// each as one body.
class SquaredDistancesFunction : public RobotFunction {
 public:
  SquaredDistancesFunction(const RobotSystem& model, const std::vector<WeightedSquare>& squares,
                           const VectorXd& constants)
      : RobotFunction(model, ComponentsOf(*model, EndsOf(squares)), model->nv(),
                      static_cast<int>(constants.size())),
        positions_(model),
        squares_(squares),
        constants_(constants),
        jacobian_mask_(Mask::Constant(num_outputs(), n_, false)),
        hessian_mask_(Mask::Constant(n_, n_, false)) {
    for (const WeightedSquare& square : squares_) {
      Eigen::Array<bool, 1, Eigen::Dynamic> bends(n_);
      for (int i = 0; i < n_; ++i)
        bends[i] = model->MovesApart(i, square.from.link, square.to.link);
      jacobian_mask_.row(square.output) = jacobian_mask_.row(square.output) || bends;
      for (int i = 0; i < n_; ++i) {
        if (bends[i]) hessian_mask_.row(i) = hessian_mask_.row(i) || bends;
      }
      bends_.push_back(bends.transpose());
    }
  }

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    positions_.SetPosition(z);
    *y = constants_;
    for (const WeightedSquare& square : squares_) {
      (*y)[square.output] += square.weight * Difference(square).squaredNorm();
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    positions_.SetPosition(z);
    J->setZero();
    for (std::size_t k = 0; k < squares_.size(); ++k) {
      J->row(squares_[k].output) +=
          2 * squares_[k].weight * Difference(squares_[k]).transpose() * DifferenceJacobian(k);
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    positions_.SetPosition(z);
    std::vector<PointTerm> terms;
    for (const WeightedSquare& square : squares_) {
      const Vector3d gradient = 2 * square.weight * multipliers[square.output] * Difference(square);
      terms.push_back({.link = square.from.link, .p_L = square.from.p_L, .on_position = gradient});
      terms.push_back({.link = square.to.link, .p_L = square.to.p_L, .on_position = -gradient});
    }
    // The base's part cancels but for rounding.
    *H = hessian_mask_.select(positions_.Hessian(terms), 0.0);
    for (std::size_t k = 0; k < squares_.size(); ++k) {
      const MatrixXd J = DifferenceJacobian(k);
      const double weight = 2 * squares_[k].weight * multipliers[squares_[k].output];
      H->noalias() += weight * J.transpose() * J;
    }
  }

  Mask JacobianMask() const override { return jacobian_mask_; }
  Mask HessianMask() const override { return hessian_mask_; }

 private:
  static std::vector<ContactPoint> EndsOf(const std::vector<WeightedSquare>& squares) {
    std::vector<ContactPoint> ends;
    for (const WeightedSquare& square : squares) ends.insert(ends.end(), {square.from, square.to});
    return ends;
  }

  Vector3d Difference(const WeightedSquare& square) {
    return positions_.Position(square.from) - positions_.Position(square.to);
  }

  MatrixXd DifferenceJacobian(std::size_t k) {
    MatrixXd difference = positions_.Jacobian(squares_[k].from);
    difference -= positions_.Jacobian(squares_[k].to);
    // Other contributions cancel but for rounding.
    for (int i = 0; i < n_; ++i) {
      if (!bends_[k][i]) difference.col(i).setZero();
    }
    return difference;
  }

  dynamics::MultibodyPoints positions_;
  std::vector<WeightedSquare> squares_;
  VectorXd constants_;
  /// By square and velocity: whether it moves one point against the other.
  std::vector<Eigen::Array<bool, Eigen::Dynamic, 1>> bends_;
  Mask jacobian_mask_, hessian_mask_;
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
  return std::make_shared<SquaredDistancesFunction>(model, std::vector<WeightedSquare>{{from, to}},
                                                    VectorXd::Zero(1));
}

std::shared_ptr<Function> HeightsOverPlanes(const RobotSystem& model,
                                            const std::vector<PointOverPlane>& pairs) {
  // n . (p - o) = (|p - o|^2 - |p - (o + n)|^2 + 1) / 2.
  std::vector<WeightedSquare> squares;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const int output = static_cast<int>(i);
    ContactPoint above = pairs[i].origin;
    above.p_L += pairs[i].normal_L;
    squares.push_back({pairs[i].point, pairs[i].origin, 0.5, output});
    squares.push_back({pairs[i].point, above, -0.5, output});
  }
  return std::make_shared<SquaredDistancesFunction>(
      model, squares, VectorXd::Constant(static_cast<Eigen::Index>(pairs.size()), 0.5));
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
