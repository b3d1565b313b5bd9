#pragma once

#include <array>
#include <memory>
#include <vector>

namespace possibility::experiments {

enum class PeerJoint { kRevolute, kPrismatic };

/// One link of a floating-base tree and the joint that moves it. Plain numbers, because Eigen
/// objects must not be passed to a library built for another instruction set.
struct PeerLink {
  // Joint; ignored for the root, which is the first link and floats.
  int parent = 0;
  PeerJoint joint = PeerJoint::kRevolute;
  std::array<double, 9> R_PJ{};  ///< child frame in the parent's at 0, column by column
  std::array<double, 3> p_PJ{};  ///< m
  std::array<double, 3> axis{};  ///< unit, in the child frame
  // Mass properties.
  double mass = 0;               ///< kg
  std::array<double, 3> p_LC{};  ///< m
  std::array<double, 9> I_LC{};  ///< about the centre of mass, link axes, kg m^2
};

/// A tree as a skeleton of DART, the engine that the paper used: an independent reference for
/// results and times. Conventions of q, v, a and generalised forces are those of models::RobotModel
/// and dynamics::TreeKinematics. Sizes are not checked.
class DartEngine {
 public:
  /// Parents come before children. `gravity`: m/s^2, along -z.
  DartEngine(const std::vector<PeerLink>& links, double gravity);
  ~DartEngine();
  DartEngine(DartEngine&&) noexcept;

  int nv() const;

  /// `q`: nv + 1 numbers, the quaternion of length 1; `v`: nv.
  void SetState(const double* q, const double* v);
  /// Forces that realise `a` (nv), gravity included; into `forces` (nv).
  void InverseDynamics(const double* a, double* forces);
  /// Acceleration under `forces` (nv), which exclude gravity; into `a` (nv).
  void ForwardDynamics(const double* forces, double* a);
  /// Into `M`: nv x nv, column by column.
  void MassMatrix(double* M);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace possibility::experiments
