#include "actions/motion/free_flight.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd Configuration(const Quaterniond& R, const Vector3d& position, const VectorXd& joints) {
  VectorXd q(7 + joints.size());
  q << R.w(), R.vec(), position, joints;
  return q;
}

/// Time derivative of a unit quaternion's coefficients at an angular velocity in world axes.
Quaterniond Rate(const Vector3d& angular_velocity, const Quaterniond& R) {
  Quaterniond rate =
      Quaterniond(0, angular_velocity.x(), angular_velocity.y(), angular_velocity.z()) * R;
  rate.coeffs() *= 0.5;
  return rate;
}

Quaterniond Moved(const Quaterniond& R, double step, const Quaterniond& rate) {
  Quaterniond moved;
  moved.coeffs() = R.coeffs() + step * rate.coeffs();
  return moved.normalized();
}

}  // namespace

FreeFlight::FreeFlight(std::shared_ptr<const dynamics::MultibodyModel> model)
    : dynamics_(std::move(model)),
      kinematics_(dynamics_.model().tree()),
      mass_(dynamics_.model().tree().TotalMass()) {}

void FreeFlight::TakeOff(const VectorXd& q, const VectorXd& v) {
  dynamics_.SetState(q, v);
  const dynamics::CentroidalQuantities& centroidal = dynamics_.Centroidal();
  orientation_ = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  position_ = centroidal.position;
  momentum_ = centroidal.momentum.head<3>();
  velocity_ = centroidal.momentum.tail<3>() / mass_;
}

std::vector<Knot> FreeFlight::Fly(const JointMotion& joints, double duration, int intervals) {
  std::vector<Knot> knots;
  Integrate(joints, duration, intervals,
            [&](const Quaterniond& R, double t) { knots.push_back(KnotAt(R, t, joints)); });
  return knots;
}

Knot FreeFlight::Land(const JointMotion& joints, double duration, int intervals) {
  Quaterniond last = orientation_;
  Integrate(joints, duration, intervals, [&](const Quaterniond& R, double) { last = R; });
  return KnotAt(last, duration, joints);
}

void FreeFlight::Integrate(const JointMotion& joints, double duration, int intervals,
                           const std::function<void(const Quaterniond& R, double t)>& visit) {
  const double step = duration / intervals;
  Quaterniond R = orientation_;
  JointsShare begin = ShareOf(joints(0));
  visit(R, 0);
  for (int i = 0; i < intervals; ++i) {
    const JointsShare middle = ShareOf(joints(i * step + step / 2));
    const JointsShare end = ShareOf(joints(i * step + step));
    R = Advance(R, step, begin, middle, end);
    begin = end;
    visit(R, i + 1 < intervals ? (i + 1) * step : duration);
  }
}

Quaterniond FreeFlight::Advance(const Quaterniond& R, double step, const JointsShare& begin,
                                const JointsShare& middle, const JointsShare& end) const {
  const Quaterniond k1 = Rate(AngularVelocity(R, begin), R);
  const Quaterniond R2 = Moved(R, step / 2, k1);
  const Quaterniond k2 = Rate(AngularVelocity(R2, middle), R2);
  const Quaterniond R3 = Moved(R, step / 2, k2);
  const Quaterniond k3 = Rate(AngularVelocity(R3, middle), R3);
  const Quaterniond R4 = Moved(R, step, k3);
  const Quaterniond k4 = Rate(AngularVelocity(R4, end), R4);
  Quaterniond mean;
  mean.coeffs() = (k1.coeffs() + 2 * k2.coeffs() + 2 * k3.coeffs() + k4.coeffs()) / 6;
  return Moved(R, step, mean);
}

FreeFlight::JointsShare FreeFlight::ShareOf(const Signal<VectorXd>& joints) {
  VectorXd velocity = VectorXd::Zero(6 + joints.rate.size());
  velocity.tail(joints.rate.size()) = joints.rate;
  const dynamics::MultibodyModel& model = dynamics_.model();
  kinematics_.SetPosition(model.TreeConfiguration(
      Configuration(Quaterniond::Identity(), Vector3d::Zero(), joints.value)));
  kinematics_.SetVelocity(model.TreeVelocity(velocity));
  const Vector3d centre = kinematics_.CentreOfMass();
  const std::vector<models::Link>& links = model.tree().links;
  JointsShare share{Matrix3d::Zero(), Vector3d::Zero()};
  for (std::size_t i = 0; i < links.size(); ++i) {
    const models::Inertial& inertial = links[i].inertial;
    const int link = static_cast<int>(i);
    const Matrix3d& R = kinematics_.X_WL()[i].linear();
    const Matrix3d inertia = R * inertial.I_LC * R.transpose();
    const Vector3d arm = kinematics_.Position(link, inertial.p_LC) - centre;
    share.inertia += inertia + inertial.mass * (arm.squaredNorm() * Matrix3d::Identity() -
                                                arm * arm.transpose());
    share.momentum += inertia * kinematics_.AngularVelocity(link) +
                      inertial.mass * arm.cross(kinematics_.Velocity(link, inertial.p_LC));
  }
  return share;
}

Vector3d FreeFlight::AngularVelocity(const Quaterniond& R, const JointsShare& share) const {
  const Vector3d momentum = R.conjugate() * momentum_ - share.momentum;
  return R * (share.inertia.inverse() * momentum);
}

Knot FreeFlight::KnotAt(const Quaterniond& R, double t, const JointMotion& joints) {
  const Signal<VectorXd> motion = joints(t);
  const Eigen::Index n = motion.value.size();
  Knot knot;
  knot.t = t;
  knot.v.setZero(6 + n);
  knot.v.tail(n) = motion.rate;
  knot.v.head<3>() = AngularVelocity(R, ShareOf(motion));
  knot.q = Configuration(R, Vector3d::Zero(), motion.value);
  dynamics_.SetState(knot.q, knot.v);
  const dynamics::CentroidalQuantities& centroidal = dynamics_.Centroidal();
  const Vector3d gravity(0, 0, -dynamics::kGravity);
  knot.q.segment<3>(4) = position_ + t * velocity_ + t * t / 2 * gravity - centroidal.position;
  knot.v.segment<3>(3) = velocity_ + t * gravity - centroidal.momentum.tail<3>() / mass_;

  knot.a.setZero(6 + n);
  knot.a.tail(n) = motion.acceleration;
  dynamics_.SetState(knot.q, knot.v, knot.a);
  const Eigen::Matrix<double, 6, 6> inertia = dynamics_.MassMatrix().topLeftCorner<6, 6>();
  const Eigen::Matrix<double, 6, 1> unbalanced = dynamics_.InverseDynamics().head<6>();
  knot.a.head<6>() = -inertia.llt().solve(unbalanced);
  dynamics_.SetAcceleration(knot.a);
  knot.tau = dynamics_.InverseDynamics().tail(n);
  knot.forces.resize(3, 0);
  return knot;
}

}  // namespace possibility::actions
