#include "collocation/robot/step_clearance.h"

#include <algorithm>
#include <stdexcept>

#include "collocation/robot/point_functions.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// z - g(x) at points whose x and z another function gives.
class StepClearanceFunction : public Function {
 public:
  StepClearanceFunction(std::shared_ptr<Function> positions, const SmoothStep& step)
      : Function(positions->num_inputs(), positions->num_outputs() / 2),
        positions_(std::move(positions)),
        step_(step),
        p_(2 * num_outputs()),
        J_(2 * num_outputs(), num_inputs()) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    positions_->Evaluate(z, &p_);
    for (int i = 0; i < num_outputs(); ++i) (*y)[i] = p_[2 * i + 1] - step_.Value(p_[2 * i]);
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    positions_->Evaluate(z, &p_);
    positions_->Jacobian(z, &J_);
    for (int i = 0; i < num_outputs(); ++i) {
      J->row(i) = J_.row(2 * i + 1) - step_.Slope(p_[2 * i]) * J_.row(2 * i);
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    positions_->Evaluate(z, &p_);
    positions_->Jacobian(z, &J_);
    VectorXd on_positions(2 * num_outputs());
    for (int i = 0; i < num_outputs(); ++i) {
      on_positions[2 * i] = -multipliers[i] * step_.Slope(p_[2 * i]);
      on_positions[2 * i + 1] = multipliers[i];
    }
    positions_->Hessian(z, on_positions, H);
    for (int i = 0; i < num_outputs(); ++i) {
      const double bend = multipliers[i] * step_.Curvature(p_[2 * i]);
      if (bend != 0) *H -= bend * J_.row(2 * i).transpose() * J_.row(2 * i);
    }
  }

  Mask JacobianMask() const override {
    const Mask positions = positions_->JacobianMask();
    Mask mask(num_outputs(), num_inputs());
    for (int i = 0; i < num_outputs(); ++i) {
      mask.row(i) = positions.row(2 * i) || positions.row(2 * i + 1);
    }
    return mask;
  }

  Mask HessianMask() const override {
    const Mask positions = positions_->JacobianMask();
    Mask mask = positions_->HessianMask();
    // The ground bends along x.
    for (int i = 0; i < num_outputs(); ++i) {
      const Eigen::VectorXd x = positions.row(2 * i).cast<double>().matrix().transpose();
      mask = mask || (x * x.transpose()).array() != 0.0;
    }
    return mask;
  }

 private:
  std::shared_ptr<Function> positions_;
  SmoothStep step_;
  VectorXd p_;
  MatrixXd J_;
};

}  // namespace

double SmoothStep::Value(double x) const {
  const double s = std::clamp((x - begin) / (end - begin), 0.0, 1.0);
  return height * s * s * s * (10 + s * (6 * s - 15));
}

double SmoothStep::Slope(double x) const {
  const double s = std::clamp((x - begin) / (end - begin), 0.0, 1.0);
  return height * 30 * s * s * (1 - s) * (1 - s) / (end - begin);
}

double SmoothStep::Curvature(double x) const {
  const double s = std::clamp((x - begin) / (end - begin), 0.0, 1.0);
  return height * 60 * s * (1 - s) * (1 - 2 * s) / ((end - begin) * (end - begin));
}

std::shared_ptr<Function> StepClearance(const RobotSystem& model,
                                        const std::vector<dynamics::ContactPoint>& points,
                                        const SmoothStep& step) {
  if (!(step.begin < step.end)) {
    throw std::invalid_argument("a step must begin before it ends");
  }
  if (model->base() != dynamics::Base::kPlanar) {
    throw std::invalid_argument("the clearance above a step needs a planar model");
  }
  return std::make_shared<StepClearanceFunction>(PointPositions(model, points), step);
}

}  // namespace possibility::collocation
