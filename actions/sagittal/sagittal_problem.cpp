#include "actions/sagittal/sagittal_problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "collocation/problem/function.h"
#include "collocation/robot/multibody_functions.h"
#include "collocation/robot/point_functions.h"

namespace possibility::actions {
namespace {

using collocation::At;
using collocation::Bounds;
using collocation::Differentiated;
using collocation::kInfinity;
using collocation::PointAccelerations;
using collocation::PointPositions;
using collocation::PointVelocities;
using collocation::Variable;
using dynamics::ContactPoint;
using Eigen::VectorXd;

constexpr Bounds kFree = {-kInfinity, kInfinity};
constexpr Bounds kZero = {0, 0};
constexpr double kAcceleration = 20;  // m/s^2, typical of a point

/// weights' z.
class LinearFunction : public collocation::Function {
 public:
  explicit LinearFunction(VectorXd weights)
      : Function(static_cast<int>(weights.size()), 1), weights_(std::move(weights)) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = weights_.dot(z); }
  void Jacobian(const VectorXd&, Eigen::MatrixXd* J) override { *J = weights_.transpose(); }
  void Hessian(const VectorXd&, const VectorXd&, Eigen::MatrixXd* H) override { H->setZero(); }
  collocation::Mask HessianMask() const override {
    return collocation::Mask::Constant(num_inputs(), num_inputs(), false);
  }

 private:
  VectorXd weights_;
};

/// Ground that is at least as high as the real one with the gap's edges moved slightly towards each
/// other.
collocation::SmoothStep StepBetween(const Bounds& gap, double height) {
  constexpr double kWidest = 0.1;  // m
  constexpr double kMargin = 0.05;
  const double third = (gap.upper - gap.lower) / 3;
  const double width = std::min(third, kWidest);
  const double margin = std::min(third, kMargin);
  return height > 0
             ? collocation::SmoothStep{gap.upper - margin - width, gap.upper - margin, height}
             : collocation::SmoothStep{gap.lower + margin, gap.lower + margin + width, height};
}

}  // namespace

Bounds GapBetween(const SagittalModel& model, double distance) {
  constexpr double kEdge = 1e-3;  // m, of ground beyond a contact
  double landing_begins = model.Position(model.heel(), model.landed()).x();
  for (const ContactPoint& hand : model.hands()) {
    landing_begins = std::min(landing_begins, model.Position(hand, model.landed()).x());
  }
  return {model.Position(model.toe(), model.ready()).x() + kEdge,
          distance + landing_begins - kEdge};
}

SagittalProblem::SagittalProblem(const std::string& name, const SagittalModel& model,
                                 double distance, double height, const SagittalSettings& settings)
    : model_(model), distance_(distance), height_(height), settings_(settings), problem_(name) {
  settings_.limits.min_normal_force = settings.least_point_load * model.units().force;
  if (height != 0) step_ = StepBetween(GapBetween(model, distance), height);
}

std::vector<ContactPoint> SagittalProblem::Feet() const { return {model_.heel(), model_.toe()}; }

std::vector<ContactPoint> SagittalProblem::FeetAndHands() const {
  std::vector<ContactPoint> points = Feet();
  points.insert(points.end(), model_.hands().begin(), model_.hands().end());
  return points;
}

void SagittalProblem::AddPhase(const std::string& name, const std::vector<ContactPoint>& points,
                               Bounds duration, double most_torque) {
  collocation::RobotLimits limits = settings_.limits;
  limits.torque_fraction = std::min(limits.torque_fraction, most_torque);
  phases_.push_back(collocation::AddRobotPhase(&problem_, name, model_.planar(), points, limits));
  phases_.back().phase->SetDuration(duration);
}

void SagittalProblem::StartAtRest(int phase) {
  const collocation::RobotPhase& robot = phases_[phase];
  for (int i = 0; i < static_cast<int>(robot.q.size()); ++i) {
    robot.phase->Fix(robot.q[i], model_.ready()[i], At::kStart);
    robot.phase->Fix(robot.v[i], 0, At::kStart);
    robot.phase->Fix(robot.a[i], 0, At::kStart);
  }
}

/// Bounds that hold points by their velocities. Heel and toe belong to one rigid sole, so the toe's
/// x would be a redundant row.
std::vector<Bounds> SagittalProblem::HeldSolesAnd(std::size_t hands) {
  std::vector<Bounds> bounds = {kZero, kZero, kFree, kZero};
  bounds.insert(bounds.end(), 2 * hands, kZero);
  return bounds;
}

std::vector<Bounds> SagittalProblem::HeldHands(std::size_t hands) {
  std::vector<Bounds> bounds(4, kFree);
  bounds.insert(bounds.end(), 2 * hands, kZero);
  return bounds;
}

void SagittalProblem::ContinueAccelerations(int from, int to) {
  const auto difference = std::make_shared<LinearFunction>(Eigen::Vector2d(1, -1));
  for (std::size_t i = 0; i < phases_[from].a.size(); ++i) {
    problem_.Link(fmt::format("acceleration {}", i), difference,
                  {{phases_[from].a[i], At::kEnd}, {phases_[to].a[i], At::kStart}}, {kZero});
  }
}

void SagittalProblem::HoldPoints(int phase, const std::vector<Bounds>& held, At at) {
  const collocation::RobotPhase& robot = phases_[phase];
  robot.phase->ConstrainKnots("contacts", PointVelocities(model_.planar(), robot.points),
                              robot.State(), held, at);
  robot.phase->ConstrainKnots("still", PointAccelerations(model_.planar(), robot.points),
                              robot.Motion(), held, At::kAfterStart, {kAcceleration});
}

void SagittalProblem::HoldSoles(int phase, At at) {
  HoldSoles(phase, at, {settings_.sole_margin, settings_.sole_margin});
}

void SagittalProblem::HoldSoles(int phase, At at, const SoleShares& least) {
  const collocation::RobotPhase& robot = phases_[phase];
  HoldPoints(phase, HeldSolesAnd(robot.points.size() - 2), at);
  robot.phase->Constrain(
      "centre of pressure", Differentiated<2, 2>([least](const auto& f, auto* g) {
        (*g)[0] = (1 - least.heel) * f[0] - least.heel * f[1];
        (*g)[1] = (1 - least.toe) * f[1] - least.toe * f[0];
      }),
      {robot.f[1], robot.f[3]}, {{0, kInfinity}}, At::kEverywhere, {model_.units().force});
}

void SagittalProblem::HoldFeetAndHands(int phase, At at) {
  HoldSoles(phase, at);
  for (std::size_t i = 0; i < model_.hands().size(); ++i) {
    KeepBent(phase, fmt::format("arm {}", i), model_.arms()[i], settings_.arm_reach, at);
    KeepUpright(phase, model_.hands()[i], at, fmt::format("tilt {}", i));
  }
}

void SagittalProblem::KeepUpright(int phase, const ContactPoint& hand, At at,
                                  const std::string& name) {
  const models::RobotModel& tree = model_.planar()->tree();
  // In the plane a link's angle is the sum of the angles of the joints that carry it.
  std::vector<Variable> angles = {phases_[phase].q[0]};
  VectorXd signs = VectorXd::Ones(1);
  double upright = model_.landed()[0];
  for (int link = hand.link; link > 0; link = tree.joints[link - 1].parent) {
    const double sign = tree.joints[link - 1].axis.y();
    angles.push_back(phases_[phase].q[3 + link - 1]);
    signs.conservativeResize(signs.size() + 1);
    signs[signs.size() - 1] = sign;
    upright += sign * model_.landed()[3 + link - 1];
  }
  phases_[phase].phase->Constrain(
      name, std::make_shared<LinearFunction>(signs), angles,
      {{upright - settings_.max_hand_tilt, upright + settings_.max_hand_tilt}}, at);
}

void SagittalProblem::StartHeld(int phase, const std::vector<Bounds>& held) {
  const collocation::RobotPhase& robot = phases_[phase];
  robot.phase->Constrain("held", PointAccelerations(model_.planar(), robot.points), robot.Motion(),
                         held, At::kStart, {kAcceleration});
}

void SagittalProblem::StartPlaced(int phase, int first_point) {
  const collocation::RobotPhase& robot = phases_[phase];
  const std::vector<ContactPoint> points(robot.points.begin() + first_point, robot.points.end());
  std::vector<Bounds> places;
  for (const ContactPoint& point : points) {
    const double x = model_.Position(point, model_.landed()).x() + distance_;
    // The toe's x follows from the heel's.
    const bool is_toe = first_point == 0 && &point == &points[1];
    places.push_back(is_toe ? kFree : Bounds{x, x});
    places.push_back({height_, height_});
  }
  robot.phase->Constrain("touchdown", PointPositions(model_.planar(), points), robot.Positions(),
                         places, At::kStart);
}

void SagittalProblem::EndAtRest(int phase) {
  const collocation::RobotPhase& robot = phases_[phase];
  // With the contacts held, legs and bearing arms follow from the root. Fixes only the root and
  // what no contact determines.
  const VectorXd& q = model_.landed();
  robot.phase->Fix(robot.q[0], q[0], At::kEnd);
  robot.phase->Fix(robot.q[1], q[1] + distance_, At::kEnd);
  robot.phase->Fix(robot.q[2], q[2] + height_, At::kEnd);
  for (const Variable& v : robot.v) robot.phase->Fix(v, 0, At::kEnd);
  for (int i = 0; i < 3; ++i) robot.phase->Fix(robot.a[i], 0, At::kEnd);
  for (const int joint : FreeJointsAtRest()) {
    robot.phase->Fix(robot.q[3 + joint], q[3 + joint], At::kEnd);
    robot.phase->Fix(robot.a[3 + joint], 0, At::kEnd);
  }
}

std::vector<int> SagittalProblem::FreeJointsAtRest() const {
  const models::RobotModel& tree = model_.planar()->tree();
  std::set<int> held;
  const auto hold = [&](int link) {
    for (; link > 0; link = tree.joints[link - 1].parent) held.insert(link - 1);
  };
  hold(model_.heel().link);
  // A point leaves the link that it is on free to turn.
  for (const ContactPoint& hand : model_.hands()) hold(tree.joints[hand.link - 1].parent);
  std::vector<int> free;
  for (int joint = 0; joint < model_.planar()->num_joints(); ++joint) {
    if (!held.contains(joint)) free.push_back(joint);
  }
  return free;
}

void SagittalProblem::KeepAbove(int phase, const std::string& name,
                                const std::vector<ContactPoint>& points, double clearance, At at) {
  KeepAbove(phase, name, points, std::vector<double>(points.size(), clearance), at);
}

void SagittalProblem::KeepAbove(int phase, const std::string& name,
                                const std::vector<ContactPoint>& points,
                                const std::vector<double>& clearances, At at) {
  std::vector<Bounds> bounds;
  for (const double clearance : clearances) {
    if (!step_) bounds.push_back(kFree);  // x
    bounds.push_back({clearance, kInfinity});
  }
  phases_[phase].phase->Constrain(name,
                                  step_
                                      ? collocation::StepClearance(model_.planar(), points, *step_)
                                      : PointPositions(model_.planar(), points),
                                  phases_[phase].Positions(), bounds, at);
}

void SagittalProblem::KeepBodyAbove(int phase, At at) {
  std::vector<ContactPoint> points;
  std::vector<double> clearances;
  const auto guard = [&](const std::vector<SagittalModel::Guard>& guards) {
    for (const SagittalModel::Guard& guard : guards) {
      points.push_back(guard.point);
      clearances.push_back(guard.radius + settings_.body_clearance);
    }
  };
  guard(model_.guards());
  if (step_) guard(model_.middle_guards());
  KeepAbove(phase, "body", points, clearances, at);
}

void SagittalProblem::KeepHandsAbove(int phase, double clearance, At at) {
  KeepAbove(phase, "hands", model_.hands(), clearance, at);
  const double leaning = std::cos(settings_.max_hand_tilt);
  for (std::size_t i = 0; i < model_.peg_ends().size(); ++i) {
    const SagittalModel::Ball& end = model_.peg_ends()[i];
    if (end.radius == 0) continue;
    KeepAbove(phase, fmt::format("peg {}", i), {end.centre}, clearance + leaning * end.radius, at);
  }
}

void SagittalProblem::StayWithinRanges(int phase, At at) {
  const double margin = settings_.limits.joint_margin;
  collocation::RobotPhase& robot = phases_[phase];
  for (int joint = 0; joint < model_.planar()->num_joints(); ++joint) {
    // The stances themselves are fixed.
    const double begin = std::min(model_.ready()[3 + joint], model_.landed()[3 + joint]);
    const double end = std::max(model_.ready()[3 + joint], model_.landed()[3 + joint]);
    robot.phase->Bound(robot.q[3 + joint], {std::min(begin, model_.lower()[joint] + margin),
                                            std::max(end, model_.upper()[joint] - margin)});
  }
  for (std::size_t k = 0; k < model_.separations().size(); ++k) {
    const SagittalModel::Separation& pair = model_.separations()[k];
    robot.phase->Constrain(fmt::format("separation {}", k),
                           collocation::SquaredDistance(model_.planar(), pair.a, pair.b),
                           robot.Positions(), {{pair.distance * pair.distance, kInfinity}}, at);
  }
}

void SagittalProblem::KeepBent(int phase, const std::string& name, const SagittalModel::Limb& limb,
                               double reach, At at) {
  const double most = reach * limb.length;
  phases_[phase].phase->Constrain(
      name, collocation::SquaredDistance(model_.planar(), limb.root, limb.tip),
      phases_[phase].Positions(), {{0, most * most}}, at);
}

void SagittalProblem::AddCosts() {
  for (const collocation::RobotPhase& phase : phases_) {
    std::vector<Variable> joints(phase.a.begin() + 3, phase.a.end());
    joints.push_back(phase.a[0]);
    collocation::AddSquareCost("acceleration", joints, 10, 0.01, phase.phase);
    collocation::AddSquareCost("force", phase.f, model_.units().force, 0.01, phase.phase);
  }
}

Bounds SagittalProblem::Times(const Bounds& multiples) const {
  const double unit = model_.units().time();
  return {multiples.lower * unit, multiples.upper * unit};
}

void SagittalProblem::GuessLine(int phase, double duration, double from, double to) {
  const VectorXd& ready = model_.ready();
  VectorXd landed = model_.landed();
  landed[1] += distance_;
  landed[2] += height_;
  collocation::RobotPhase& robot = phases_[phase];
  robot.phase->Guess(robot.phase->duration(), duration * model_.units().time());
  for (int k = 0; k < static_cast<int>(robot.q.size()); ++k) {
    const double begin = ready[k] + from * (landed[k] - ready[k]);
    const double change = (to - from) * (landed[k] - ready[k]);
    robot.phase->Guess(robot.q[k], [begin, change](double s) { return begin + s * change; });
  }
}

}  // namespace possibility::actions
