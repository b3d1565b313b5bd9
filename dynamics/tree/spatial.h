#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace possibility::dynamics {

// Small fixed-size algebra for the innermost loops, written out element by element so that it stays
// in registers. Eigen's vectorised expressions would go through memory.

[[gnu::always_inline]] inline Eigen::Vector3d Cross(const Eigen::Vector3d& a,
                                                    const Eigen::Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

[[gnu::always_inline]] inline double Dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A x.
[[gnu::always_inline]] inline Eigen::Vector3d Times(const Eigen::Matrix3d& A,
                                                    const Eigen::Vector3d& x) {
  return {A(0, 0) * x[0] + A(0, 1) * x[1] + A(0, 2) * x[2],
          A(1, 0) * x[0] + A(1, 1) * x[1] + A(1, 2) * x[2],
          A(2, 0) * x[0] + A(2, 1) * x[1] + A(2, 2) * x[2]};
}

/// A' x.
[[gnu::always_inline]] inline Eigen::Vector3d TransposedTimes(const Eigen::Matrix3d& A,
                                                              const Eigen::Vector3d& x) {
  return {A(0, 0) * x[0] + A(1, 0) * x[1] + A(2, 0) * x[2],
          A(0, 1) * x[0] + A(1, 1) * x[1] + A(2, 1) * x[2],
          A(0, 2) * x[0] + A(1, 2) * x[1] + A(2, 2) * x[2]};
}

/// A spatial vector (Featherstone 2008, chapter 2). For a motion, `linear` is the velocity of the
/// point at the origin. For a force, `angular` is the moment about the origin.
struct SpatialVector {
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();

  [[gnu::always_inline]] SpatialVector& operator+=(const SpatialVector& other) {
    angular += other.angular;
    linear += other.linear;
    return *this;
  }
};

[[gnu::always_inline]] inline SpatialVector operator+(const SpatialVector& a,
                                                      const SpatialVector& b) {
  return {a.angular + b.angular, a.linear + b.linear};
}

[[gnu::always_inline]] inline SpatialVector operator*(double factor, const SpatialVector& x) {
  return {factor * x.angular, factor * x.linear};
}

[[gnu::always_inline]] inline double Dot(const SpatialVector& a, const SpatialVector& b) {
  return Dot(a.angular, b.angular) + Dot(a.linear, b.linear);
}

/// Rate of a motion fixed in a body that moves with `v`.
[[gnu::always_inline]] inline SpatialVector CrossMotion(const SpatialVector& v,
                                                        const SpatialVector& motion) {
  return {Cross(v.angular, motion.angular),
          Cross(v.angular, motion.linear) + Cross(v.linear, motion.angular)};
}

/// Rate of a force fixed in a body that moves with `v`.
[[gnu::always_inline]] inline SpatialVector CrossForce(const SpatialVector& v,
                                                       const SpatialVector& force) {
  return {Cross(v.angular, force.angular) + Cross(v.linear, force.linear),
          Cross(v.angular, force.linear)};
}

/// Velocity of the point at p under the motion.
[[gnu::always_inline]] inline Eigen::Vector3d VelocityAt(const SpatialVector& motion,
                                                         const Eigen::Vector3d& p) {
  return motion.linear + Cross(motion.angular, p);
}

/// D = tr(G) 1 - G, where G is the sum over a body's mass of velocity times position', for a body
/// with the first moment of mass `moment` and the rotational inertia `inertia` about the origin. D
/// x is the moment of the forces needed to turn the momentum with x (docs/dynamics.md).
inline Eigen::Matrix3d CoriolisMatrix(const SpatialVector& v, const Eigen::Vector3d& moment,
                                      const Eigen::Matrix3d& inertia) {
  // The second moment of mass is half the inertia's trace minus the inertia.
  const double half_trace = 0.5 * (inertia(0, 0) + inertia(1, 1) + inertia(2, 2));
  const double trace = Dot(v.linear, moment);
  Eigen::Matrix3d D;
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d second(c == 0 ? half_trace - inertia(0, c) : -inertia(0, c),
                                 c == 1 ? half_trace - inertia(1, c) : -inertia(1, c),
                                 c == 2 ? half_trace - inertia(2, c) : -inertia(2, c));
    const Eigen::Vector3d column = Cross(v.angular, second) + moment[c] * v.linear;
    for (int r = 0; r < 3; ++r) D(r, c) = (r == c ? trace : 0) - column[r];
  }
  return D;
}

/// Writes x over the first six rows of a column.
inline void StoreColumn(const SpatialVector& x, int column, Eigen::MatrixXd* matrix) {
  double* to = &(*matrix)(0, column);
  for (int i = 0; i < 3; ++i) {
    to[i] = x.angular[i];
    to[3 + i] = x.linear[i];
  }
}

/// Writes x over the first six columns of a row.
inline void StoreRow(const SpatialVector& x, int row, Eigen::MatrixXd* matrix) {
  for (int i = 0; i < 3; ++i) {
    (*matrix)(row, i) = x.angular[i];
    (*matrix)(row, 3 + i) = x.linear[i];
  }
}

}  // namespace possibility::dynamics
