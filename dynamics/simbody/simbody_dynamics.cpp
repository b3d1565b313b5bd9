// The Simbody seam: C++17, assertions on (docs/dynamics.md). Numbers cross it element by
// element, because Eigen's expressions and SimTK's operators do not mix in one file.
#include "dynamics/simbody/simbody_dynamics.h"

#include <Simbody.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "dynamics/tree/tree_kinematics.h"

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

void CheckFinite(const char* what, const double* values, Eigen::Index size) {
  for (Eigen::Index i = 0; i < size; ++i) {
    if (std::isfinite(values[i])) continue;
    throw std::invalid_argument(std::string("SimbodyDynamics: ") + what + " is not finite");
  }
}

bool HasRotors(const models::RobotModel& model) {
  for (const models::Joint& joint : model.joints) {
    if (joint.actuator.armature > 0) return true;
  }
  return false;
}

}  // namespace

/// The robot with gravity, mobility forces and the couplings of its mimic joints.
struct SimbodyDynamics::System {
  System(const models::RobotModel& model, bool with_rotors)
      : matter(system), general_forces(system), nq(model.nq()), nv(model.nv()) {
    bodies.push_back(SimTK::MobilizedBody::Free(
        matter.Ground(), SimTK::Body::Rigid(ToMassProperties(model.links[0].inertial))));
    for (int i = 0; i < model.num_joints(); ++i) {
      AddJoint(model.joints[i], model.links[i + 1].inertial);
    }
    for (int i = 0; i < model.num_joints(); ++i) {
      if (model.joints[i].mimic) Couple(bodies[i + 1], *model.joints[i].mimic);
      const double armature = model.joints[i].actuator.armature;
      if (with_rotors && armature > 0) AddRotor(i, armature);
    }
    SimTK::Force::Gravity(general_forces, matter, SimTK::Vec3(0, 0, -kGravity));
    applied = SimTK::Force::DiscreteForces(general_forces, matter);
  }
  virtual ~System() = default;

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

  /// A rotor with its bearing on the ground, so that the robot's motion does not carry it. Its
  /// mass does not move.
  void AddRotor(int joint, double armature) {
    const SimTK::Body::Rigid body(
        SimTK::MassProperties(1, SimTK::Vec3(0), SimTK::Inertia(armature)));
    rotors.push_back(SimTK::MobilizedBody::Pin(matter.Ground(), body));
    rotor_joints.push_back(joint);
    Couple(rotors.back(), {joint, 1, 0});
  }

  /// q - multiplier * q of the master - offset = 0.
  void Couple(const SimTK::MobilizedBody& body, const models::Mimic& mimic) {
    SimTK::Vector coefficients(3);
    coefficients[0] = 1;
    coefficients[1] = -mimic.multiplier;
    coefficients[2] = -mimic.offset;
    SimTK::Array_<SimTK::MobilizedBodyIndex> coupled;
    coupled.push_back(body.getMobilizedBodyIndex());
    coupled.push_back(bodies[mimic.joint + 1].getMobilizedBodyIndex());
    const SimTK::Array_<SimTK::MobilizerQIndex> first(2, SimTK::MobilizerQIndex(0));
    // The constraint owns the function.
    SimTK::Constraint::CoordinateCoupler(matter, new SimTK::Function::Linear(coefficients), coupled,
                                         first);
  }

  /// Call once, after everything has been added.
  void Finish() {
    state = system.realizeTopology();
    system.realizeModel(state);
    for (const SimTK::MobilizedBody& body : bodies) {
      first_q.push_back(body.getFirstQIndex(state));
      first_u.push_back(body.getFirstUIndex(state));
    }
  }

  /// Index in Simbody's u of our v[i]: Simbody orders mobilities by depth in the tree.
  int UIndex(int i) const { return i < 6 ? first_u[0] + i : first_u[i - 5]; }

  /// `q` with a quaternion of length 1.
  void SetState(const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    SimTK::Vector& to_q = state.updQ();
    for (int i = 0; i < 7; ++i) to_q[first_q[0] + i] = q.data()[i];
    for (int i = 7; i < nq; ++i) to_q[first_q[i - 6]] = q.data()[i];
    SimTK::Vector& to_u = state.updU();
    for (int i = 0; i < nv; ++i) to_u[UIndex(i)] = v.data()[i];
    for (std::size_t i = 0; i < rotors.size(); ++i) {
      to_q[rotors[i].getFirstQIndex(state)] = q.data()[7 + rotor_joints[i]];
      to_u[rotors[i].getFirstUIndex(state)] = v.data()[6 + rotor_joints[i]];
    }
  }

  SimTK::Vector ToMobilities(const double* values) const {
    SimTK::Vector mobilities(state.getNU(), 0.0);
    for (int i = 0; i < nv; ++i) mobilities[UIndex(i)] = values[i];
    return mobilities;
  }

  Eigen::VectorXd FromMobilities(const SimTK::Vector& mobilities) const {
    Eigen::VectorXd values(nv);
    for (int i = 0; i < nv; ++i) values.data()[i] = mobilities[UIndex(i)];
    return values;
  }

  Eigen::VectorXd Accelerate(const double* forces) {
    applied.setAllMobilityForces(state, ToMobilities(forces));
    system.realize(state, SimTK::Stage::Acceleration);
    return FromMobilities(state.getUDot());
  }

  SimTK::MultibodySystem system;
  SimTK::SimbodyMatterSubsystem matter;
  SimTK::GeneralForceSubsystem general_forces;
  SimTK::Force::DiscreteForces applied;
  std::vector<SimTK::MobilizedBody> bodies;  ///< by link
  std::vector<SimTK::MobilizedBody> rotors;
  std::vector<int> rotor_joints;
  SimTK::State state;
  int nq = 0;  ///< of the robot
  int nv = 0;
  std::vector<int> first_q;  ///< by link
  std::vector<int> first_u;
};

struct SimbodyDynamics::HeldSystem : System {
  HeldSystem(const models::RobotModel& model, const std::vector<int>& held_links)
      : System(model, true), links(held_links) {
    for (const int link : links) {
      balls.push_back(SimTK::Constraint::Ball(matter.Ground(), bodies[link]));
    }
    Finish();
  }

  /// Places the balls where the points are now; realizes positions.
  void Place(const std::vector<ContactPoint>& held) {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      balls[i].setPointOnBody2(state, ToVec3(held[i].p_L));
    }
    system.realize(state, SimTK::Stage::Position);
    std::vector<SimTK::Vec3> places;
    for (const ContactPoint& point : held) {
      places.push_back(bodies[point.link].findStationLocationInGround(state, ToVec3(point.p_L)));
    }
    for (std::size_t i = 0; i < balls.size(); ++i) balls[i].setPointOnBody1(state, places[i]);
  }

  Eigen::Matrix3Xd Reactions() const {
    Eigen::Matrix3Xd forces(3, balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
      // Multipliers are on the side of the inertial forces: M u-dot + G' lambda = f.
      const SimTK::Vec3 force = -balls[i].getMultipliers(state);
      for (int r = 0; r < 3; ++r) forces.data()[3 * i + r] = force[r];
    }
    return forces;
  }

  std::vector<int> links;
  std::vector<SimTK::Constraint::Ball> balls;
};

SimbodyDynamics::SimbodyDynamics(const models::RobotModel& model)
    : model_(model), free_(std::make_unique<System>(model, false)) {
  free_->Finish();
  if (!HasRotors(model)) return;
  driven_ = std::make_unique<System>(model, true);
  driven_->Finish();
}
SimbodyDynamics::~SimbodyDynamics() = default;
SimbodyDynamics::SimbodyDynamics(SimbodyDynamics&&) noexcept = default;

void SimbodyDynamics::SetState(const Eigen::Ref<const Eigen::VectorXd>& q,
                               const Eigen::Ref<const Eigen::VectorXd>& v) {
  CheckSize("q", q.size(), free_->nq);
  CheckSize("v", v.size(), free_->nv);
  q_ = q;
  v_ = v;
  double* quaternion = q_.data();
  const double norm = std::sqrt(quaternion[0] * quaternion[0] + quaternion[1] * quaternion[1] +
                                quaternion[2] * quaternion[2] + quaternion[3] * quaternion[3]);
  if (!(norm > 1e-100 && std::isfinite(norm))) {
    throw std::invalid_argument("SimbodyDynamics: the quaternion in q cannot be normalised");
  }
  for (int i = 0; i < 4; ++i) quaternion[i] /= norm;
  free_->SetState(q_, v_);
  free_->system.realize(free_->state, SimTK::Stage::Velocity);
}

Eigen::VectorXd SimbodyDynamics::InverseDynamics(const Eigen::Ref<const Eigen::VectorXd>& a) const {
  CheckSize("a", a.size(), free_->nv);
  // calcResidualForce counts only the forces that it is given, so gravity must be passed.
  SimTK::Vector_<SimTK::SpatialVec> gravity(free_->matter.getNumBodies(),
                                            SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0)));
  for (const SimTK::MobilizedBody& body : free_->bodies) {
    const SimTK::Vec3 arm =
        body.expressVectorInGroundFrame(free_->state, body.getBodyMassCenterStation(free_->state));
    const SimTK::Vec3 weight(0, 0, -kGravity * body.getBodyMass(free_->state));
    gravity[body.getMobilizedBodyIndex()] = SimTK::SpatialVec(arm % weight, weight);
  }
  SimTK::Vector residual;
  free_->matter.calcResidualForceIgnoringConstraints(free_->state, SimTK::Vector(), gravity,
                                                     free_->ToMobilities(a.data()), residual);
  Eigen::VectorXd forces = free_->FromMobilities(residual);
  for (int i = 0; i < model_.num_joints(); ++i) {
    const models::Actuator& actuator = model_.joints[i].actuator;
    if (!actuator.HasLosses()) continue;
    forces.data()[6 + i] +=
        actuator.armature * a.data()[6 + i] + actuator.Friction(v_.data()[6 + i]);
  }
  return forces;
}

Eigen::VectorXd SimbodyDynamics::WithoutFriction(
    const Eigen::Ref<const Eigen::VectorXd>& forces) const {
  Eigen::VectorXd rest = forces;
  for (int i = 0; i < model_.num_joints(); ++i) {
    rest.data()[6 + i] -= model_.joints[i].actuator.Friction(v_.data()[6 + i]);
  }
  return rest;
}

Eigen::VectorXd SimbodyDynamics::ForwardDynamics(const Eigen::Ref<const Eigen::VectorXd>& forces) {
  CheckSize("forces", forces.size(), free_->nv);
  CheckFinite("forces", forces.data(), forces.size());
  const Eigen::VectorXd rest = WithoutFriction(forces);
  if (!driven_) return free_->Accelerate(rest.data());
  driven_->SetState(q_, v_);
  return driven_->Accelerate(rest.data());
}

SimbodyDynamics::HeldMotion SimbodyDynamics::ForwardDynamics(
    const Eigen::Ref<const Eigen::VectorXd>& forces, const std::vector<ContactPoint>& held) {
  CheckSize("forces", forces.size(), free_->nv);
  CheckFinite("forces", forces.data(), forces.size());
  std::vector<int> links;
  for (const ContactPoint& point : held) {
    CheckFinite("a held point", point.p_L.data(), 3);
    if (point.link < 0 || point.link >= static_cast<int>(free_->bodies.size())) {
      throw std::invalid_argument("SimbodyDynamics: a held point is on link " +
                                  std::to_string(point.link) + ", which the robot has not");
    }
    links.push_back(point.link);
  }
  if (!held_ || held_->links != links) held_ = std::make_unique<HeldSystem>(model_, links);
  held_->SetState(q_, v_);
  held_->Place(held);
  HeldMotion motion;
  motion.acceleration = held_->Accelerate(WithoutFriction(forces).data());
  motion.forces = held_->Reactions();
  return motion;
}

double SimbodyDynamics::KineticEnergy() const {
  double energy = free_->matter.calcKineticEnergy(free_->state);
  for (int i = 0; i < model_.num_joints(); ++i) {
    const double speed = v_.data()[6 + i];
    energy += model_.joints[i].actuator.armature * speed * speed / 2;
  }
  return energy;
}

double SimbodyDynamics::PotentialEnergy() const {
  free_->system.realize(free_->state, SimTK::Stage::Dynamics);
  return free_->system.calcPotentialEnergy(free_->state);
}

Eigen::Matrix<double, 6, 1> SimbodyDynamics::CentroidalMomentum() const {
  const SimTK::SpatialVec momentum = free_->matter.calcSystemCentralMomentum(free_->state);
  Eigen::Matrix<double, 6, 1> result;
  for (int i = 0; i < 6; ++i) result.data()[i] = momentum[i / 3][i % 3];
  return result;
}

Eigen::MatrixXd SimbodyDynamics::MassMatrix() const {
  SimTK::Matrix M;
  free_->matter.calcM(free_->state, M);
  const int n = free_->nv;
  Eigen::MatrixXd result(n, n);
  for (int c = 0; c < n; ++c) {
    for (int r = 0; r < n; ++r) result.data()[c * n + r] = M(free_->UIndex(r), free_->UIndex(c));
  }
  for (int i = 0; i < model_.num_joints(); ++i) {
    result.data()[(6 + i) * (n + 1)] += model_.joints[i].actuator.armature;
  }
  return result;
}

Eigen::Isometry3d SimbodyDynamics::LinkPose(int link) const {
  const SimTK::Transform& X = free_->bodies.at(link).getBodyTransform(free_->state);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  double* m = pose.data();
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) m[4 * c + r] = X.R()[r][c];
    m[12 + c] = X.p()[c];
  }
  return pose;
}

Eigen::Vector3d SimbodyDynamics::PointPosition(int link, const Eigen::Vector3d& p_L) const {
  return FromVec3(free_->bodies.at(link).findStationLocationInGround(free_->state, ToVec3(p_L)));
}

Eigen::Vector3d SimbodyDynamics::PointVelocity(int link, const Eigen::Vector3d& p_L) const {
  return FromVec3(free_->bodies.at(link).findStationVelocityInGround(free_->state, ToVec3(p_L)));
}

Eigen::Matrix3Xd SimbodyDynamics::PointJacobian(int link, const Eigen::Vector3d& p_L) const {
  SimTK::Matrix J;
  free_->matter.calcStationJacobian(free_->state, free_->bodies.at(link).getMobilizedBodyIndex(),
                                    ToVec3(p_L), J);
  Eigen::Matrix3Xd result(3, free_->nv);
  for (int c = 0; c < free_->nv; ++c) {
    for (int r = 0; r < 3; ++r) result.data()[3 * c + r] = J(r, free_->UIndex(c));
  }
  return result;
}

Eigen::Vector3d SimbodyDynamics::PointBias(int link, const Eigen::Vector3d& p_L) const {
  return FromVec3(free_->matter.calcBiasForStationJacobian(
      free_->state, free_->bodies.at(link).getMobilizedBodyIndex(), ToVec3(p_L)));
}

Eigen::Vector3d SimbodyDynamics::CentreOfMass() const {
  return FromVec3(free_->matter.calcSystemMassCenterLocationInGround(free_->state));
}

Eigen::Vector3d SimbodyDynamics::CentreOfMassVelocity() const {
  return FromVec3(free_->matter.calcSystemMassCenterVelocityInGround(free_->state));
}

}  // namespace possibility::dynamics
