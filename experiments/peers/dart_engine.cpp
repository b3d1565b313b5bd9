// DART's free joint has the body's own twist for its velocity: angular and linear velocity in the
// body's axes, and the rates of those numbers for its acceleration. With R the root's rotation,
//   v_B = R' v_W,  d(v_B)/dt = R' a_W - w_B x v_B,  forces_B = R' forces_W.
#include "experiments/peers/dart_engine.h"

#include <Eigen/Geometry>
#include <cmath>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <string>

namespace possibility::experiments {
namespace {

using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

template <typename Joint>
dart::dynamics::BodyNode* AddLink(const PeerLink& link, const std::string& name,
                                  dart::dynamics::BodyNode* parent,
                                  dart::dynamics::Skeleton* skeleton) {
  typename Joint::Properties properties;
  properties.mName = name;
  properties.mAxis = Vector3d(link.axis.data());
  properties.mT_ParentBodyToJoint.linear() = Matrix3d(link.R_PJ.data());
  properties.mT_ParentBodyToJoint.translation() = Vector3d(link.p_PJ.data());
  return skeleton
      ->createJointAndBodyNodePair<Joint>(parent, properties,
                                          dart::dynamics::BodyNode::AspectProperties(name))
      .second;
}

}  // namespace

struct DartEngine::Impl {
  void ToBody(const double* world, VectorXd* body) const {
    *body = Map<const VectorXd>(world, body->size());
    body->head<3>() = R.transpose() * Map<const Vector3d>(world);
    body->segment<3>(3) = R.transpose() * Map<const Vector3d>(world + 3);
  }

  void ToWorld(const VectorXd& body, double* world) const {
    Map<VectorXd>(world, body.size()) = body;
    Map<Vector3d>(world).noalias() = R * body.head<3>();
    Map<Vector3d>(world + 3).noalias() = R * body.segment<3>(3);
  }

  /// Change of the linear velocity in body axes due to the body's rotation.
  Vector3d Turning() const { return v.head<3>().cross(v.segment<3>(3)); }

  dart::dynamics::SkeletonPtr skeleton = dart::dynamics::Skeleton::create("robot");
  Matrix3d R = Matrix3d::Identity();
  VectorXd q, v, a, forces;  ///< DART's, nv each
};

DartEngine::DartEngine(const std::vector<PeerLink>& links, double gravity)
    : impl_(std::make_unique<Impl>()) {
  std::vector<dart::dynamics::BodyNode*> bodies;
  for (const PeerLink& link : links) {
    const std::string name = std::to_string(bodies.size());
    if (bodies.empty()) {
      const auto root = impl_->skeleton->createJointAndBodyNodePair<dart::dynamics::FreeJoint>();
      bodies.push_back(root.second);
    } else if (link.joint == PeerJoint::kPrismatic) {
      bodies.push_back(AddLink<dart::dynamics::PrismaticJoint>(link, name, bodies[link.parent],
                                                               impl_->skeleton.get()));
    } else {
      bodies.push_back(AddLink<dart::dynamics::RevoluteJoint>(link, name, bodies[link.parent],
                                                              impl_->skeleton.get()));
    }
    bodies.back()->setInertia(
        dart::dynamics::Inertia(link.mass, Vector3d(link.p_LC.data()), Matrix3d(link.I_LC.data())));
  }
  impl_->skeleton->setGravity(Vector3d(0, 0, -gravity));
  impl_->q.resize(nv());
  impl_->v.resize(nv());
  impl_->a.resize(nv());
  impl_->forces.resize(nv());
}

DartEngine::~DartEngine() = default;
DartEngine::DartEngine(DartEngine&&) noexcept = default;

int DartEngine::nv() const { return static_cast<int>(impl_->skeleton->getNumDofs()); }

void DartEngine::SetState(const double* q, const double* v) {
  const Eigen::Quaterniond orientation(q[0], q[1], q[2], q[3]);
  impl_->R = orientation.toRotationMatrix();
  const double sine = orientation.vec().norm();
  const double angle = 2 * std::atan2(sine, orientation.w());
  impl_->q.head<3>() = orientation.vec() * (sine > 0 ? angle / sine : 2.0);
  impl_->q.tail(nv() - 3) = Map<const VectorXd>(q + 4, nv() - 3);
  impl_->ToBody(v, &impl_->v);
  impl_->skeleton->setPositions(impl_->q);
  impl_->skeleton->setVelocities(impl_->v);
}

void DartEngine::InverseDynamics(const double* a, double* forces) {
  impl_->ToBody(a, &impl_->a);
  impl_->a.segment<3>(3) -= impl_->Turning();
  impl_->skeleton->setAccelerations(impl_->a);
  impl_->skeleton->computeInverseDynamics();
  impl_->ToWorld(impl_->skeleton->getForces(), forces);
}

void DartEngine::ForwardDynamics(const double* forces, double* a) {
  impl_->ToBody(forces, &impl_->forces);
  impl_->skeleton->setForces(impl_->forces);
  impl_->skeleton->computeForwardDynamics();
  impl_->a = impl_->skeleton->getAccelerations();
  impl_->a.segment<3>(3) += impl_->Turning();
  impl_->ToWorld(impl_->a, a);
}

void DartEngine::MassMatrix(double* M) {
  const Eigen::MatrixXd& body = impl_->skeleton->getMassMatrix();
  Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(nv(), nv());
  turn.topLeftCorner<3, 3>() = turn.block<3, 3>(3, 3) = impl_->R.transpose();
  Map<Eigen::MatrixXd>(M, nv(), nv()).noalias() = turn.transpose() * body * turn;
}

}  // namespace possibility::experiments
