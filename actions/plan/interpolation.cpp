#include "actions/plan/interpolation.h"

#include <stdexcept>

#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

using Powers = Eigen::Matrix<double, 6, 1>;

Powers PowersOf(double s) {
  Powers powers;
  powers << 1, s, s * s, s * s * s, s * s * s * s, s * s * s * s * s;
  return powers;
}

/// Derivatives of the powers.
Powers RatesOf(double s) {
  Powers rates;
  rates << 0, 1, 2 * s, 3 * s * s, 4 * s * s * s, 5 * s * s * s * s;
  return rates;
}

Quaterniond RootOrientation(const VectorXd& q) {
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

void CheckAgreement(const Knot& k0, const Knot& k1) {
  if (k0.q.size() < 7 || k0.v.size() != k0.q.size() - 1 || k0.a.size() != k0.v.size() ||
      k1.q.size() != k0.q.size() || k1.v.size() != k0.v.size() || k1.a.size() != k0.a.size() ||
      k1.tau.size() != k0.tau.size() || k1.forces.cols() != k0.forces.cols()) {
    throw std::invalid_argument("knots of different sizes cannot be interpolated");
  }
  if (!(k1.t > k0.t)) throw std::invalid_argument("knots must be increasing in time");
}

/// Coefficients of powers of s: the first three columns from the start, the others from the end
/// conditions.
template <typename Rows>
void SetQuintic(const VectorXd& change, const VectorXd& v0, const VectorXd& v1, const VectorXd& a0,
                const VectorXd& a1, Rows c) {
  c.col(1) = v0;
  c.col(2) = a0 / 2;
  c.col(3) = 10 * change - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
  c.col(4) = -15 * change + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
  c.col(5) = 6 * change - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
}

}  // namespace

KnotInterpolant::KnotInterpolant(const Knot& k0, const Knot& k1)
    : k0_(&k0), k1_(&k1), h_(k1.t - k0.t) {
  CheckAgreement(k0, k1);
  R0_ = RootOrientation(k0.q);
  const Vector3d phi1 = models::RotationVector(RootOrientation(k1.q) * R0_.conjugate());
  const Matrix3d inverse = models::LeftJacobian(phi1).inverse();
  const Vector3d phi1_rate = inverse * k1.v.head<3>();
  const Vector3d phi1_acceleration =
      inverse * (k1.a.head<3>() - models::LeftJacobianRate(phi1, phi1_rate) * phi1_rate);

  const Eigen::Index n = k0.v.size();
  c_.resize(n, 6);
  c_.col(0) << Vector3d::Zero(), k0.q.tail(n - 3);
  // At phi = 0 the Jacobian is the identity and its rate along omega maps omega to zero.
  SetQuintic(phi1, h_ * k0.v.head<3>(), h_ * phi1_rate, h_ * h_ * k0.a.head<3>(),
             h_ * h_ * phi1_acceleration, c_.topRows<3>());
  SetQuintic(k1.q.tail(n - 3) - k0.q.tail(n - 3), h_ * k0.v.tail(n - 3), h_ * k1.v.tail(n - 3),
             h_ * h_ * k0.a.tail(n - 3), h_ * h_ * k1.a.tail(n - 3), c_.bottomRows(n - 3));
}

Knot KnotInterpolant::At(double t) const {
  if (t <= k0_->t) return *k0_;
  if (t >= k1_->t) return *k1_;
  const double s = (t - k0_->t) / h_;
  const Powers rate = RatesOf(s);
  Powers acceleration;
  acceleration << 0, 0, 2, 6 * s, 12 * s * s, 20 * s * s * s;

  const VectorXd x = c_ * PowersOf(s);
  const Vector3d phi = x.head<3>();
  Knot knot;
  knot.t = t;
  knot.v = c_ * (rate / h_);
  knot.a = c_ * (acceleration / (h_ * h_));
  const Matrix3d jacobian = models::LeftJacobian(phi);
  const Vector3d phi_rate = knot.v.head<3>();
  knot.v.head<3>() = jacobian * phi_rate;
  knot.a.head<3>() =
      (jacobian * knot.a.head<3>() + models::LeftJacobianRate(phi, phi_rate) * phi_rate).eval();
  knot.q = Configuration(x);
  knot.tau = (1 - s) * k0_->tau + s * k1_->tau;
  knot.forces = (1 - s) * k0_->forces + s * k1_->forces;
  return knot;
}

void KnotInterpolant::JointsAt(double t, VectorXd* position, VectorXd* velocity,
                               VectorXd* torque) const {
  const Eigen::Index n = c_.rows() - 6;
  if (t <= k0_->t || t >= k1_->t) {
    const Knot& knot = t <= k0_->t ? *k0_ : *k1_;
    *position = knot.q.tail(n);
    *velocity = knot.v.tail(n);
    *torque = knot.tau;
    return;
  }
  const double s = (t - k0_->t) / h_;
  position->noalias() = c_.bottomRows(n) * PowersOf(s);
  velocity->noalias() = c_.bottomRows(n) * (RatesOf(s) / h_);
  *torque = (1 - s) * k0_->tau + s * k1_->tau;
}

VectorXd KnotInterpolant::ConfigurationAt(double t) const {
  if (t <= k0_->t) return k0_->q;
  if (t >= k1_->t) return k1_->q;
  return Configuration(c_ * PowersOf((t - k0_->t) / h_));
}

/// `x`: rotation vector from the first knot, root position, joints.
VectorXd KnotInterpolant::Configuration(const VectorXd& x) const {
  const Quaterniond R = models::Exponential(x.head<3>()) * R0_;
  VectorXd q(x.size() + 1);
  q << R.w(), R.vec(), x.tail(x.size() - 3);
  return q;
}

KnotInterpolant::Coefficients KnotInterpolant::ControlPoints() const {
  // s^i is the sum over j of binomial(j, i) / binomial(5, i) times the j-th Bernstein polynomial.
  static const Eigen::Matrix<double, 6, 6> kBernsteinOfPowers = [] {
    Eigen::Matrix<double, 6, 6> matrix;
    for (int i = 0; i < 6; ++i) {
      double entry = 1;  // binomial(j, i) / binomial(5, i), from j = 5 downwards
      for (int j = 5; j >= 0; --j) {
        matrix(i, j) = entry;
        if (j > 0) entry *= static_cast<double>(j - i) / j;
      }
    }
    return matrix;
  }();
  return c_ * kBernsteinOfPowers;
}

Knot Interpolate(const Knot& k0, const Knot& k1, double t) { return KnotInterpolant(k0, k1).At(t); }

}  // namespace possibility::actions
