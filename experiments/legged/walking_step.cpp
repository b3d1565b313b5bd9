#include "experiments/legged/walking_step.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "collocation/problem/function_algebra.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/placed_patch.h"
#include "collocation/robot/point_functions.h"
#include "collocation/robot/robot_phase.h"
#include "dynamics/sagittal/mirror_image.h"
#include "dynamics/tree/base_joints.h"
#include "dynamics/tree/floating_motion.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::experiments {
namespace {

using namespace collocation;  // reads like the mathematics
using dynamics::ContactPoint;
using dynamics::kNumBaseJoints;
using Eigen::Vector3d;
using Eigen::VectorXd;

bool IsAcross(const models::Joint& joint) { return std::abs(joint.axis.y()) == 1; }

/// How many of the joints that carry this one lie across the sagittal plane.
int SwingsAbove(const models::RobotModel& robot, int joint) {
  int swings = 0;
  for (int link = robot.joints[joint].parent; link > 0; link = robot.joints[link - 1].parent) {
    if (IsAcross(robot.joints[link - 1])) ++swings;
  }
  return swings;
}

std::vector<ContactPoint> SolePoints(const dynamics::MultibodyModel& model, int contact) {
  const models::ContactPatch& patch = model.tree().contacts[contact];
  std::vector<ContactPoint> points;
  points.reserve(patch.points.size());
  for (const Vector3d& p_L : patch.points) points.push_back({patch.link, p_L});
  return points;
}

std::vector<PointComponent> Heights(const std::vector<ContactPoint>& points) {
  std::vector<PointComponent> heights;
  heights.reserve(points.size());
  for (const ContactPoint& point : points) heights.push_back({point, Vector3d::UnitZ()});
  return heights;
}

class Step {
 public:
  Step(const models::RobotModel& robot, const WalkingStepSettings& settings)
      : robot_(robot),
        gait_(robot.GaitNamed("walk")),
        settings_(settings),
        model_(dynamics::MultibodyModel::OnJoints(robot, settings.joints == StepJoints::kAll
                                                             ? std::map<int, double>()
                                                             : StillArmJoints(robot, gait_))),
        stance_(SolePoints(*model_, gait_.limbs[0].contact)),
        swing_(SolePoints(*model_, gait_.limbs[1].contact)),
        nominal_(Nominal()),
        problem_(std::make_unique<OptimalControlProblem>("walking step")) {}

  std::unique_ptr<OptimalControlProblem> Build() {
    RobotLimits limits;
    limits.friction = robot_.friction;
    step_ = AddRobotPhase(problem_.get(), "single support", model_, stance_, limits,
                          Torques::kControls);
    step_.phase->SetDuration(settings_.duration);
    BoundTrunk();
    HoldStance();
    SwingOverTheGround();
    RepeatMirrored();
    AddCosts();
    GuessUpright();
    return std::move(problem_);
  }

 private:
  double length() const { return settings_.speed * settings_.duration; }

  VectorXd Nominal() const {
    VectorXd q = VectorXd::Zero(model_->nq());
    q[2] = gait_.posture.root_height;
    q[5] = gait_.posture.root_pitch;
    for (int i = 0; i < model_->num_joints(); ++i) {
      q[kNumBaseJoints + i] = gait_.posture.joints[model_->joints()[i] - kNumBaseJoints];
    }
    return q;
  }

  void BoundTrunk() {
    constexpr double kTilt = 0.2;  // rad
    constexpr double kRise = 0.1;  // m, above the posture
    for (const int angle : {3, 4, 5}) step_.phase->Bound(step_.q[angle], {-kTilt, kTilt});
    step_.phase->Bound(step_.q[2], {0, gait_.posture.root_height + kRise});
  }

  /// The sole stays where it is in the posture.
  void HoldStance() {
    const int contact = gait_.limbs[0].contact;
    const VectorXd none = VectorXd::Zero(model_->nv());
    dynamics::TreeKinematics kinematics(robot_);
    kinematics.SetPosition(dynamics::ToFloating(*model_, nominal_, none, none).q);
    const models::ContactPatch& patch = robot_.contacts[contact];
    const PlacedPatch sole = Place(*model_, contact, kinematics.X_WL()[patch.link] * patch.Frame());
    const std::vector<PointComponent> held = HoldingComponents(sole);
    std::vector<Bounds> at_place;
    for (const double place : HeldPlaces(sole)) at_place.push_back({place, place});
    const std::vector<Bounds> still(held.size(), Bounds{0, 0});
    step_.phase->Constrain("place", PointPositions(model_, held), step_.Positions(), at_place,
                           At::kStart);
    step_.phase->ConstrainKnots("still", PointVelocities(model_, held), step_.State(), still);
    step_.phase->ConstrainKnots("held", PointAccelerations(model_, held), step_.Motion(), still,
                                At::kEverywhere, {50});
  }

  /// Height above a bump that vanishes at both ends faster than any lift-off.
  void SwingOverTheGround() {
    const double height = settings_.clearance;
    const auto bump = Differentiated<1, 4>([height](const auto& share, auto* y) {
      const auto hill = 4.0 * share[0] * (1.0 - share[0]);
      for (auto& above : *y) above = -height * hill * hill * hill;
    });
    std::vector<Variable> arguments = step_.Positions();
    arguments.push_back(step_.phase->share());
    step_.phase->Constrain("clearance", SeparateSum(PointPositions(model_, Heights(swing_)), bump),
                           arguments, {{0, kInfinity}}, At::kInside);
  }

  /// The end is the mirror image of the start, one step ahead. That places the swing foot, too.
  void RepeatMirrored() {
    const dynamics::MirrorImage image = dynamics::MirrorImageOf(robot_, *model_);
    for (int i = 0; i < model_->nv(); ++i) {
      const double sign = image.sign[i];
      const auto difference = Differentiated<2, 1>(
          [sign](const auto& ends, auto* y) { (*y)[0] = ends[1] - sign * ends[0]; });
      const double ahead = i == 0 ? length() : 0;
      const int source = image.source[i];
      const std::string& name = problem_->NameOf(step_.q[i]);
      problem_->Link("again " + name, difference,
                     {{step_.q[source], At::kStart}, {step_.q[i], At::kEnd}}, {{ahead, ahead}});
      problem_->Link("rate again " + name, difference,
                     {{step_.v[source], At::kStart}, {step_.v[i], At::kEnd}}, {{0, 0}});
    }
  }

  void AddCosts() {
    constexpr double kSmall = 0.01;
    AddSquareCost("torque", step_.torques, 50, 1, step_.phase);
    AddSquareCost("acceleration", step_.a, 10, kSmall, step_.phase);
    AddSquareCost("force", step_.f, 400, kSmall, step_.phase);
    for (int i = kNumBaseJoints; i < model_->nv(); ++i) {
      const double rest = nominal_[i];
      step_.phase->AddIntegralCost("posture", Differentiated<1, 1>([rest](const auto& q, auto* c) {
                                     (*c)[0] = (q[0] - rest) * (q[0] - rest);
                                   }),
                                   {step_.q[i]}, kSmall);
    }
  }

  /// The posture, carried along at constant speed.
  void GuessUpright() {
    for (int i = 0; i < model_->nv(); ++i) step_.phase->Guess(step_.q[i], nominal_[i]);
    const double step = length();
    step_.phase->Guess(step_.q[0], [step](double s) { return (s - 0.5) * step; });
    step_.phase->Guess(step_.v[0], settings_.speed);
  }

  const models::RobotModel& robot_;
  const models::Gait& gait_;
  WalkingStepSettings settings_;
  RobotSystem model_;
  std::vector<ContactPoint> stance_, swing_;
  VectorXd nominal_;
  std::unique_ptr<OptimalControlProblem> problem_;
  RobotPhase step_;
};

}  // namespace

std::map<int, double> StillArmJoints(const models::RobotModel& robot, const models::Gait& gait) {
  std::set<int> legs;
  for (const models::GaitLimb& limb : gait.limbs) {
    legs.insert(limb.joints.begin(), limb.joints.end());
  }
  std::map<int, double> locked;
  for (const auto& pair : robot.sagittal_pairs) {
    for (const int joint : {pair.first, pair.second}) {
      const bool swings = IsAcross(robot.joints[joint]) && SwingsAbove(robot, joint) < 2;
      if (!legs.contains(joint) && !swings) locked[joint] = gait.posture.joints[joint];
    }
  }
  return locked;
}

std::unique_ptr<OptimalControlProblem> WalkingStep(const models::RobotModel& humanoid,
                                                   const WalkingStepSettings& settings) {
  return Step(humanoid, settings).Build();
}

}  // namespace possibility::experiments
