#include "actions/checks/impact_check.h"

#include <algorithm>
#include <cmath>

#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kEquationTolerance = 1e-6;     // of weight x 1 s (N s), or x 1 m (N m s)
constexpr double kImpulseConeTolerance = 1e-6;  // of weight x 1 s
constexpr double kStuckSpeed = 1e-4;            // m/s, of the points after the impact
constexpr double kEnergyTolerance = 1e-6;       // of weight x 1 m

struct Impact {
  const VectorXd& v_before;
  const Knot& after;
  const PhaseContacts& contacts;
  const Eigen::Matrix3Xd& impulses;
  Instant at;
};

/// Impulses transmitted by joints without a motor: the master bears its mimics' impulses.
void FoldMimics(const models::RobotModel& robot, VectorXd* rows) {
  for (int j = 0; j < robot.num_joints(); ++j) {
    const auto& mimic = robot.joints[j].mimic;
    if (!mimic) continue;
    (*rows)[6 + mimic->joint] += mimic->multiplier * (*rows)[6 + j];
    (*rows)[6 + j] = 0;
  }
}

/// `sum`: by row, over this and all earlier impacts.
void CheckEquation(const Impact& impact, const MatrixXd& mass, const models::RobotModel& robot,
                   const dynamics::SimbodyDynamics& dynamics, double weight, VectorXd* sum,
                   ViolationLog* log) {
  VectorXd rest = mass * (impact.after.v - impact.v_before);
  for (std::size_t i = 0; i < impact.contacts.points.size(); ++i) {
    const BearingPoint& point = impact.contacts.points[i];
    rest -= dynamics.PointJacobian(point.link, point.p_L).transpose() * impact.impulses.col(i);
  }
  FoldMimics(robot, &rest);
  *sum += rest.cwiseAbs();
  for (Eigen::Index row = 0; row < rest.size(); ++row) {
    log->RequireAtMost(ViolationKind::kImpact, impact.at, (*sum)[row], 0,
                       kEquationTolerance * weight, "N s or N m s", [&] {
                         const std::string name =
                             row < 6 ? std::string("root") : robot.joints[row - 6].name;
                         return name + " jump of momentum off the declared impulses";
                       });
  }
}

void CheckImpulse(const Vector3d& impulse, const Vector3d& normal, double friction,
                  const BearingPoint& point, const models::RobotModel& robot, double weight,
                  const Instant& at, ViolationLog* log) {
  const double tolerance = kImpulseConeTolerance * weight;
  const double blow = normal.dot(impulse);
  log->RequireAtLeast(ViolationKind::kImpact, at, blow, 0, tolerance, "N s",
                      [&] { return NameOf(robot, point) + " impulse pulls on the ground"; });
  log->RequireAtMost(ViolationKind::kImpact, at, (impulse - blow * normal).norm(),
                     friction * std::max(blow, 0.0), tolerance, "N s",
                     [&] { return NameOf(robot, point) + " tangential impulse"; });
}

/// Tolerated errors of impacts, summed over the plan: a small error at every phase could carry a
/// robot.
struct ImpactSums {
  VectorXd rest;          ///< nv, momentum not explained by impulses, N s or N m s
  double energy_won = 0;  ///< J
};

void CheckImpact(const Impact& impact, const models::RobotModel& robot, StateEvaluator* evaluator,
                 ImpactSums* sums, ViolationLog* log) {
  const double weight = robot.TotalMass() * dynamics::kGravity;
  if (!impact.contacts.lands) {
    log->Report(ViolationKind::kImpact, impact.at, "impact in which nothing comes down");
  }
  const VerifierState state = evaluator->Evaluate(impact.after);
  const MatrixXd mass = evaluator->dynamics().MassMatrix();
  CheckEquation(impact, mass, robot, evaluator->dynamics(), weight, &sums->rest, log);
  for (std::size_t i = 0; i < impact.contacts.points.size(); ++i) {
    const BearingPoint& point = impact.contacts.points[i];
    CheckImpulse(impact.impulses.col(i), impact.contacts.normals.col(i),
                 impact.contacts.friction[i], point, robot, weight, impact.at, log);
    log->RequireAtMost(ViolationKind::kImpact, impact.at, state.Velocity(point).norm(), 0,
                       kStuckSpeed, "m/s",
                       [&] { return NameOf(robot, point) + " not at rest after the impact"; });
  }
  const double before = 0.5 * impact.v_before.dot(mass * impact.v_before);
  const double after = 0.5 * impact.after.v.dot(mass * impact.after.v);
  sums->energy_won += std::max(after - before, 0.0);
  log->RequireAtMost(ViolationKind::kImpact, impact.at, sums->energy_won, 0,
                     kEnergyTolerance * weight, "J",
                     [] { return std::string("kinetic energy won in an impact"); });
}

}  // namespace

void CheckImpacts(const Plan& plan, const models::RobotModel& robot,
                  const std::vector<PhaseContacts>& contacts, StateEvaluator* evaluator,
                  ViolationLog* log) {
  ImpactSums sums{VectorXd::Zero(robot.nv())};
  const Knot* before = nullptr;
  std::size_t index = 0;
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    for (const Phase& phase : plan.segments[s].phases) {
      const Knot& after = phase.knots.front();
      if (phase.impulses.cols() > 0 && before != nullptr) {
        const Impact impact{
            before->v, after, contacts[index], phase.impulses, {static_cast<int>(s), after.t}};
        CheckImpact(impact, robot, evaluator, &sums, log);
      }
      before = &phase.knots.back();
      ++index;
    }
  }
}

}  // namespace possibility::actions
