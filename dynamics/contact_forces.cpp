#include "dynamics/contact_forces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "dynamics/quadratic_program.h"

namespace possibility::dynamics {

namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kConeEdges = 8;
// Limits are drawn in by this, so that rounding cannot carry a force over the true one.
constexpr double kInside = 1 - 1e-9;
// Weight of the torques (as fractions of their limits) beside the forces (as fractions of an
// equal share of the weight): small, so that the load is shared first.
constexpr double kTorqueWeight = 0.01;
// Base wrench left over, as a fraction of the weight (times a metre).
constexpr double kResidual = 1e-11;

void CheckArguments(const TreeKinematics& kinematics, const Eigen::Ref<const VectorXd>& a,
                    const std::vector<ContactPoint>& points, const ContactForceSettings& settings) {
  if (!a.allFinite()) {
    throw std::invalid_argument("DistributeContactForces: an acceleration is not finite");
  }
  for (const double setting : {settings.friction, settings.friction_margin, settings.torque_margin,
                               settings.normal_reserve}) {
    if (!(setting >= 0 && std::isfinite(setting))) {
      throw std::invalid_argument(
          "DistributeContactForces: settings must be finite and not negative");
    }
  }
  for (const ContactPoint& point : points) {
    if (point.link < 0 || point.link >= kinematics.model().num_links()) {
      throw std::invalid_argument("DistributeContactForces: a contact point names no link");
    }
  }
}

/// The joints that carry the load of some point, ascending.
std::vector<int> LoadedJoints(const TreeKinematics& kinematics,
                              const std::vector<ContactPoint>& points) {
  std::vector<int> joints;
  for (const ContactPoint& point : points) {
    const std::vector<int>& support = kinematics.SupportingJoints(point.link);
    joints.insert(joints.end(), support.begin(), support.end());
  }
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  return joints;
}

/// The problem as a quadratic program in forces as fractions of `unit` (N). Generalised forces
/// divided by `unit`: required_ - loads_' x must vanish in the six base rows and keep within
/// limits_ in the joint rows.
class ForceProblem {
 public:
  ForceProblem(TreeKinematics* kinematics, const Eigen::Ref<const VectorXd>& a,
               const std::vector<ContactPoint>& points, const ContactForceSettings& settings)
      : model_(kinematics->model()),
        settings_(settings),
        joints_(LoadedJoints(*kinematics, points)) {
    const int n = 3 * static_cast<int>(points.size());
    unit_ = kinematics->total_mass() * kGravity / std::max<double>(1, points.size());
    if (!(unit_ > 0)) unit_ = 1;
    kinematics->InverseDynamics(a, &required_);
    required_ /= unit_;
    MatrixXd J(3, model_.nv());
    base_loads_.resize(6, n);
    joint_loads_.resize(joints_.size(), n);
    for (int i = 0; i < n / 3; ++i) {
      kinematics->PointJacobian(points[i].link, points[i].p_L, J);
      base_loads_.middleCols<3>(3 * i) = J.leftCols<6>().transpose();
      for (std::size_t k = 0; k < joints_.size(); ++k) {
        joint_loads_.block<1, 3>(k, 3 * i) = J.col(6 + joints_[k]).transpose();
      }
    }
  }

  std::optional<ContactForces> Solution() const {
    if (!UnloadedJointsWithinLimits()) return std::nullopt;
    VectorXd x = VectorXd::Zero(base_loads_.cols());
    if (x.size() > 0) {
      const QuadraticProgramSolution solution = Solve(Program());
      if (solution.status != QuadraticProgramStatus::kSolved) return std::nullopt;
      x = solution.x;
      MoveIntoCones(&x);
    }
    const double residual = (required_.head<6>() - base_loads_ * x).cwiseAbs().maxCoeff();
    if (residual > kResidual * std::max(1.0, required_.head<6>().norm())) return std::nullopt;
    ContactForces result = Evaluate(x);
    if (result.torque_utilisation > settings_.torque_margin) return std::nullopt;
    return result;
  }

 private:
  double Limit(int joint) const {
    return model_.joints[joint].effort * settings_.torque_margin * kInside / unit_;
  }

  bool UnloadedJointsWithinLimits() const {
    std::size_t next = 0;
    for (int joint = 0; joint < model_.num_joints(); ++joint) {
      if (next < joints_.size() && joints_[next] == joint) {
        ++next;
      } else if (std::abs(required_[6 + joint]) > Limit(joint)) {
        return false;
      }
    }
    return true;
  }

  QuadraticProgram Program() const {
    QuadraticProgram program;
    WriteCost(&program);
    program.E = base_loads_;
    program.e = required_.head<6>();
    const int n = static_cast<int>(base_loads_.cols());
    const int cone_rows = n / 3 * kConeEdges;
    const int bounded =
        static_cast<int>(std::count_if(joints_.begin(), joints_.end(), [this](int joint) {
          return std::isfinite(model_.joints[joint].effort);
        }));
    program.C.setZero(cone_rows + 2 * bounded, n);
    program.d.setZero(cone_rows + 2 * bounded);
    const int row = WriteCones(&program);
    WriteTorqueLimits(row, &program);
    return program;
  }

  void WriteCost(QuadraticProgram* program) const {
    const Eigen::Index n = base_loads_.cols();
    VectorXd weights(joints_.size());
    VectorXd torques(joints_.size());
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const double limit = Limit(joints_[k]);
      weights[k] = limit > 0 && std::isfinite(limit) ? kTorqueWeight / (limit * limit) : 0;
      torques[k] = required_[6 + joints_[k]];
    }
    const MatrixXd weighted = weights.asDiagonal() * joint_loads_;
    program->H.noalias() = joint_loads_.transpose() * weighted;
    program->H += MatrixXd::Identity(n, n);
    program->g.noalias() = -(weighted.transpose() * torques);
  }

  /// A regular octagon inscribed in the circle of radius friction * (normal force - reserve): eight
  /// half planes at cos(pi / 8) of the radius. Together they imply a normal force >= the reserve.
  int WriteCones(QuadraticProgram* program) const {
    const double slope = settings_.friction * settings_.friction_margin * kInside *
                         std::cos(std::numbers::pi / kConeEdges);
    int row = 0;
    for (Eigen::Index i = 0; i < base_loads_.cols(); i += 3) {
      for (int edge = 0; edge < kConeEdges; ++edge, ++row) {
        const double angle = 2 * std::numbers::pi * edge / kConeEdges;
        program->C.block<1, 3>(row, i) << std::cos(angle), std::sin(angle), -slope;
        program->d[row] = -slope * settings_.normal_reserve / unit_;
      }
    }
    return row;
  }

  void WriteTorqueLimits(int row, QuadraticProgram* program) const {
    for (std::size_t k = 0; k < joints_.size(); ++k) {
      const double limit = Limit(joints_[k]);
      if (!std::isfinite(limit)) continue;
      const double torque = required_[6 + joints_[k]];
      program->C.row(row) = -joint_loads_.row(k);
      program->d[row++] = limit - torque;
      program->C.row(row) = joint_loads_.row(k);
      program->d[row++] = limit + torque;
    }
  }

  /// Takes off what rounding put outside the true cones.
  void MoveIntoCones(VectorXd* x) const {
    const double slope = settings_.friction * settings_.friction_margin * kInside;
    for (Eigen::Index i = 0; i < x->size(); i += 3) {
      const double reserve = settings_.normal_reserve / unit_;
      const double normal = std::max(0.0, (*x)[i + 2] - reserve);
      const double tangential = x->segment<2>(i).norm();
      if (tangential > slope * normal) x->segment<2>(i) *= slope * normal / tangential;
      (*x)[i + 2] = normal + reserve;
    }
  }

  ContactForces Evaluate(const VectorXd& x) const {
    ContactForces result;
    result.forces = unit_ * Eigen::Map<const Eigen::Matrix3Xd>(x.data(), 3, x.size() / 3);
    result.torques = unit_ * required_.tail(model_.num_joints());
    const VectorXd loads = unit_ * (joint_loads_ * x);
    for (std::size_t k = 0; k < joints_.size(); ++k) result.torques[joints_[k]] -= loads[k];
    for (const auto& force : result.forces.colwise()) {
      const double most = settings_.friction * force.z();
      if (most <= 0) continue;
      result.friction_utilisation =
          std::max(result.friction_utilisation, force.head<2>().norm() / most);
    }
    for (int i = 0; i < model_.num_joints(); ++i) {
      if (model_.joints[i].effort <= 0) continue;
      result.torque_utilisation = std::max(result.torque_utilisation,
                                           std::abs(result.torques[i]) / model_.joints[i].effort);
    }
    return result;
  }

  const models::RobotModel& model_;
  const ContactForceSettings& settings_;
  std::vector<int> joints_;
  double unit_ = 1;
  VectorXd required_;
  MatrixXd base_loads_;   // 6 x 3 points
  MatrixXd joint_loads_;  // loaded joints x 3 points
};

}  // namespace

std::optional<ContactForces> DistributeContactForces(TreeKinematics* kinematics,
                                                     const Eigen::Ref<const VectorXd>& a,
                                                     const std::vector<ContactPoint>& points,
                                                     const ContactForceSettings& settings) {
  CheckArguments(*kinematics, a, points, settings);
  return ForceProblem(kinematics, a, points, settings).Solution();
}

}  // namespace possibility::dynamics
