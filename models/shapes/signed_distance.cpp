#include "models/shapes/signed_distance.h"

#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace possibility::models {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Bullet's answer is accepted when its own estimate and the proven bound agree this well, m.
constexpr double kAgreement = 1e-6;

/// Distance by which touching cores are moved apart, m.
constexpr double kShift = 1e-5;

/// If its sine is smaller, the cross product of two edges is not a direction of its own: the face
/// normals replace it.
constexpr double kParallelSine = 1e-6;

/// The cores of two shapes, in the frame of the first one.
struct Cores {
  const PreparedShape& A;
  const PreparedShape& B;
  Isometry3d X_AB;

  bool AreBoxes() const { return A.core_is_box() && B.core_is_box(); }

  /// Signed gap between the two supporting planes normal to `n_A` (unit, from A to B). The
  /// signed distance is the maximum of this over all directions, so any value is a lower bound.
  double GapAlong(const Vector3d& n_A) const {
    const Vector3d n_B = X_AB.linear().transpose() * n_A;
    return n_A.dot(X_AB * B.CoreSupport(-n_B) - A.CoreSupport(n_A));
  }
};

struct Separation {
  double gap = -kInfinity;  ///< lower bound of the signed distance
  Vector3d n_A = Vector3d::UnitX();

  void Improve(double other_gap, const Vector3d& other_n_A) {
    if (other_gap > gap) {
      gap = other_gap;
      n_A = other_n_A;
    }
  }
};

/// Separating-axis test of the cores' bounding boxes over the normals of all faces.
Separation SeparateByFaces(const Cores& cores) {
  const Eigen::Matrix3d R = cores.X_AB.linear();
  const Vector3d p = cores.X_AB.translation();
  const Vector3d p_B = R.transpose() * p;
  const Vector3d& a = cores.A.half_extents();
  const Vector3d& b = cores.B.half_extents();
  const Vector3d gap_A = p.cwiseAbs() - a - R.cwiseAbs() * b;
  const Vector3d gap_B = p_B.cwiseAbs() - b - R.cwiseAbs().transpose() * a;
  Separation best;
  for (int i = 0; i < 3; ++i) {
    best.Improve(gap_A[i], std::copysign(1.0, p[i]) * Vector3d::Unit(i));
    best.Improve(gap_B[i], std::copysign(1.0, p_B[i]) * R.col(i));
  }
  return best;
}

/// Continues with the cross products of the boxes' edges. Together with the faces these are all
/// face normals of the Minkowski difference, so the gap of overlapping boxes is exact.
void SeparateByEdges(const Cores& cores, Separation* best) {
  const Eigen::Matrix3d R = cores.X_AB.linear();
  const Vector3d p = cores.X_AB.translation();
  const Vector3d& a = cores.A.half_extents();
  const Vector3d& b = cores.B.half_extents();
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double sine = std::hypot(R(i1, j), R(i2, j));
      if (!(sine > kParallelSine)) continue;
      const double along = p[i2] * R(i1, j) - p[i1] * R(i2, j);
      const double reach_A = a[i1] * std::abs(R(i2, j)) + a[i2] * std::abs(R(i1, j));
      const double reach_B = b[j1] * std::abs(R(i, j2)) + b[j2] * std::abs(R(i, j1));
      const double gap = (std::abs(along) - reach_A - reach_B) / sine;
      if (gap > best->gap) {
        best->Improve(gap, std::copysign(1 / sine, along) * Vector3d::Unit(i).cross(R.col(j)));
      }
    }
  }
}

/// Whether the corner of `other` nearest to `box` along `n` (a face normal of `box`, given in the
/// box's frame like `corner`) lies over that face; then the gap along n is the distance.
bool CornerLiesOverFace(const Vector3d& half_extents, const Vector3d& n, const Vector3d& corner) {
  int face = 0;
  if (n.cwiseAbs().maxCoeff(&face) < 1) return false;
  for (int i = 0; i < 3; ++i) {
    if (i != face && !(std::abs(corner[i]) <= half_extents[i])) return false;
  }
  return true;
}

bool GapIsExact(const Cores& cores, const Vector3d& n_A) {
  const Vector3d n_B = cores.X_AB.linear().transpose() * n_A;
  if (CornerLiesOverFace(cores.A.half_extents(), n_A, cores.X_AB * cores.B.CoreSupport(-n_B))) {
    return true;
  }
  // The transposed column is a unit axis only up to rounding.
  const Vector3d axis_B = n_B.array().round();
  if (!axis_B.isApprox(n_B, 1e-12)) return false;
  const Vector3d p_BA =
      cores.X_AB.linear().transpose() * (cores.A.CoreSupport(n_A) - cores.X_AB.translation());
  return CornerLiesOverFace(cores.B.half_extents(), axis_B, p_BA);
}

/// Signed distance of the point p from a box, in the box's frame.
double PointToBox(const Vector3d& half_extents, const Vector3d& p) {
  const Vector3d outside = p.cwiseAbs() - half_extents;
  return outside.cwiseMax(0).norm() + std::min(outside.maxCoeff(), 0.0);
}

btTransform ToBullet(const Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  const Vector3d p = X.translation();
  const btMatrix3x3 basis(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                          R(2, 2));
  return btTransform(basis, btVector3(p.x(), p.y(), p.z()));
}

struct Estimate {
  double distance = 0;
  Vector3d n_A = Vector3d::UnitX();
};

/// GJK, or EPA if the cores overlap; none if they give up.
std::optional<Estimate> AskBullet(const Cores& cores, const btTransform& X_AB,
                                  const Vector3d& guess) {
  using Solver = btGjkEpaSolver2;
  const btVector3 start(guess.x(), guess.y(), guess.z());
  const btConvexShape* A = &cores.A.bullet_core();
  const btConvexShape* B = &cores.B.bullet_core();
  Solver::sResults result;
  const btTransform here = btTransform::getIdentity();
  if (!Solver::Distance(A, here, B, X_AB, start, result)) {
    if (result.status != Solver::sResults::Penetrating) return std::nullopt;
    if (!Solver::Penetration(A, here, B, X_AB, start, result, false)) return std::nullopt;
  }
  const Vector3d n_A(-result.normal.x(), -result.normal.y(), -result.normal.z());
  const double norm = n_A.norm();
  if (!(norm > 0) || !std::isfinite(norm)) return std::nullopt;
  return Estimate{result.distance, n_A / norm};
}

/// Takes Bullet's directions from several starts until an estimate agrees with the bound that its
/// direction proves. GJK and EPA sometimes stall, depending on the start.
bool ImproveByBullet(const Cores& cores, Separation* best) {
  const btTransform X_AB = ToBullet(cores.X_AB);
  const Eigen::Matrix3d R = cores.X_AB.linear();
  const std::array<Vector3d, 12> starts = {-cores.X_AB.translation(),
                                           -best->n_A,
                                           Vector3d(1, 2, 3),
                                           Vector3d(-3, 1, 2),
                                           Vector3d(2, -3, 1),
                                           Vector3d(-1, -2, -3),
                                           Vector3d(3, -1, -2),
                                           R.col(0),
                                           -R.col(0),
                                           R.col(1),
                                           -R.col(1),
                                           R.col(2)};
  for (const Vector3d& start : starts) {
    const std::optional<Estimate> estimate = AskBullet(cores, X_AB, start);
    if (!estimate) continue;
    const double gap = cores.GapAlong(estimate->n_A);
    best->Improve(gap, estimate->n_A);
    if (std::abs(estimate->distance - gap) < kAgreement && best->gap - gap < kAgreement) {
      return true;
    }
  }
  return false;
}

/// GJK and EPA both fail for cores that just touch. The cores are moved apart along the line of
/// their centres; the direction found there proves a bound for the original cores that is off by at
/// most twice the shift.
void ImproveTouching(const Cores& cores, Separation* best) {
  Cores apart = cores;
  const double distance = cores.X_AB.translation().norm();
  if (!(distance > kShift)) return;
  apart.X_AB.translation() *= 1 + kShift / distance;
  Separation best_apart;
  best_apart.n_A = best->n_A;
  ImproveByBullet(apart, &best_apart);
  best->Improve(cores.GapAlong(best_apart.n_A), best_apart.n_A);
}

/// The best direction; any one that proves `enough` will do.
Separation Separated(const Cores& cores, double enough) {
  Separation best = SeparateByFaces(cores);
  if (best.gap >= enough) return best;
  if (cores.AreBoxes() && best.gap > 0 && GapIsExact(cores, best.n_A)) return best;
  SeparateByEdges(cores, &best);
  if (best.gap >= enough) return best;
  const bool is_exact = cores.AreBoxes() && best.gap <= 0;
  if (!is_exact && !ImproveByBullet(cores, &best)) ImproveTouching(cores, &best);
  return best;
}

}  // namespace

double SignedDistance(const PreparedShape& A, const Isometry3d& X_WA, const PreparedShape& B,
                      const Isometry3d& X_WB, double enough) {
  const Cores cores{A, B, X_WA.inverse() * X_WB};
  if (!cores.X_AB.matrix().allFinite()) return -kInfinity;
  const double radii = A.radius() + B.radius();
  if (cores.AreBoxes() && B.core_is_point()) {
    return PointToBox(A.half_extents(), cores.X_AB.translation()) - radii;
  }
  if (cores.AreBoxes() && A.core_is_point()) {
    return PointToBox(B.half_extents(), cores.X_AB.inverse().translation()) - radii;
  }
  return Separated(cores, enough + radii).gap - radii;
}

SeparatingPlane Separate(const PreparedShape& A, const Isometry3d& X_WA, const PreparedShape& B,
                         const Isometry3d& X_WB) {
  const Cores cores{A, B, X_WA.inverse() * X_WB};
  const Separation best = Separated(cores, kInfinity);
  return {best.gap - A.radius() - B.radius(), best.n_A};
}

}  // namespace possibility::models
