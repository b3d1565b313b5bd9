#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "actions/evidence/verifier_state.h"
#include "actions/plan/plan.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/robot/robot_model.h"
#include "models/world/collision.h"
#include "models/world/scenario.h"
#include "tests/dynamics/newton_euler.h"

namespace possibility::actions::testing {

/// The motion between two knots as the file format defines it, by the Hermite basis. Difference
/// quotients of rotations stand where the rest of the project has Jacobians.
class OracleMotion {
 public:
  using Vector3d = Eigen::Vector3d;
  using VectorXd = Eigen::VectorXd;
  using Quaterniond = Eigen::Quaterniond;

  OracleMotion(const Knot& k0, const Knot& k1) : k0_(k0), k1_(k1), h_(k1.t - k0.t) {
    R0_ = Root(k0);
    const auto log_near_end = [&](double e) {
      const Vector3d turn = e * k1.v.head<3>() + e * e / 2 * k1.a.head<3>();
      return Log(Exp(turn) * Root(k1) * R0_.conjugate());
    };
    const double e = 1e-3 / std::max(1.0, k1.v.head<3>().norm() + k1.a.head<3>().norm());
    phi_ = log_near_end(0);
    phi_rate_ = (log_near_end(e) - log_near_end(-e)) / (2 * e);
    phi_acceleration_ = (log_near_end(e) - 2 * phi_ + log_near_end(-e)) / (e * e);
  }

  double duration() const { return h_; }

  /// Configuration at a fraction of the interval.
  VectorXd At(double s) const {
    const Eigen::Index n = k0_.v.size() - 3;
    const VectorXd x = Blend(k0_.q.tail(n), k0_.v.tail(n), k0_.a.tail(n), k1_.q.tail(n),
                             k1_.v.tail(n), k1_.a.tail(n), s);
    const Vector3d phi = Blend(Vector3d::Zero(), k0_.v.head<3>(), k0_.a.head<3>(), phi_, phi_rate_,
                               phi_acceleration_, s);
    const Quaterniond R = Exp(phi) * R0_;
    VectorXd q(n + 4);
    q << R.w(), R.vec(), x;
    return q;
  }

  /// The displacement from the first configuration to the second, in the coordinates of v.
  static VectorXd Difference(const VectorXd& q0, const VectorXd& q1) {
    VectorXd d(q0.size() - 1);
    const Quaterniond R0(q0[0], q0[1], q0[2], q0[3]);
    const Quaterniond R1(q1[0], q1[1], q1[2], q1[3]);
    d << Log(R1 * R0.conjugate()), (q1 - q0).tail(q0.size() - 4);
    return d;
  }

 private:
  static Quaterniond Root(const Knot& knot) {
    return Quaterniond(knot.q[0], knot.q[1], knot.q[2], knot.q[3]).normalized();
  }

  static Vector3d Log(Quaterniond R) {
    if (R.w() < 0) R.coeffs() *= -1;
    const double sine = R.vec().norm();
    return sine > 0 ? Vector3d(2 * std::atan2(sine, R.w()) / sine * R.vec()) : Vector3d::Zero();
  }

  static Quaterniond Exp(const Vector3d& phi) {
    return phi.norm() > 0 ? Quaterniond(Eigen::AngleAxisd(phi.norm(), phi.normalized()))
                          : Quaterniond::Identity();
  }

  VectorXd Blend(const VectorXd& x0, const VectorXd& v0, const VectorXd& a0, const VectorXd& x1,
                 const VectorXd& v1, const VectorXd& a1, double s) const {
    const double s3 = s * s * s;
    const double r = 1 - s;
    const double r3 = r * r * r;
    const double b1 = s3 * (10 + s * (-15 + 6 * s));
    return x0 + b1 * (x1 - x0) + h_ * s * r3 * (1 + 3 * s) * v0 - h_ * r * s3 * (1 + 3 * r) * v1 +
           h_ * h_ / 2 * (s * s * r3 * a0 + r * r * s3 * a1);
  }

  const Knot& k0_;
  const Knot& k1_;
  double h_;
  Quaterniond R0_;
  Vector3d phi_, phi_rate_, phi_acceleration_;
};

/// An independent check of plans on flat ground at z = 0 without obstacles. Its configurations are
/// far closer together than the verifier's samples. Velocities and accelerations are difference
/// quotients, the recursions are our own instead of Simbody's, and contact forces are projected
/// onto the cones. It allows what the verifier's documented tolerances and resolution allow, and a
/// little more.
class PlanOracle {
 public:
  PlanOracle(const models::RobotModel& robot, const models::Scenario& scenario)
      : robot_(robot),
        scenario_(scenario),
        weight_(robot.TotalMass() * dynamics::kGravity),
        kinematics_(robot),
        checker_(robot, scenario.environment) {}

  /// What is wrong with the plan, in one line; empty if nothing is.
  std::string FaultOf(const Plan& plan) {
    fault_.clear();
    footprints_.clear();
    flight_start_ = flight_known_ = -1;
    const Phase* before = nullptr;
    position_jumps_ = velocity_jumps_ = 0;
    for (const Segment& segment : plan.segments) {
      for (const Phase& phase : segment.phases) {
        if (before != nullptr) JudgeMeeting(*before, phase);
        JudgePhase(phase);
        if (!fault_.empty()) return fault_;
        before = &phase;
      }
    }
    JudgeEnds(plan);
    return fault_;
  }

 private:
  using Vector3d = Eigen::Vector3d;
  using VectorXd = Eigen::VectorXd;
  using Matrix3Xd = Eigen::Matrix3Xd;

  static constexpr int kLeastSteps = 24;     // between two knots
  static constexpr double kStep = 1e-3;      // s, at most
  static constexpr double kQuotient = 0.02;  // of an interval: the step of difference quotients
  static constexpr double kBalance = 0.02;   // of the weight
  static constexpr double kSlack = 0.05;     // of a torque limit

  void Require(double value, double limit, double t, const std::string& what) {
    if (value <= limit || !fault_.empty()) return;
    fault_ = fmt::format("{} is {:.6g}, not {:.6g}, at {:.6f} s", what, value, limit, t);
  }

  void JudgeMeeting(const Phase& before, const Phase& after) {
    const Knot& k0 = before.knots.back();
    const Knot& k1 = after.knots.front();
    Require(std::abs(k1.t - k0.t), 1.1e-9, k1.t, "jump of time");
    const VectorXd dq = OracleMotion::Difference(k0.q, k1.q);
    position_jumps_ += dq.segment<3>(3).norm();
    Require(position_jumps_, 1.1e-6, k1.t, "sum of the root's jumps");
    Require(dq.lpNorm<Eigen::Infinity>(), 1.1e-6, k1.t, "jump of position");
    const VectorXd dv = k1.v - k0.v;
    if (after.impulses.cols() > 0) return JudgeImpact(dv, after);
    velocity_jumps_ += dv.segment<3>(3).norm();
    Require(velocity_jumps_, 1.1e-6, k1.t, "sum of the root's jumps of velocity");
    Require(dv.lpNorm<Eigen::Infinity>(), 1.1e-6, k1.t, "jump of velocity");
  }

  void JudgeImpact(const VectorXd& dv, const Phase& phase) {
    const Knot& knot = phase.knots.front();
    kinematics_.SetPosition(knot.q);
    kinematics_.SetVelocity(VectorXd::Zero(robot_.nv()));
    VectorXd rest = dynamics::NewtonEuler(kinematics_, dv) -
                    dynamics::NewtonEuler(kinematics_, VectorXd::Zero(dv.size()));
    const std::vector<BearingPoint> points = BearingPoints(robot_, phase);
    for (std::size_t i = 0; i < points.size(); ++i) {
      kinematics_.AddPointForce(points[i].link, points[i].p_L, -phase.impulses.col(i), &rest);
      JudgeCone(phase.impulses.col(i), 1.1e-6 * weight_, knot.t, "impulse");
    }
    Require(rest.lpNorm<Eigen::Infinity>(), 1.1e-6 * weight_, knot.t, "momentum off the impulses");
  }

  void JudgeCone(const Vector3d& force, double tolerance, double t, const std::string& what) {
    Require(-force.z(), tolerance, t, what + " pulling");
    Require(force.head<2>().norm() - robot_.friction * std::max(force.z(), 0.0), tolerance, t,
            what + " beyond friction");
  }

  void JudgePhase(const Phase& phase) {
    const std::vector<BearingPoint> points = BearingPoints(robot_, phase);
    if (phase.contacts.empty() && flight_start_ < 0) flight_start_ = phase.knots.front().t;
    if (!phase.contacts.empty()) flight_start_ = -1;
    for (std::size_t i = 0; i + 1 < phase.knots.size() && fault_.empty(); ++i) {
      const Knot& k0 = phase.knots[i];
      const Knot& k1 = phase.knots[i + 1];
      if (!(k1.t > k0.t)) {
        fault_ = "time stands still";
        return;
      }
      JudgeInterval(k0, k1, points);
    }
  }

  void JudgeInterval(const Knot& k0, const Knot& k1, const std::vector<BearingPoint>& points) {
    const OracleMotion motion(k0, k1);
    const int steps = std::max(kLeastSteps, static_cast<int>(std::ceil(motion.duration() / kStep)));
    for (int step = 0; step <= steps && fault_.empty(); ++step) {
      const double s = std::clamp(static_cast<double>(step) / steps, kQuotient, 1 - kQuotient);
      const double dt = kQuotient * motion.duration();
      const VectorXd before = motion.At(s - kQuotient);
      const VectorXd q = motion.At(s);
      const VectorXd after = motion.At(s + kQuotient);
      const VectorXd v = OracleMotion::Difference(before, after) / (2 * dt);
      const VectorXd a =
          (OracleMotion::Difference(q, after) + OracleMotion::Difference(q, before)) / (dt * dt);
      const double t = k0.t + s * motion.duration();
      JudgeLimits(q, v, t);
      // Rounding of the second difference.
      const double noise = 1e-15 / (dt * dt);
      kinematics_.SetPosition(q);
      kinematics_.SetVelocity(v);
      JudgeContacts(points, t);
      JudgeGround(t);
      JudgeForces((1 - s) * k0.forces + s * k1.forces, points, a, noise, t);
      if (points.empty()) JudgeFlight(t);
      if (step % 6 == 0) JudgeCollisions(t);
    }
  }

  void JudgeLimits(const VectorXd& q, const VectorXd& v, double t) {
    for (int j = 0; j < robot_.num_joints(); ++j) {
      const models::Joint& joint = robot_.joints[j];
      Require(q[7 + j], joint.upper + 1.1e-6, t, joint.name);
      Require(-q[7 + j], -joint.lower + 1.1e-6, t, joint.name);
      Require(std::abs(v[6 + j]), joint.velocity * (1 + 1e-6) + 1e-5, t, joint.name + " speed");
    }
    Require(v.head<3>().norm(), 20.001, t, "root angular speed");
    Require(v.segment<3>(3).norm(), 20.001, t, "root speed");
  }

  /// A point that is set down stays there until it is more than 1 mm above the ground.
  void JudgeContacts(const std::vector<BearingPoint>& points, double t) {
    std::set<std::pair<int, int>> listed;
    for (const BearingPoint& point : points) {
      const std::pair<int, int> key(point.patch, point.index);
      listed.insert(key);
      const Vector3d p = kinematics_.Position(point.link, point.p_L);
      const std::string name = NameOf(robot_, point);
      const Vector3d anchor = footprints_.emplace(key, p).first->second;
      Require((p - anchor).norm(), 1.2e-3, t, name + " moved");
      Require(kinematics_.Velocity(point.link, point.p_L).norm(), 2.6e-3, t, name + " speed");
      Require(std::abs(p.z()), 1.15e-3, t, name + " off the ground");
      Require(p.head<2>().lpNorm<Eigen::Infinity>(), 2 + 1e-4, t, name + " beyond the floor");
    }
    for (auto it = footprints_.begin(); it != footprints_.end();) {
      const models::ContactPatch& patch = robot_.contacts[it->first.first];
      const double z = kinematics_.Position(patch.link, patch.points[it->first.second]).z();
      it = listed.count(it->first) == 0 && z > 1e-3 ? footprints_.erase(it) : std::next(it);
    }
  }

  void JudgeGround(double t) {
    for (int link = 0; link < robot_.num_links(); ++link) {
      const bool bears = std::any_of(robot_.contacts.begin(), robot_.contacts.end(),
                                     [&](const auto& patch) { return patch.link == link; });
      for (const models::PosedShape& posed : robot_.links[link].shapes) {
        const Eigen::Isometry3d X = kinematics_.X_WL()[link] * posed.X_PS;
        Require(-posed.shape.Bounds(X).min().z(), bears ? 1.3e-3 : 2e-4, t,
                robot_.links[link].name + " in the ground");
      }
    }
  }

  void JudgeCollisions(double t) {
    for (const models::Proximity& pair : checker_.SelfProximities(kinematics_.X_WL(), 0)) {
      Require(-pair.distance, 1.8e-4, t, robot_.links[pair.link].name + " in another link");
    }
  }

  Vector3d Projected(Vector3d force) const {
    const double tangential = force.head<2>().norm();
    const double mu = robot_.friction;
    if (tangential <= mu * force.z()) return force;
    const double normal = (mu * tangential + force.z()) / (1 + mu * mu);
    if (normal <= 0) return Vector3d::Zero();
    force.head<2>() *= mu * normal / tangential;
    force.z() = normal;
    return force;
  }

  /// The ground must be able to supply what the motion takes, with forces near the declared ones.
  /// The motors must be able to supply the rest.
  void JudgeForces(Matrix3Xd forces, const std::vector<BearingPoint>& points, const VectorXd& a,
                   double noise, double t) {
    const VectorXd wanted = dynamics::NewtonEuler(kinematics_, a);
    const Vector3d origin = kinematics_.X_WL()[0].translation();
    Matrix3Xd arms(3, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      arms.col(i) = kinematics_.Position(points[i].link, points[i].p_L) - origin;
    }
    const auto missing = [&] {
      VectorXd rest = wanted.head<6>();
      for (Eigen::Index i = 0; i < forces.cols(); ++i) {
        const Vector3d arm = arms.col(i);
        const Vector3d force = forces.col(i);
        rest.head<3>() -= arm.cross(force);
        rest.tail<3>() -= force;
      }
      return rest;
    };
    const double tolerance = (kBalance + noise) * weight_;
    // Projected gradient on half the square of the residual.
    const double step = 1 / (forces.cols() + arms.squaredNorm() + 1e-9);
    for (Eigen::Index i = 0; i < forces.cols(); ++i) forces.col(i) = Projected(forces.col(i));
    VectorXd rest = missing();
    for (int round = 0; round < 3000 && rest.lpNorm<Eigen::Infinity>() > tolerance; ++round) {
      for (Eigen::Index i = 0; i < forces.cols(); ++i) {
        const Vector3d arm = arms.col(i);
        const Vector3d moment = rest.head<3>();
        forces.col(i) = Projected(forces.col(i) + step * (rest.tail<3>() - arm.cross(moment)));
      }
      rest = missing();
    }
    Require(rest.lpNorm<Eigen::Infinity>(), tolerance, t, "wrench without a force");
    VectorXd torques = wanted;
    for (std::size_t i = 0; i < points.size(); ++i) {
      kinematics_.AddPointForce(points[i].link, points[i].p_L, -forces.col(i), &torques);
    }
    for (int j = 0; j < robot_.num_joints(); ++j) {
      const models::Joint& joint = robot_.joints[j];
      Require(std::abs(torques[6 + j]), (1 + kSlack + noise) * joint.effort + 0.01 * weight_, t,
              joint.name + " torque");
    }
  }

  void JudgeFlight(double t) {
    const Vector3d p = kinematics_.CentreOfMass();
    const Vector3d v = kinematics_.CentreOfMassVelocity();
    if (flight_start_ != flight_known_) {
      flight_known_ = flight_start_;
      flight_time_ = t;
      flight_position_ = p;
      flight_velocity_ = v;
    }
    const double passed = t - flight_time_;
    const Vector3d expected = flight_position_ + passed * flight_velocity_ -
                              Vector3d(0, 0, dynamics::kGravity * passed * passed / 2);
    // The velocity at the start is a difference quotient.
    Require((p - expected).norm(), 3e-4, t, "centre of mass off its parabola");
  }

  void JudgeEnds(const Plan& plan) {
    const Knot& first = plan.segments.front().phases.front().knots.front();
    const Knot& last = plan.segments.back().phases.back().knots.back();
    const auto judge = [&](const Knot& knot, const models::Stance& stance, const char* what) {
      Require(std::abs(knot.q[4] - stance.x), 1.1e-3, knot.t, std::string(what) + " x");
      Require(std::abs(knot.q[5] - stance.y), 1.1e-3, knot.t, std::string(what) + " y");
      Require(knot.v.lpNorm<Eigen::Infinity>(), 1.1e-6, knot.t, std::string(what) + " speed");
    };
    Require(std::abs(first.t), 1e-8, 0, "start");
    judge(first, scenario_.start, "start");
    judge(last, scenario_.goals[plan.goal], "goal");
  }

  const models::RobotModel& robot_;
  const models::Scenario& scenario_;
  double weight_;
  dynamics::TreeKinematics kinematics_;
  models::CollisionChecker checker_;
  std::string fault_;
  std::map<std::pair<int, int>, Vector3d> footprints_;  // where points were set down
  double position_jumps_ = 0;
  double velocity_jumps_ = 0;
  double flight_start_ = -1;  // s; below 0: something bears
  double flight_known_ = -1;
  double flight_time_ = 0;
  Vector3d flight_position_, flight_velocity_;
};

}  // namespace possibility::actions::testing
