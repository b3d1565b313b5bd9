#include "collocation/robot/turning_plane.h"

#include <cmath>

#include "collocation/problem/function_algebra.h"
#include "collocation/robot/point_functions.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Inputs: x and z of each point, turn, offset.
class OverTurningPlane : public Function {
 public:
  explicit OverTurningPlane(int points) : Function(2 * points + 2, points) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    const double sine = std::sin(Turn(z));
    const double cosine = std::cos(Turn(z));
    for (int i = 0; i < num_outputs(); ++i) {
      (*y)[i] = cosine * z[2 * i + 1] - sine * z[2 * i] - z[offset()];
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    const double sine = std::sin(Turn(z));
    const double cosine = std::cos(Turn(z));
    J->setZero();
    for (int i = 0; i < num_outputs(); ++i) {
      (*J)(i, 2 * i) = -sine;
      (*J)(i, 2 * i + 1) = cosine;
      (*J)(i, turn()) = -sine * z[2 * i + 1] - cosine * z[2 * i];
      (*J)(i, offset()) = -1;
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const double sine = std::sin(Turn(z));
    const double cosine = std::cos(Turn(z));
    H->setZero();
    for (int i = 0; i < num_outputs(); ++i) {
      const double along_x = -multipliers[i] * cosine;
      const double along_z = -multipliers[i] * sine;
      (*H)(2 * i, turn()) = (*H)(turn(), 2 * i) = along_x;
      (*H)(2 * i + 1, turn()) = (*H)(turn(), 2 * i + 1) = along_z;
      (*H)(turn(), turn()) += multipliers[i] * (sine * z[2 * i] - cosine * z[2 * i + 1]);
    }
  }

  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), false);
    for (int i = 0; i < num_outputs(); ++i) {
      mask(i, 2 * i) = mask(i, 2 * i + 1) = mask(i, turn()) = mask(i, offset()) = true;
    }
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), false);
    for (int i = 0; i <= turn(); ++i) mask(i, turn()) = mask(turn(), i) = true;
    return mask;
  }

 private:
  int turn() const { return num_inputs() - 2; }
  int offset() const { return num_inputs() - 1; }
  double Turn(const VectorXd& z) const { return z[turn()]; }
};

}  // namespace

std::shared_ptr<Function> HeightsOverTurningPlane(
    const RobotSystem& model, const std::vector<dynamics::ContactPoint>& points) {
  std::vector<PointComponent> components;
  for (const dynamics::ContactPoint& point : points) {
    components.push_back({point, Eigen::Vector3d::UnitX()});
    components.push_back({point, Eigen::Vector3d::UnitZ()});
  }
  return Composition(
      std::make_shared<OverTurningPlane>(static_cast<int>(points.size())),
      Stacked(PointPositions(model, components), LinearMap(Eigen::Matrix2d::Identity())));
}

}  // namespace possibility::collocation
