#include "collocation/robot/swing_clearance.h"

#include <cmath>

#include "collocation/problem/function_algebra.h"
#include "collocation/problem/jet.h"
#include "collocation/robot/point_functions.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kEdge = 0.15;   // of the way, on which a step is climbed
constexpr double kLevel = 1e-4;  // m: places closer in height are on the level
constexpr double kNoWay = 0.02;  // m: places closer in the horizontal are above each other

/// One point of the patch.
struct Way {
  double low = 0;     ///< m, height where it begins
  double rise = 0;    ///< m
  double start = 0;   ///< m, along the way
  double length = 0;  ///< m; 0: by time
};

/// The C2 step from 0 at s = 0 to 1 at s = 1.
template <typename Scalar>
Scalar SmoothStepAt(const Scalar& s) {
  if (s < 0.0) return Scalar(0);
  if (s > 1.0) return Scalar(1);
  return s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
}

/// Vanishes at both ends faster than any lift-off.
template <typename Scalar>
Scalar Hill(const Scalar& s) {
  if (s < 0.0 || s > 1.0) return Scalar(0);
  const Scalar slope = 4.0 * s * (1.0 - s);
  return slope * slope * slope;
}

/// Heights less the floor. Inputs: by point its coordinate along the way and its height; last, the
/// share of the phase.
class AboveFloor : public Function {
 public:
  AboveFloor(std::vector<Way> ways, const SwingShape& shape)
      : Function(static_cast<int>(2 * ways.size()) + 1, static_cast<int>(ways.size())),
        ways_(std::move(ways)),
        shape_(shape) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    for (int i = 0; i < num_outputs(); ++i) {
      (*y)[i] = z[2 * i + 1] - Floor<double>(ways_[i], z[2 * i], z[z.size() - 1]);
    }
  }

  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    J->setZero();
    for (int i = 0; i < num_outputs(); ++i) {
      const auto floor = FloorJet<1>(i, z);
      (*J)(i, 2 * i) = -floor.gradient[0];
      (*J)(i, 2 * i + 1) = 1;
      (*J)(i, num_inputs() - 1) = -floor.gradient[1];
    }
  }

  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    H->setZero();
    const int share = num_inputs() - 1;
    for (int i = 0; i < num_outputs(); ++i) {
      const auto floor = FloorJet<2>(i, z);
      (*H)(2 * i, 2 * i) -= multipliers[i] * floor.hessian(0, 0);
      (*H)(2 * i, share) -= multipliers[i] * floor.hessian(0, 1);
      (*H)(share, 2 * i) -= multipliers[i] * floor.hessian(1, 0);
      (*H)(share, share) -= multipliers[i] * floor.hessian(1, 1);
    }
  }

  Mask JacobianMask() const override {
    Mask mask = Mask::Constant(num_outputs(), num_inputs(), false);
    for (int i = 0; i < num_outputs(); ++i) {
      mask(i, 2 * i) = ways_[i].length > 0;
      mask(i, 2 * i + 1) = true;
      mask(i, num_inputs() - 1) = ways_[i].length == 0;
    }
    return mask;
  }

  Mask HessianMask() const override {
    Mask mask = Mask::Constant(num_inputs(), num_inputs(), false);
    for (int i = 0; i < num_outputs(); ++i) {
      const int argument = ways_[i].length > 0 ? 2 * i : num_inputs() - 1;
      mask(argument, argument) = true;
    }
    return mask;
  }

 private:
  template <int Order>
  Jet<2, Order> FloorJet(int i, const VectorXd& z) const {
    using Scalar = Jet<2, Order>;
    return Floor<Scalar>(ways_[i], Scalar::Input(z[2 * i], 0), Scalar::Input(z[z.size() - 1], 1));
  }

  template <typename Scalar>
  Scalar Floor(const Way& way, const Scalar& along, const Scalar& share) const {
    if (way.length == 0) {
      const Scalar s = shape_.begin + (shape_.end - shape_.begin) * share;
      return way.low + way.rise * s + shape_.clearance * Hill(s);
    }
    const Scalar s = (along - way.start) / way.length;
    const Scalar step =
        way.rise > 0 ? SmoothStepAt(s / kEdge) : SmoothStepAt((s - (1 - kEdge)) / kEdge);
    return way.low + way.rise * step + shape_.clearance * Hill(s);
  }

  std::vector<Way> ways_;
  SwingShape shape_;
};

}  // namespace

std::shared_ptr<Function> SwingClearance(const RobotSystem& model, const PlacedPatch& from,
                                         const PlacedPatch& to, const SwingShape& shape) {
  std::vector<Way> ways;
  std::vector<PointComponent> components;
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    Vector3d across = to.places[i] - from.places[i];
    Way way;
    way.low = from.places[i].z();
    way.rise = across.z();
    across.z() = 0;
    const double length = across.norm();
    const bool by_time = std::abs(way.rise) < kLevel || length < kNoWay;
    const Vector3d along = by_time ? Vector3d::UnitX() : Vector3d(across / length);
    way.length = by_time ? 0 : length;
    way.start = along.dot(from.places[i]);
    ways.push_back(way);
    components.push_back({from.points[i], along});
    components.push_back({from.points[i], Vector3d::UnitZ()});
  }
  const auto share = FunctionOf([](auto s) { return s; });
  return Composition(std::make_shared<AboveFloor>(ways, shape),
                     Stacked(PointPositions(model, components), share));
}

}  // namespace possibility::collocation
