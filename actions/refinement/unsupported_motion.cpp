#include "actions/refinement/unsupported_motion.h"

#include <Eigen/Eigenvalues>

namespace possibility::actions {
namespace {

/// Points closer than this to a line are on it: forces of the weight's size there could not make up
/// for a millionth of the weight x 1 m.
constexpr double kOnALine = 1e-3;  // m

}  // namespace

Eigen::Matrix<double, 6, Eigen::Dynamic> UnsupportedMotions(
    const VerifierState& state, const std::vector<BearingPoint>& points) {
  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
  for (const BearingPoint& point : points) {
    const Eigen::Vector3d arm = state.Position(point) - state.X_WL[0].translation();
    Eigen::Matrix<double, 6, 3> G;
    G.topRows<3>() << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    G.bottomRows<3>().setIdentity();
    gram += G * G.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(gram);
  const auto free = (eigen.eigenvalues().array() < kOnALine * kOnALine).count();
  return eigen.eigenvectors().leftCols(free);  // eigenvalues ascend
}

Eigen::VectorXd UnsupportedForces(const Eigen::Matrix<double, 6, Eigen::Dynamic>& motions,
                                  const VerifierState& state,
                                  const dynamics::SimbodyDynamics& dynamics) {
  return motions.transpose() * dynamics.InverseDynamics(state.knot.a).head<6>();
}

}  // namespace possibility::actions
