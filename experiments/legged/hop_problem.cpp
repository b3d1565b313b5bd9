#include "experiments/legged/hop_problem.h"

#include <string>
#include <vector>

#include "collocation/problem/function_algebra.h"
#include "collocation/robot/balance_functions.h"
#include "collocation/robot/multibody_functions.h"
#include "experiments/legged/legged_models.h"
#include "experiments/legged/legged_problem.h"

namespace possibility::experiments {

using namespace collocation;  // reads like the mathematics

namespace {

using Eigen::MatrixXd;

constexpr int kHopperSize = 5;  // pitch of the leg, x and z of the foot, leg, hip
constexpr double kFriction = 0.7;
constexpr double kStance = 0.6;  // s, before and after the flight

/// |fx| <= friction * fz.
std::shared_ptr<Function> Cone(double friction) {
  return Differentiated<2, 2>([friction](const auto& f, auto* g) {
    (*g)[0] = friction * f[1] + f[0];
    (*g)[1] = friction * f[1] - f[0];
  });
}

struct HopPhase {
  Phase* phase = nullptr;
  Variables q, v, a;
};

/// Upright, the leg half extended.
Eigen::Vector<double, kHopperSize> Balanced() { return {0, 0, 0, 0.5, 0}; }

HopPhase AddHopPhase(const RobotSystem& model, const std::string& name, Bounds duration,
                     OptimalControlProblem* problem) {
  HopPhase hop;
  hop.phase = &problem->AddPhase(name, 2);
  hop.phase->SetDuration(duration);
  const Eigen::Vector<double, kHopperSize> posture = Balanced();
  const std::vector<std::string> base = {"pitch", "x", "z"};
  for (int i = 0; i < kHopperSize; ++i) {
    const bool is_joint = i >= 3;
    const Bounds bounds = is_joint ? Bounds{model->lower()[i - 3], model->upper()[i - 3]}
                                   : Bounds{i == 2 ? 0.0 : -2.0, 2};  // the foot: never below
    hop.q.push_back(
        hop.phase->AddCoordinate(is_joint ? model->tree().joints[i - 3].name : base[i], bounds));
    hop.v.push_back(hop.phase->Rate(hop.q[i]));
    hop.a.push_back(hop.phase->Rate(hop.q[i], 2));
    hop.phase->SetScale(hop.v[i], 5);
    hop.phase->SetScale(hop.a[i], 50);
    hop.phase->Guess(hop.q[i], posture[i]);
  }
  return hop;
}

void AddHopDynamics(const RobotSystem& model, bool stands, HopPhase* hop) {
  constexpr double kForce = 150, kTorque = 20;
  Variables force;
  std::vector<dynamics::ContactPoint> foot;
  if (stands) {
    force = {hop->phase->AddControl("fx", {-1000, 1000}, kForce),
             hop->phase->AddControl("fz", {0, 2000}, kForce)};
    foot.push_back({0, Eigen::Vector3d::Zero()});
    hop->phase->Guess(force[0], 0);
    hop->phase->Guess(force[1], model->tree().TotalMass() * dynamics::kGravity);
    hop->phase->Constrain("cone", Cone(kFriction), force, {{0, kInfinity}}, At::kEverywhere,
                          {kForce});
  }
  const Variables torques = AddMotors(*model, {{kForce, 0.01}, {kTorque, 1}}, hop->phase);
  const Variables arguments = Joined({&hop->q, &hop->v, &hop->a, &force, &torques});
  const int inner = 3 * kHopperSize + static_cast<int>(force.size());
  const MatrixXd A = MatrixXd::Identity(inner, arguments.size());
  MatrixXd B = MatrixXd::Zero(kHopperSize, arguments.size());
  B.bottomRightCorner(2, 2) = -MatrixXd::Identity(2, 2);
  hop->phase->Constrain("motion", LinearExtension(EquationOfMotion(model, foot), A, B), arguments,
                        std::vector<Bounds>(kHopperSize, {0, 0}), At::kEverywhere,
                        {kTorque, kForce, kForce, kForce, kTorque});
}

/// The foot at (x, 0) from the phase's start to its end.
void Stand(double x, HopPhase* hop) {
  hop->phase->Fix(hop->q[1], x, At::kStart);
  hop->phase->Fix(hop->q[2], 0, At::kStart);
  for (const int i : {1, 2}) {
    hop->phase->Fix(hop->v[i], 0, At::kStart);
    hop->phase->Fix(hop->a[i], 0, At::kEverywhere);
  }
}

/// At rest, balanced on the foot.
void Rest(At at, HopPhase* hop) {
  const Eigen::Vector<double, kHopperSize> posture = Balanced();
  for (const int i : {0, 3, 4}) {
    hop->phase->Fix(hop->q[i], posture[i], at);
    hop->phase->Fix(hop->v[i], 0, at);
  }
}

void AddTouchdown(const RobotSystem& model, const HopPhase& flight, const HopPhase& landing,
                  OptimalControlProblem* problem) {
  const Variables impulse = {problem->AddParameter("impulse x", {-100, 100}, 10),
                             problem->AddParameter("impulse z", {0, 100}, 10, 10)};
  std::vector<VariableAt> arguments = EndsOf(flight.q, At::kEnd);
  Append(EndsOf(flight.v, At::kEnd), &arguments);
  Append(EndsOf(landing.v, At::kStart), &arguments);
  Append(EndsOf(impulse, At::kStart), &arguments);
  problem->Link("touchdown", ImpactMap(model, {{0, Eigen::Vector3d::Zero()}}), arguments,
                std::vector<Bounds>(kHopperSize, {0, 0}));
  problem->Link("impulse cone", Cone(kFriction), EndsOf(impulse, At::kStart),
                {{0, kInfinity}, {0, kInfinity}});
}

}  // namespace

std::unique_ptr<OptimalControlProblem> Hop(double distance) {
  auto problem = std::make_unique<OptimalControlProblem>("hop");
  const RobotSystem model = dynamics::MultibodyModel::Planar(Hopper());
  HopPhase push = AddHopPhase(model, "push", {kStance, kStance}, problem.get());
  HopPhase flight = AddHopPhase(model, "flight", {0.2, 0.5}, problem.get());
  HopPhase landing = AddHopPhase(model, "landing", {kStance, kStance}, problem.get());
  AddHopDynamics(model, true, &push);
  AddHopDynamics(model, false, &flight);
  AddHopDynamics(model, true, &landing);
  Stand(0, &push);
  Stand(distance, &landing);
  Rest(At::kStart, &push);
  Rest(At::kEnd, &landing);
  flight.phase->Guess(flight.phase->duration(), 0.3);
  flight.phase->Guess(flight.q[1], [distance](double s) { return distance * s; });
  flight.phase->Guess(flight.q[2], [](double s) { return 0.4 * s * (1 - s); });
  landing.phase->Guess(landing.q[1], distance);
  for (int i = 0; i < kHopperSize; ++i) {
    problem->Continue({push.q[i], At::kEnd}, {flight.q[i], At::kStart});
    problem->Continue({push.v[i], At::kEnd}, {flight.v[i], At::kStart});
    problem->Continue({flight.q[i], At::kEnd}, {landing.q[i], At::kStart});
  }
  AddTouchdown(model, flight, landing, problem.get());
  return problem;
}

}  // namespace possibility::experiments
