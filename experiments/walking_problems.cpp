// Legged motion with rigid impacts: a periodic step of a biped and a hop from rest to rest. The
// trees' roots are at the standing feet (legged_models.h), so that coordinates hold a foot.
#include <cmath>

#include "collocation/multibody_functions.h"
#include "experiments/legged_models.h"
#include "experiments/linear_extension.h"
#include "experiments/regression_problems.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using Eigen::MatrixXd;
using ProblemPtr = std::unique_ptr<OptimalControlProblem>;
using Variables = std::vector<Variable>;

PlanarModel ModelOf(const models::RobotModel& tree) {
  return dynamics::MultibodyModel::Planar(tree);
}

Variables Joined(std::initializer_list<const Variables*> groups) {
  Variables all;
  for (const Variables* group : groups) all.insert(all.end(), group->begin(), group->end());
  return all;
}

std::vector<EndVariable> EndsOf(const Variables& variables, At at) {
  std::vector<EndVariable> ends;
  for (const Variable& variable : variables) ends.push_back({variable, at});
  return ends;
}

void Append(const std::vector<EndVariable>& more, std::vector<EndVariable>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

/// |fx| <= friction * fz.
std::shared_ptr<Function> Cone(double friction) {
  return Differentiated<2, 2>([friction](const auto& f, auto* g) {
    (*g)[0] = friction * f[1] + f[0];
    (*g)[1] = friction * f[1] - f[0];
  });
}

std::shared_ptr<Function> Square() {
  return Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; });
}

/// A motor: typical size of its torque or force, and the weight of its square in the cost.
struct Motor {
  double scale;
  double weight;
};

/// One control per joint within its effort, by joint.
Variables AddMotors(const dynamics::MultibodyModel& model, const std::vector<Motor>& motors,
                    Phase* phase) {
  Variables efforts;
  for (int i = 0; i < model.num_joints(); ++i) {
    const double effort = model.effort()[i];
    efforts.push_back(phase->AddControl("effort " + model.tree().joints[model.joints()[i]].name,
                                        {-effort, effort}, motors[i].scale));
    phase->Guess(efforts.back(), 0);
    phase->AddIntegralCost("effort", Square(), {efforts.back()}, motors[i].weight);
  }
  return efforts;
}

// ---- The biped's step. ----

/// The source's gravity is 9.81 m/s^2. The same motion, slower by this factor and with torques
/// smaller by its square, obeys ours; the integral of squared torques is smaller by its cube.
const double kSlower = std::sqrt(9.81 / dynamics::kGravity);

constexpr int kAngles = 5;  // pitch of the stance shank, then the joints
constexpr int kFull = 7;    // with the root's x and z, which are zero while the foot stands

using Angles = Eigen::Vector<double, kAngles>;

/// (pitch, x, z, joints) = Full() angles.
MatrixXd Full() {
  MatrixXd full = MatrixXd::Zero(kFull, kAngles);
  full(0, 0) = 1;
  full.bottomRightCorner(4, 4).setIdentity();
  return full;
}

/// Angles after the legs have changed their parts: the chain is read from its other end. The same
/// for rates, and its own inverse.
MatrixXd Relabelling() {
  MatrixXd relabelled = MatrixXd::Zero(kAngles, kAngles);
  relabelled.row(0).setOnes();
  for (int i = 1; i < kAngles; ++i) relabelled(i, kAngles - i) = -1;
  return relabelled;
}

struct Biped {
  PlanarModel model = ModelOf(FiveLinkBiped());
  std::vector<dynamics::ContactPoint> stance = {{0, Eigen::Vector3d::Zero()}};
  std::vector<dynamics::ContactPoint> swing = {{kSwingShank, SwingFoot()}};
  Variables q, v, a;
};

/// The guess: the line from `first` to the same posture, relabelled.
void AddAngles(const Angles& first, Biped* biped, Phase* phase) {
  const Angles last = Relabelling() * first;
  const dynamics::MultibodyModel& model = *biped->model;
  for (int i = 0; i < kAngles; ++i) {
    const std::string name = i == 0 ? "pitch" : model.tree().joints[i - 1].name;
    const Bounds bounds =
        i == 0 ? Bounds{-M_PI / 2, M_PI / 2} : Bounds{model.lower()[i - 1], model.upper()[i - 1]};
    biped->q.push_back(phase->AddCoordinate(name, bounds));
    biped->v.push_back(phase->Rate(biped->q[i]));
    biped->a.push_back(phase->Rate(biped->q[i], 2));
    phase->SetScale(biped->v[i], 3);
    phase->SetScale(biped->a[i], 30);
    phase->Guess(biped->q[i], [begin = first[i], change = last[i] - first[i]](double s) {
      return begin + s * change;
    });
  }
}

/// Inverse dynamics with the foot's force and the joints' torques for variables; no torque at the
/// foot.
void AddStance(const Biped& biped, Phase* phase) {
  constexpr double kForce = 300, kTorque = 30;
  const Variables force = {phase->AddControl("fx", {-1000, 1000}, kForce),
                           phase->AddControl("fz", {0, 2000}, kForce)};
  phase->Guess(force[1], biped.model->tree().TotalMass() * dynamics::kGravity);
  const Variables torques =
      AddMotors(*biped.model, std::vector<Motor>(4, {kTorque, std::pow(kSlower, 3)}), phase);
  const Variables arguments = Joined({&biped.q, &biped.v, &biped.a, &force, &torques});
  MatrixXd A = MatrixXd::Zero(3 * kFull + 2, arguments.size());
  MatrixXd B = MatrixXd::Zero(kFull, arguments.size());
  for (int k = 0; k < 3; ++k) A.block(kFull * k, kAngles * k, kFull, kAngles) = Full();
  A.block(3 * kFull, 3 * kAngles, 2, 2).setIdentity();
  B.bottomRightCorner(4, 4) = -MatrixXd::Identity(4, 4);
  phase->Constrain("motion", LinearExtension(EquationOfMotion(biped.model, biped.stance), A, B),
                   arguments, std::vector<Bounds>(kFull, {0, 0}), At::kEverywhere,
                   {kTorque, kForce, kForce, kTorque, kTorque, kTorque, kTorque});
}

/// Off the ground between the ends, up at first, down on the mark at last.
void AddSwingFoot(const Biped& biped, double length, Phase* phase) {
  const auto position =
      LinearExtension(PointPositions(biped.model, biped.swing), Full(), MatrixXd::Zero(2, kAngles));
  MatrixXd A = MatrixXd::Zero(2 * kFull, 2 * kAngles);
  A.topLeftCorner(kFull, kAngles) = A.bottomRightCorner(kFull, kAngles) = Full();
  const auto velocity =
      LinearExtension(PointVelocities(biped.model, biped.swing), A, MatrixXd::Zero(2, 2 * kAngles));
  const Bounds free;
  phase->Constrain("clearance", position, biped.q, {free, {0, kInfinity}}, At::kInside);
  phase->Constrain("step", position, biped.q, {{length, length}, {0, 0}}, At::kEnd);
  const Variables state = Joined({&biped.q, &biped.v});
  phase->Constrain("lift-off", velocity, state, {free, {0, kInfinity}}, At::kStart);
  phase->Constrain("landing", velocity, state, {free, {-kInfinity, 0}}, At::kEnd);
}

/// What follows the impact of the swing foot is the start again, the legs' names exchanged. The old
/// stance foot leaves the ground with a velocity that the impact decides.
void AddImpact(const Biped& biped, OptimalControlProblem* problem) {
  const Variables lifting = {problem->AddParameter("lifting vx", {-10, 10}),
                             problem->AddParameter("lifting vz", {-10, 10})};
  const Variables impulse = {problem->AddParameter("impulse x", {-100, 100}, 10),
                             problem->AddParameter("impulse z", {0, 100}, 10, 10)};
  std::vector<EndVariable> arguments = EndsOf(biped.q, At::kEnd);
  Append(EndsOf(biped.v, At::kStart), &arguments);
  Append(EndsOf(lifting, At::kStart), &arguments);
  const int kept = static_cast<int>(arguments.size());
  MatrixXd after = MatrixXd::Zero(kFull, kAngles + 2);  // of rates at the start and `lifting`
  after.leftCols(kAngles) = Full() * Relabelling();
  after.block(1, kAngles, 2, 2).setIdentity();
  MatrixXd A = MatrixXd::Zero(2 * kFull, kept);
  A.topLeftCorner(kFull, kAngles) = Full();
  A.bottomRightCorner(kFull, kAngles + 2) = after;
  const std::vector<Bounds> zeros(kFull, {0, 0});
  problem->Link(
      "new foot rests",
      LinearExtension(PointVelocities(biped.model, biped.swing), A, MatrixXd::Zero(2, kept)),
      arguments, {zeros[0], zeros[0]});

  Append(EndsOf(impulse, At::kStart), &arguments);
  Append(EndsOf(biped.v, At::kEnd), &arguments);
  const int all = static_cast<int>(arguments.size());
  A = MatrixXd::Zero(3 * kFull + 2, all);
  A.topLeftCorner(kFull, kAngles) = Full();
  A.block(kFull, kept + 2, kFull, kAngles) = Full();
  A.block(2 * kFull, kAngles, kFull, kAngles + 2) = after;
  A.block(3 * kFull, kept, 2, 2).setIdentity();
  problem->Link("impact",
                LinearExtension(ImpactMap(biped.model, biped.swing), A, MatrixXd::Zero(kFull, all)),
                arguments, zeros);
}

struct Step {
  double length;         ///< m
  double duration;       ///< s, in the source's gravity
  bool knees_bend_back;  ///< and never forward
  Angles first;          ///< where the guess begins
};

ProblemPtr FiveLinkStep(const Step& step) {
  auto problem = std::make_unique<OptimalControlProblem>("five-link step");
  Phase& phase = problem->AddPhase("swing", 2);
  phase.SetDuration(step.duration * kSlower);
  Biped biped;
  AddAngles(step.first, &biped, &phase);
  if (step.knees_bend_back) {
    phase.Bound(biped.q[1], {-M_PI, 0});
    phase.Bound(biped.q[4], {0, M_PI});
  }
  AddStance(biped, &phase);
  AddSwingFoot(biped, step.length, &phase);
  AddImpact(biped, problem.get());
  std::vector<EndVariable> angles = EndsOf(biped.q, At::kStart);
  Append(EndsOf(biped.q, At::kEnd), &angles);
  problem->Link("same posture", Differentiated<2 * kAngles, kAngles>([](const auto& z, auto* y) {
                  (*y)[0] = z[0] - z[5] - z[6] - z[7] - z[8] - z[9];
                  for (int i = 1; i < kAngles; ++i) (*y)[i] = z[i] + z[2 * kAngles - i];
                }),
                angles, std::vector<Bounds>(kAngles, {0, 0}));
  return problem;
}

// ---- The hop. ----

constexpr int kHopperSize = 5;  // pitch of the leg, x and z of the foot, leg, hip
constexpr double kFriction = 0.7;
constexpr double kStance = 0.6;  // s, before and after the flight

struct HopPhase {
  Phase* phase = nullptr;
  Variables q, v, a;
};

/// Upright, the leg half extended.
Eigen::Vector<double, kHopperSize> Balanced() { return {0, 0, 0, 0.5, 0}; }

HopPhase AddHopPhase(const PlanarModel& model, const std::string& name, Bounds duration,
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

void AddHopDynamics(const PlanarModel& model, bool stands, HopPhase* hop) {
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

void AddTouchdown(const PlanarModel& model, const HopPhase& flight, const HopPhase& landing,
                  OptimalControlProblem* problem) {
  const Variables impulse = {problem->AddParameter("impulse x", {-100, 100}, 10),
                             problem->AddParameter("impulse z", {0, 100}, 10, 10)};
  std::vector<EndVariable> arguments = EndsOf(flight.q, At::kEnd);
  Append(EndsOf(flight.v, At::kEnd), &arguments);
  Append(EndsOf(landing.v, At::kStart), &arguments);
  Append(EndsOf(impulse, At::kStart), &arguments);
  problem->Link("touchdown", ImpactMap(model, {{0, Eigen::Vector3d::Zero()}}), arguments,
                std::vector<Bounds>(kHopperSize, {0, 0}));
  problem->Link("impulse cone", Cone(kFriction), EndsOf(impulse, At::kStart),
                {{0, kInfinity}, {0, kInfinity}});
}

ProblemPtr Hop(double distance) {
  auto problem = std::make_unique<OptimalControlProblem>("hop");
  const PlanarModel model = ModelOf(Hopper());
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

}  // namespace

std::vector<RegressionProblem> WalkingProblems() {
  // Kelly's guess, his angles counted backwards, and one that bends the knees the other way.
  const Angles kelly(0.3, -1.0, 0.7, 0.5, 0.1);
  const Angles forward(-0.4, 0.5, 0, 0.3, 0);
  // The log of Ipopt and the log of SNOPT stopped at different extremals of one problem.
  const std::string logs = "OptimTraj, demo/fiveLinkBiped at 8c43235: logs of GPOPS-II";
  const std::vector<KnownOptimum> extremals = {{"knees forward", 263.69884582, 1e-6},
                                               {"knees backward", 302.25469438, 1e-6},
                                               {"knees straight", 338.994818, 3e-6}};
  return {
      {"five_link_step",
       "Kelly 2017, five-link biped; optimum ours: both linear solvers, and a mesh of 160 "
       "intervals",
       {{"global", 469.6501, 1e-5}},
       [=] {
         return FiveLinkStep({0.5, 0.7, true, kelly});
       },
       30},
      {"five_link_step_short", logs, extremals,
       [=] {
         return FiveLinkStep({0.4, 0.6, false, kelly});
       },
       30},
      {"five_link_step_forward", logs, extremals,
       [=] {
         return FiveLinkStep({0.4, 0.6, false, forward});
       },
       30},
      {"planar_hop",
       "ours: both linear solvers, and a mesh of 240 intervals per phase",
       {{"global", 305.2258, 1e-5}},
       [] { return Hop(0.4); },
       60},
  };
}

}  // namespace possibility::experiments
