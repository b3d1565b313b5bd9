#include "actions/evidence/derivative_bounds.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "actions/evidence/bounded_maximum.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

/// The derivatives of exp(x) at x = 0, from those of x: the complete Bell polynomials. Applied to
/// the derivatives of a rotation vector phi they bound those of the rotation, since |D^m
/// exp([phi])(h, ..., h)| <= |h|^m for skew matrices (Duhamel's formula: integrals of products of m
/// factors [h] and of rotations).
Derivatives ExponentialOf(const Derivatives& x) {
  const double x1_squared = x[1] * x[1];
  return {1, x[1], x[2] + x1_squared, x[3] + x[1] * (3 * x[2] + x1_squared),
          x[4] + 4 * x[1] * x[3] + 3 * x[2] * x[2] + x1_squared * (6 * x[2] + x1_squared)};
}

/// Derivatives of a product, by Leibniz's rule.
Derivatives Product(const Derivatives& x, const Derivatives& y) {
  return {x[0] * y[0], x[1] * y[0] + x[0] * y[1], x[2] * y[0] + 2 * x[1] * y[1] + x[0] * y[2],
          x[3] * y[0] + 3 * (x[2] * y[1] + x[1] * y[2]) + x[0] * y[3],
          x[4] * y[0] + 4 * (x[3] * y[1] + x[1] * y[3]) + 6 * x[2] * y[2] + x[0] * y[4]};
}

Derivatives Scaled(double factor, Derivatives x) {
  for (double& entry : x) entry *= factor;
  return x;
}

void Add(const Derivatives& x, Derivatives* sum) {
  for (std::size_t k = 0; k < x.size(); ++k) (*sum)[k] += x[k];
}

/// Adds the value and two derivatives of a product.
template <typename X, typename Y>
void AddProduct(const X& x, const Y& y, std::array<double, 3>* sum) {
  (*sum)[0] += x[0] * y[0];
  (*sum)[1] += x[1] * y[0] + x[0] * y[1];
  (*sum)[2] += x[2] * y[0] + 2 * x[1] * y[1] + x[0] * y[2];
}

/// Bounds of the rate of the angular momentum R I R' omega of a body, and of its first two
/// derivatives; x bounds the derivatives of the rotation vector. omega is at most the derivative of
/// exp(x), so the momentum is at most spin times exp(3 x)' / 3.
std::array<double, 3> SpinRate(double spin, const Derivatives& x) {
  const Derivatives cube = ExponentialOf(Scaled(3, x));
  return {spin / 3 * cube[2], spin / 3 * cube[3], spin / 3 * cube[4]};
}

/// Bound of the second time derivative of what an actuator adds to the torque, and of the torque
/// that its line leaves; x bounds the joint's position and its derivatives.
double ActuatorChange(const models::Actuator& actuator, const Derivatives& x) {
  const double line =
      actuator.line ? actuator.line->stall_torque / actuator.line->no_load_speed : 0;
  return actuator.armature * x[4] + (actuator.FrictionSlope(0) + line) * x[3] +
         actuator.GreatestFrictionCurvature() * x[2] * x[2];
}

template <int Columns>
double GreatestNorm(const Eigen::Matrix<double, 3, Columns>& columns) {
  return std::sqrt(columns.colwise().squaredNorm().maxCoeff());
}

}  // namespace

DerivativeBounds::DerivativeBounds(const models::RobotModel& robot)
    : robot_(&robot), links_(robot.links.size()), torque_change_(robot.joints.size()) {
  for (const models::Link& link : robot.links) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(link.inertial.I_LC,
                                                               Eigen::EigenvaluesOnly);
    spins_.push_back(eigen.eigenvalues().cwiseAbs().maxCoeff());
  }
}

void DerivativeBounds::Set(const KnotInterpolant& interpolant, const Knot& k0, const Knot& k1,
                           const std::vector<BearingPoint>& points) {
  SetCoordinates(interpolant);
  SetLinks();
  SetForces();
  AddContacts(k0, k1, points);
}

void DerivativeBounds::SetCoordinates(const KnotInterpolant& interpolant) {
  const double h = interpolant.duration();
  const ControlPolygon<Eigen::Dynamic, 6> position{interpolant.ControlPoints()};
  const auto velocity = position.Rate(h);
  const auto acceleration = velocity.Rate(h);
  const auto jerk = acceleration.Rate(h);
  const auto snap = jerk.Rate(h);
  const auto root = [&](int row) {
    return Derivatives{0, GreatestNorm<5>(velocity.points.middleRows<3>(row)),
                       GreatestNorm<4>(acceleration.points.middleRows<3>(row)),
                       GreatestNorm<3>(jerk.points.middleRows<3>(row)),
                       GreatestNorm<2>(snap.points.middleRows<3>(row))};
  };
  links_[0].turning = root(0);
  links_[0].origin = root(3);
  for (int j = 0; j < robot_->num_joints(); ++j) {
    const auto greatest = [&](const auto& polygon) {
      return polygon.points.row(6 + j).cwiseAbs().maxCoeff();
    };
    links_[j + 1].joint = {greatest(position), greatest(velocity), greatest(acceleration),
                           greatest(jerk), greatest(snap)};
  }
}

void DerivativeBounds::SetLinks() {
  links_[0].rotation = ExponentialOf(links_[0].turning);
  for (int j = 0; j < robot_->num_joints(); ++j) {
    const models::Joint& joint = robot_->joints[j];
    const LinkBounds& parent = links_[joint.parent];
    LinkBounds& link = links_[j + 1];
    link.turning = parent.turning;
    Derivatives arm{joint.X_PJ.translation().norm(), 0, 0, 0, 0};
    if (joint.type == models::JointType::kPrismatic) {
      Add(link.joint, &arm);
      link.rotation = parent.rotation;
    } else {
      // Rotation vectors of the factors of a product add up in the exponent.
      Add(link.joint, &link.turning);
      link.rotation = ExponentialOf(link.turning);
    }
    link.arm = Product(parent.rotation, arm);
    link.origin = parent.origin;
    Add(link.arm, &link.origin);
  }
}

void DerivativeBounds::SetForces() {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    const models::Inertial& inertial = robot_->links[i].inertial;
    LinkBounds& link = links_[i];
    const Derivatives arm = Scaled(inertial.p_LC.norm(), link.rotation);
    link.force = {inertial.mass * (link.origin[2] + arm[2] + dynamics::kGravity),
                  inertial.mass * (link.origin[3] + arm[3]),
                  inertial.mass * (link.origin[4] + arm[4])};
    link.moment = SpinRate(spins_[i], link.turning);
    AddProduct(arm, link.force, &link.moment);
  }
  for (int j = robot_->num_joints() - 1; j >= 0; --j) {
    const models::Joint& joint = robot_->joints[j];
    const LinkBounds& link = links_[j + 1];
    LinkBounds& parent = links_[joint.parent];
    for (int k = 0; k < 3; ++k) {
      parent.force[k] += link.force[k];
      parent.moment[k] += link.moment[k];
    }
    AddProduct(link.arm, link.force, &parent.moment);
    // The axis turns with the parent.
    std::array<double, 3> torque{};
    AddProduct(parent.rotation,
               joint.type == models::JointType::kPrismatic ? link.force : link.moment, &torque);
    torque_change_[j] = torque[2] + ActuatorChange(joint.actuator, link.joint);
  }
  force_change_ = links_[0].force[2];
  moment_change_ = links_[0].moment[2];
}

void DerivativeBounds::AddContacts(const Knot& k0, const Knot& k1,
                                   const std::vector<BearingPoint>& points) {
  point_acceleration_ = 0;
  point_jerk_ = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const BearingPoint& point = points[i];
    const double radius = point.p_L.norm();
    point_acceleration_ = std::max(point_acceleration_, Point(point.link, radius, 2));
    point_jerk_ = std::max(point_jerk_, Point(point.link, radius, 3));
    const double change = (k1.forces.col(i) - k0.forces.col(i)).norm() / (k1.t - k0.t);
    const std::array<double, 3> force = {std::max(k0.forces.col(i).norm(), k1.forces.col(i).norm()),
                                         change, 0};
    // From each link's origin, on the way to the root, to the point.
    Derivatives arm = Scaled(radius, links_[point.link].rotation);
    for (int link = point.link; link > 0; link = robot_->joints[link - 1].parent) {
      const models::Joint& joint = robot_->joints[link - 1];
      const Derivatives& axis = links_[joint.parent].rotation;
      std::array<double, 3> torque{};
      if (joint.type == models::JointType::kPrismatic) {
        AddProduct(axis, force, &torque);
      } else {
        AddProduct(Product(axis, arm), force, &torque);
      }
      torque_change_[link - 1] += torque[2];
      Add(links_[link].arm, &arm);
    }
    std::array<double, 3> moment{};
    AddProduct(arm, force, &moment);
    moment_change_ += moment[2];
  }
}

}  // namespace possibility::actions
