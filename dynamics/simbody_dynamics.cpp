// The Simbody seam: C++17, assertions on (docs/dynamics.md). Numbers cross it element by
// element, because Eigen's expressions and SimTK's operators do not mix in one file.
#include "dynamics/simbody_dynamics.h"

#include <Simbody.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamics/tree_kinematics.h"

namespace possibility::dynamics {

namespace {

SimTK::Vec3 ToVec3(const Eigen::Vector3d& v) { return SimTK::Vec3(v.data()); }

Eigen::Vector3d FromVec3(const SimTK::Vec3& v) { return Eigen::Vector3d(v[0], v[1], v[2]); }

SimTK::Mat33 ToMat33(const double* column_major, int stride) {
  SimTK::Mat33 m;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) m(r, c) = column_major[c * stride + r];
  }
  return m;
}

SimTK::Transform ToTransform(const Eigen::Isometry3d& X) {
  const double* m = X.data();  // 4 x 4, column-major
  const SimTK::Rotation R(ToMat33(m, 4));
  return SimTK::Transform(R, SimTK::Vec3(m[12], m[13], m[14]));
}

SimTK::MassProperties ToMassProperties(const models::Inertial& inertial) {
  const double* I = inertial.I_LC.data();
  const SimTK::Inertia central(SimTK::Vec3(I[0], I[4], I[8]), SimTK::Vec3(I[3], I[6], I[7]));
  const SimTK::Vec3 p_LC = ToVec3(inertial.p_LC);
  return SimTK::MassProperties(inertial.mass, p_LC,
                               central.shiftFromMassCenter(p_LC, inertial.mass));
}

void CheckSize(const char* what, Eigen::Index actual, int expected) {
  if (actual == expected) return;
  throw std::invalid_argument(std::string("SimbodyDynamics: ") + what + " has " +
                              std::to_string(actual) + " elements, expected " +
                              std::to_string(expected));
}

}  // namespace

struct SimbodyDynamics::Impl {
  explicit Impl(const models::RobotModel& model) : matter(system) {
    bodies.push_back(SimTK::MobilizedBody::Free(
        matter.Ground(), SimTK::Body::Rigid(ToMassProperties(model.links[0].inertial))));
    for (int i = 0; i < model.num_joints(); ++i) {
      AddJoint(model.joints[i], model.links[i + 1].inertial);
    }
    state = system.realizeTopology();
    system.realizeModel(state);
    nq = state.getNQ();
    nv = state.getNU();
    for (const SimTK::MobilizedBody& body : bodies) {
      first_q.push_back(body.getFirstQIndex(state));
      first_u.push_back(body.getFirstUIndex(state));
    }
  }

  void AddJoint(const models::Joint& joint, const models::Inertial& inertial) {
    const bool slides = joint.type == models::JointType::kPrismatic;
    // A pin turns about z and a slider moves along x of its own frames.
    const SimTK::UnitVec3 axis(ToVec3(joint.axis));
    const SimTK::Rotation R(axis, SimTK::CoordinateAxis(slides ? 0 : 2));
    const SimTK::Transform X_LM(R);
    const SimTK::Transform X_PF = ToTransform(joint.X_PJ) * X_LM;
    const SimTK::Body::Rigid body(ToMassProperties(inertial));
    SimTK::MobilizedBody& parent = bodies[joint.parent];
    if (slides) {
      bodies.push_back(SimTK::MobilizedBody::Slider(parent, X_PF, body, X_LM));
    } else {
      bodies.push_back(SimTK::MobilizedBody::Pin(parent, X_PF, body, X_LM));
    }
  }

  /// Index in Simbody's u of our v[i]: Simbody orders mobilities by depth in the tree.
  int UIndex(int i) const { return i < 6 ? first_u[0] + i : first_u[i - 5]; }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  std::vector<SimTK::MobilizedBody> bodies;  ///< by link
  SimTK::State state;
  int nq = 0;
  int nv = 0;
  std::vector<int> first_q;  ///< by link
  std::vector<int> first_u;
};

SimbodyDynamics::SimbodyDynamics(const models::RobotModel& model)
    : impl_(std::make_unique<Impl>(model)) {}
SimbodyDynamics::~SimbodyDynamics() = default;
SimbodyDynamics::SimbodyDynamics(SimbodyDynamics&&) noexcept = default;

void SimbodyDynamics::SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                               const Eigen::Ref<const Eigen::VectorXd>& v) {
  CheckSize("q", q.size(), impl_->nq);
  CheckSize("v", v.size(), impl_->nv);
  const double* from_q = q.data();
  const double norm = std::sqrt(from_q[0] * from_q[0] + from_q[1] * from_q[1] +
                                from_q[2] * from_q[2] + from_q[3] * from_q[3]);
  if (!(norm > 1e-100 && std::isfinite(norm))) {
    throw std::invalid_argument("SimbodyDynamics: the quaternion in q cannot be normalised");
  }
  SimTK::Vector& to_q = impl_->state.updQ();
  for (int i = 0; i < 7; ++i) to_q[impl_->first_q[0] + i] = from_q[i] / (i < 4 ? norm : 1.0);
  for (int i = 7; i < impl_->nq; ++i) to_q[impl_->first_q[i - 6]] = from_q[i];
  const double* from_v = v.data();
  SimTK::Vector& to_u = impl_->state.updU();
  for (int i = 0; i < impl_->nv; ++i) to_u[impl_->UIndex(i)] = from_v[i];
  impl_->system.realize(impl_->state, SimTK::Stage::Velocity);
}

Eigen::VectorXd SimbodyDynamics::InverseDynamics(const Eigen::Ref<const Eigen::VectorXd>& a) const {
  CheckSize("a", a.size(), impl_->nv);
  SimTK::Vector udot(impl_->nv);
  const double* from_a = a.data();
  for (int i = 0; i < impl_->nv; ++i) udot[impl_->UIndex(i)] = from_a[i];

  // calcResidualForce counts only the forces it is given, gravity among them.
  SimTK::Vector_<SimTK::SpatialVec> gravity(impl_->matter.getNumBodies(),
                                            SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0)));
  for (const SimTK::MobilizedBody& body : impl_->bodies) {
    const SimTK::Vec3 arm =
        body.expressVectorInGroundFrame(impl_->state, body.getBodyMassCenterStation(impl_->state));
    const SimTK::Vec3 weight(0, 0, -kGravity * body.getBodyMass(impl_->state));
    gravity[body.getMobilizedBodyIndex()] = SimTK::SpatialVec(arm % weight, weight);
  }
  SimTK::Vector residual;
  impl_->matter.calcResidualForceIgnoringConstraints(impl_->state, SimTK::Vector(), gravity, udot,
                                                     residual);
  Eigen::VectorXd forces(impl_->nv);
  for (int i = 0; i < impl_->nv; ++i) forces.data()[i] = residual[impl_->UIndex(i)];
  return forces;
}

Eigen::MatrixXd SimbodyDynamics::MassMatrix() const {
  SimTK::Matrix M;
  impl_->matter.calcM(impl_->state, M);
  const int n = impl_->nv;
  Eigen::MatrixXd result(n, n);
  for (int c = 0; c < n; ++c) {
    for (int r = 0; r < n; ++r) result.data()[c * n + r] = M(impl_->UIndex(r), impl_->UIndex(c));
  }
  return result;
}

Eigen::Isometry3d SimbodyDynamics::LinkPose(int link) const {
  const SimTK::Transform& X = impl_->bodies.at(link).getBodyTransform(impl_->state);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double* m = pose.data();
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) m[4 * c + r] = X.R()[r][c];
    m[12 + c] = X.p()[c];
  }
  return pose;
}

Eigen::Vector3d SimbodyDynamics::PointPosition(int link, const Eigen::Vector3d& p_L) const {
  return FromVec3(impl_->bodies.at(link).findStationLocationInGround(impl_->state, ToVec3(p_L)));
}

Eigen::Vector3d SimbodyDynamics::PointVelocity(int link, const Eigen::Vector3d& p_L) const {
  return FromVec3(impl_->bodies.at(link).findStationVelocityInGround(impl_->state, ToVec3(p_L)));
}

Eigen::Matrix3Xd SimbodyDynamics::PointJacobian(int link, const Eigen::Vector3d& p_L) const {
  SimTK::Matrix J;
  impl_->matter.calcStationJacobian(impl_->state, impl_->bodies.at(link).getMobilizedBodyIndex(),
                                    ToVec3(p_L), J);
  Eigen::Matrix3Xd result(3, impl_->nv);
  for (int c = 0; c < impl_->nv; ++c) {
    for (int r = 0; r < 3; ++r) result.data()[3 * c + r] = J(r, impl_->UIndex(c));
  }
  return result;
}

Eigen::Vector3d SimbodyDynamics::PointBias(int link, const Eigen::Vector3d& p_L) const {
  return FromVec3(impl_->matter.calcBiasForStationJacobian(
      impl_->state, impl_->bodies.at(link).getMobilizedBodyIndex(), ToVec3(p_L)));
}

Eigen::Vector3d SimbodyDynamics::CentreOfMass() const {
  return FromVec3(impl_->matter.calcSystemMassCenterLocationInGround(impl_->state));
}

Eigen::Vector3d SimbodyDynamics::CentreOfMassVelocity() const {
  return FromVec3(impl_->matter.calcSystemMassCenterVelocityInGround(impl_->state));
}

}  // namespace possibility::dynamics
