#include "actions/gait/stride.h"

#include <algorithm>
#include <cmath>

namespace possibility::actions {
namespace {

using Eigen::Vector2d;

/// Tolerance of the classes of strides, m or rad.
constexpr double kNegligible = 1e-6;

/// Bounds may be exceeded by rounding.
constexpr double kRounding = 1e-9;

PlanarPose Displacement(const PlanarPose& from, const PlanarPose& to) {
  const Vector2d d = from.rotation().inverse() * Vector2d(to.position() - from.position());
  return {d.x(), d.y(), WrapAngle(to.yaw - from.yaw)};
}

/// Whether `count` equal strides along `whole` are all within the bounds. They turn evenly and keep
/// the direction of the whole way, which in the stance frame turns the opposite way.
bool Fit(const models::GaitParameters& parameters, const PlanarPose& whole, int count) {
  for (int i = 0; i < count; ++i) {
    const Vector2d d = Eigen::Rotation2Dd(-whole.yaw * i / count) * whole.position() / count;
    if (StrideEffort(parameters, {d.x(), d.y(), whole.yaw / count}) > 1 + kRounding) return false;
  }
  return true;
}

}  // namespace

bool Includes(StrideClass strides, const PlanarPose& d) {
  const bool ahead = std::abs(d.x) > kNegligible;
  const bool aside = std::abs(d.y) > kNegligible;
  const bool turns = std::abs(d.yaw) > kNegligible;
  switch (strides) {
    case StrideClass::kStraight:
      return !aside && !turns;
    case StrideClass::kSideways:
      return !ahead && !turns;
    case StrideClass::kOblique:
      return !turns;
    case StrideClass::kTurn:
      return !ahead && !aside;
    case StrideClass::kAny:
      return true;
  }
  return false;
}

bool KeepsHeading(StrideClass strides) {
  return strides != StrideClass::kTurn && strides != StrideClass::kAny;
}

double StrideEffort(const models::GaitParameters& parameters, const PlanarPose& d) {
  return std::abs(d.x) / parameters.forward + std::abs(d.y) / parameters.lateral +
         std::abs(d.yaw) / parameters.turn;
}

StrideClass ClassOfStrides(const PlanarPose& from, const PlanarPose& to) {
  const PlanarPose whole = Displacement(from, to);
  return *std::find_if(kStrideClasses.begin(), kStrideClasses.end(),
                       [&](StrideClass strides) { return Includes(strides, whole); });
}

int StrideCount(const models::GaitParameters& parameters, const PlanarPose& from,
                const PlanarPose& to) {
  const PlanarPose whole = Displacement(from, to);
  const double effort = StrideEffort(parameters, whole);
  if (effort < kRounding) return 0;
  const auto whole_number = [](double number) {
    return std::max(1, static_cast<int>(std::ceil(number)));
  };
  if (Includes(StrideClass::kOblique, whole)) return whole_number(effort / (1 + kRounding));
  // Later directions may use the bounds better, by a factor of sqrt(2) at most.
  int count = whole_number(effort / std::sqrt(2.0) - kRounding);
  while (!Fit(parameters, whole, count)) ++count;
  return count;
}

std::vector<PlanarPose> PlanStrides(const models::GaitParameters& parameters,
                                    const PlanarPose& from, const PlanarPose& to) {
  const int count = StrideCount(parameters, from, to);
  std::vector<PlanarPose> strides = {from};
  for (int i = 1; i <= count; ++i) {
    strides.push_back(Interpolate(from, to, static_cast<double>(i) / count));
  }
  return strides;
}

}  // namespace possibility::actions
