#include "experiments/legged/biped_step.h"

#include <cmath>
#include <string>
#include <vector>

#include "collocation/problem/function_algebra.h"
#include "collocation/robot/balance_functions.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/point_functions.h"
#include "experiments/legged/legged_models.h"
#include "experiments/legged/legged_problem.h"

namespace possibility::experiments {

using namespace collocation;  // reads like the mathematics

namespace {

using Eigen::MatrixXd;

/// The source's gravity is 9.81 m/s^2. The same motion, slower by this factor and with torques
/// smaller by its square, obeys ours; the integral of squared torques is smaller by its cube.
const double kSlower = std::sqrt(9.81 / dynamics::kGravity);

constexpr int kAngles = BipedStep::kAngles;
constexpr int kFull = 7;  // with the root's x and z, zero while the foot is in stance

using Angles = BipedStep::Angles;

/// (pitch, x, z, joints) = Full() angles.
MatrixXd Full() {
  MatrixXd full = MatrixXd::Zero(kFull, kAngles);
  full(0, 0) = 1;
  full.bottomRightCorner(4, 4).setIdentity();
  return full;
}

/// Angles after the legs exchange roles: the chain is read from its other end. Also valid for
/// rates; its own inverse.
MatrixXd Relabelling() {
  MatrixXd relabelled = MatrixXd::Zero(kAngles, kAngles);
  relabelled.row(0).setOnes();
  for (int i = 1; i < kAngles; ++i) relabelled(i, kAngles - i) = -1;
  return relabelled;
}

struct Biped {
  RobotSystem model = dynamics::MultibodyModel::Planar(FiveLinkBiped());
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

/// Inverse dynamics with the foot's force and the joints' torques as variables; no torque at the
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

/// Swing foot above the ground between the ends, moving up at first, touching down on the mark at
/// last.
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

/// After the impact of the swing foot the state equals the start with the legs' names exchanged.
/// The old stance foot takes off with a velocity that the impact determines.
void AddImpact(const Biped& biped, OptimalControlProblem* problem) {
  const Variables lifting = {problem->AddParameter("lifting vx", {-10, 10}),
                             problem->AddParameter("lifting vz", {-10, 10})};
  const Variables impulse = {problem->AddParameter("impulse x", {-100, 100}, 10),
                             problem->AddParameter("impulse z", {0, 100}, 10, 10)};
  std::vector<VariableAt> arguments = EndsOf(biped.q, At::kEnd);
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

}  // namespace

std::unique_ptr<OptimalControlProblem> FiveLinkStep(const BipedStep& step) {
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
  std::vector<VariableAt> angles = EndsOf(biped.q, At::kStart);
  Append(EndsOf(biped.q, At::kEnd), &angles);
  problem->Link("same posture", Differentiated<2 * kAngles, kAngles>([](const auto& z, auto* y) {
                  (*y)[0] = z[0] - z[5] - z[6] - z[7] - z[8] - z[9];
                  for (int i = 1; i < kAngles; ++i) (*y)[i] = z[i] + z[2 * kAngles - i];
                }),
                angles, std::vector<Bounds>(kAngles, {0, 0}));
  return problem;
}

}  // namespace possibility::experiments
