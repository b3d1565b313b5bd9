#include "experiments/exports/sto_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "actions/evidence/verifier_state.h"

namespace possibility::experiments {
namespace {

using Eigen::Vector3d;

constexpr double kLeastCosine = 1e-6;  // of the second angle: below, rates have no limit

/// The angle that differs from `angle` by full turns and is nearest to `reference`.
double Unwound(double angle, double reference) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return angle + kTurn * std::round((reference - angle) / kTurn);
}

Vector3d Unwound(const Vector3d& angles, const Vector3d& reference) {
  return {Unwound(angles[0], reference[0]), Unwound(angles[1], reference[1]),
          Unwound(angles[2], reference[2])};
}

void AppendTo(const Vector3d& numbers, std::vector<double>* row) {
  row->insert(row->end(), numbers.begin(), numbers.end());
}

}  // namespace

Vector3d BodyFixedAngles::Of(const Eigen::Matrix3d& rotation) {
  const double second = std::asin(std::clamp(rotation(0, 2), -1.0, 1.0));
  const Vector3d angles(std::atan2(-rotation(1, 2), rotation(2, 2)), second,
                        std::atan2(-rotation(0, 1), rotation(0, 0)));
  // The same rotation, beyond a quarter turn about y.
  const Vector3d other(angles[0] + std::numbers::pi, std::numbers::pi - second,
                       angles[2] + std::numbers::pi);
  const Vector3d near = Unwound(angles, last_);
  const Vector3d far = Unwound(other, last_);
  last_ = (near - last_).norm() <= (far - last_).norm() ? near : far;
  return last_;
}

Vector3d BodyFixedAngles::Rates(const Vector3d& angular_velocity) const {
  const double a = last_[0];
  const double b = last_[1];
  // w = a' x + b' Rx y + c' Rx Ry z
  const double cosine = std::copysign(std::max(std::abs(std::cos(b)), kLeastCosine), std::cos(b));
  const Vector3d& w = angular_velocity;
  const double third = (std::cos(a) * w.z() - std::sin(a) * w.y()) / cosine;
  return {w.x() - std::sin(b) * third, std::cos(a) * w.y() + std::sin(a) * w.z(), third};
}

PatchLoad LoadOf(const Eigen::Matrix3Xd& points, const Eigen::Matrix3Xd& forces) {
  PatchLoad load;
  if (points.cols() == 0) return load;
  load.force = forces.rowwise().sum();
  const Eigen::VectorXd magnitudes = forces.colwise().norm();
  load.centre = points.rowwise().mean();
  if (magnitudes.sum() > 0) load.centre = points * magnitudes / magnitudes.sum();
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    load.moment += Vector3d(points.col(i) - load.centre).cross(Vector3d(forces.col(i)));
  }
  return load;
}

StoTable::StoTable(const models::RobotModel& robot) : robot_(robot), kinematics_(robot) {
  labels_ = {"time"};
  for (const char* quantity : {"value", "speed"}) {
    for (const char* coordinate : {"rx", "ry", "rz", "tx", "ty", "tz"}) {
      labels_.push_back(fmt::format("/jointset/root_joint/root_{}/{}", coordinate, quantity));
    }
    for (const models::Joint& joint : robot.joints) {
      labels_.push_back(fmt::format("/jointset/{0}/{0}/{1}", joint.name, quantity));
    }
  }
  for (const models::Joint& joint : robot.joints) {
    labels_.push_back(fmt::format("/forceset/{}", joint.name));
  }
  for (const models::ContactPatch& patch : robot.contacts) {
    for (const char* kind : {"force_{}_v", "force_{}_p", "torque_{}_"}) {
      for (const char axis : {'x', 'y', 'z'}) {
        labels_.push_back("ground_" + fmt::format(fmt::runtime(kind), patch.name) + axis);
      }
    }
  }
}

std::vector<double> StoTable::Row(const PlanSample& sample) {
  const actions::Knot& knot = sample.knot;
  kinematics_.SetPosition(knot.q);
  std::vector<double> row = {knot.t};
  AppendTo(angles_.Of(kinematics_.X_WL()[0].linear()), &row);
  row.insert(row.end(), knot.q.data() + 4, knot.q.data() + knot.q.size());
  AppendTo(angles_.Rates(knot.v.head<3>()), &row);
  row.insert(row.end(), knot.v.data() + 3, knot.v.data() + knot.v.size());
  row.insert(row.end(), knot.tau.begin(), knot.tau.end());
  const std::vector<actions::BearingPoint> bearing = actions::BearingPoints(robot_, *sample.phase);
  for (int patch = 0; patch < static_cast<int>(robot_.contacts.size()); ++patch) {
    Eigen::Matrix3Xd points(3, 0);
    Eigen::Matrix3Xd forces(3, 0);
    for (std::size_t i = 0; i < bearing.size(); ++i) {
      if (bearing[i].patch != patch) continue;
      points.conservativeResize(3, points.cols() + 1);
      forces.conservativeResize(3, points.cols());
      points.rightCols<1>() = kinematics_.Position(bearing[i].link, bearing[i].p_L);
      forces.rightCols<1>() = knot.forces.col(static_cast<Eigen::Index>(i));
    }
    const PatchLoad load = LoadOf(points, forces);
    for (const Vector3d& part : {load.force, load.centre, load.moment}) AppendTo(part, &row);
  }
  return row;
}

}  // namespace possibility::experiments
