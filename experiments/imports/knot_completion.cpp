#include "experiments/imports/knot_completion.h"

#include <Eigen/QR>
#include <Eigen/SVD>

#include "actions/wholebody/motion_builder.h"
#include "dynamics/contact/contact_feasibility.h"
#include "dynamics/contact/contact_forces.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::experiments {
namespace {

using dynamics::ContactPoint;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Singular values that are smaller, relative to the largest, are rounding.
constexpr double kRank = 1e-9;

/// Reserves of forces, tried one after the other: shares of friction and effort, and the least
/// load of a point as a share of the weight. Between knots the forces need a little more.
struct ForceReserve {
  double friction;
  double torque;
  double load;
  int edges;
};
constexpr ForceReserve kForceReserves[] = {
    {0.85, 0.95, 0.01, 16}, {0.95, 0.98, 0.001, 16}, {1, 1, 0, 32}};

/// The x of least norm with rows x = right, or nearest to it.
template <typename Rows, typename Right>
VectorXd LeastNorm(const Rows& rows, const Right& right) {
  if (rows.size() == 0) return VectorXd::Zero(rows.cols());
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
  decomposition.setThreshold(kRank);
  decomposition.compute(rows);
  return decomposition.solve(right);
}

/// Orthonormal columns of the wrenches that no forces supply.
MatrixXd MissingWrenches(const MatrixXd& wrench_map) {
  if (wrench_map.cols() == 0) return MatrixXd::Identity(6, 6);
  Eigen::JacobiSVD<MatrixXd> svd(wrench_map, Eigen::ComputeFullU);
  svd.setThreshold(kRank);
  return svd.matrixU().rightCols(6 - svd.rank());
}

}  // namespace

KnotCompletion::KnotCompletion(const models::RobotModel& robot)
    : robot_(&robot), dynamics_(actions::UncoupledModel(robot)) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    if (robot.joints[j].mimic) mimics_.push_back(j);
  }
}

MatrixXd KnotCompletion::HeldRows(const std::vector<ContactPoint>& points) {
  const auto num_points = static_cast<Index>(points.size());
  const auto num_mimics = static_cast<Index>(mimics_.size());
  MatrixXd rows = MatrixXd::Zero(3 * num_points + num_mimics, robot_->nv());
  for (Index i = 0; i < num_points; ++i) {
    dynamics_.Jacobian(points[i], rows.middleRows<3>(3 * i));
  }
  for (Index i = 0; i < num_mimics; ++i) {
    const models::Mimic& mimic = *robot_->joints[mimics_[i]].mimic;
    rows(3 * num_points + i, 6 + mimics_[i]) = 1;
    rows(3 * num_points + i, 6 + mimic.joint) = -mimic.multiplier;
  }
  return rows;
}

VectorXd KnotCompletion::Resting(const VectorXd& q, const VectorXd& v,
                                 const std::vector<ContactPoint>& points) {
  dynamics_.SetState(q, v);
  const MatrixXd rows = HeldRows(points);
  return v - LeastNorm(rows, rows * v);
}

MatrixXd KnotCompletion::WrenchMap(const std::vector<ContactPoint>& points) const {
  MatrixXd map(6, 3 * points.size());
  const Eigen::Vector3d root = dynamics_.kinematics().X_WL()[0].translation();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d arm = dynamics_.Position(points[i]) - root;
    const auto column = static_cast<Index>(3 * i);
    map.block<3, 3>(0, column) << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    map.block<3, 3>(3, column).setIdentity();
  }
  return map;
}

VectorXd KnotCompletion::Feasible(const VectorXd& q, const VectorXd& v, const VectorXd& a,
                                  const std::vector<ContactPoint>& points) {
  dynamics_.SetState(q, v, a);
  const MatrixXd held = HeldRows(points);
  const MatrixXd missing = MissingWrenches(WrenchMap(points));
  MatrixXd rows(held.rows() + missing.cols(), held.cols());
  rows << held, missing.transpose() * dynamics_.MassMatrix().topRows<6>();
  VectorXd wrong = VectorXd::Zero(rows.rows());
  for (std::size_t i = 0; i < points.size(); ++i) {
    wrong.segment<3>(static_cast<Index>(3 * i)) = dynamics_.Acceleration(points[i]);
  }
  const auto num_mimics = static_cast<Index>(mimics_.size());
  wrong.segment(held.rows() - num_mimics, num_mimics) = held.bottomRows(num_mimics) * a;
  wrong.tail(missing.cols()) = missing.transpose() * dynamics_.InverseDynamics().head<6>();
  return a - LeastNorm(rows, wrong);
}

void KnotCompletion::SetForces(const std::vector<ContactPoint>& points,
                               const std::vector<double>& shares, actions::Knot* knot) {
  dynamics_.SetState(knot->q, knot->v, knot->a);
  const double weight = robot_->TotalMass() * dynamics::kGravity;
  for (const ForceReserve& reserve : kForceReserves) {
    dynamics::ContactForceSettings settings;
    settings.friction = robot_->friction;
    settings.friction_margin = reserve.friction;
    settings.torque_margin = reserve.torque;
    settings.normal_reserve = reserve.load * weight;
    settings.cone_edges = reserve.edges;
    settings.shares = shares;
    const auto forces = dynamics::DistributeContactForces(&dynamics_, points, settings);
    if (!forces) continue;
    knot->forces = forces->forces;
    knot->tau = forces->torques;
    return;
  }
  const VectorXd forces = LeastNorm(WrenchMap(points), dynamics_.InverseDynamics().head<6>());
  knot->forces = forces.reshaped(3, static_cast<Index>(points.size()));
  SetTorques(points, knot);
}

void KnotCompletion::SetTorques(const std::vector<ContactPoint>& points, actions::Knot* knot) {
  VectorXd given = VectorXd::Zero(robot_->nv());
  for (std::size_t i = 0; i < points.size(); ++i) {
    dynamics_.AddPointForce(points[i], knot->forces.col(static_cast<Index>(i)), given);
  }
  knot->tau = (dynamics_.InverseDynamics() - given).tail(robot_->num_joints());
}

Eigen::Matrix3Xd KnotCompletion::Impulses(const VectorXd& q, const VectorXd& before,
                                          const VectorXd& after,
                                          const std::vector<ContactPoint>& points) {
  dynamics_.SetState(q, after);
  MatrixXd jacobian(3 * points.size(), robot_->nv());
  for (std::size_t i = 0; i < points.size(); ++i) {
    dynamics_.Jacobian(points[i], jacobian.middleRows<3>(static_cast<Index>(3 * i)));
  }
  const VectorXd change = dynamics_.MassMatrix() * (after - before);
  const Eigen::Matrix3Xd impulses =
      LeastNorm(jacobian.transpose(), change).reshaped(3, static_cast<Index>(points.size()));
  return dynamics::CheckImpulses(jacobian, impulses, points, robot_->friction).impulses;
}

KnotCompletion::Landing KnotCompletion::Land(const VectorXd& q, const VectorXd& before,
                                             const std::vector<ContactPoint>& points) {
  // The velocity of least change in the metric of the mass matrix (Moreau 1988).
  dynamics_.SetState(q, before);
  const MatrixXd rows = HeldRows(points);
  const Eigen::LLT<MatrixXd> mass(dynamics_.MassMatrix());
  const MatrixXd half = mass.matrixL().solve(rows.transpose());  // L^-1 J'
  VectorXd change = LeastNorm(half.transpose(), VectorXd(-rows * before));
  mass.matrixU().solveInPlace(change);
  Landing landing;
  landing.velocity = before + change;
  landing.impulses = Impulses(q, before, landing.velocity, points);
  return landing;
}

}  // namespace possibility::experiments
