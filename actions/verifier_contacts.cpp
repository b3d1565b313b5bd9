#include "actions/verifier_contacts.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr double kMotion = 1e-3;         // m, since the bearing began
constexpr double kSlip = 2e-3;           // m/s
constexpr double kHeight = 1e-3;         // m
constexpr double kEdgeTolerance = 1e-6;  // m

void CheckGround(const Vector3d& p, const BearingPoint& point, const models::RobotModel& robot,
                 const models::GroundMap& ground, const Instant& at, ViolationLog* log) {
  // The highest level within reach wins in LevelAt, so abutting faces at one height are no seam.
  if (ground.LevelAt(p.head<2>(), p.z(), kHeight)) return;
  const std::vector<double>& levels = ground.levels();
  int nearest = -1;
  for (int level = 0; level < static_cast<int>(levels.size()); ++level) {
    if (nearest < 0 || std::abs(levels[level] - p.z()) < std::abs(levels[nearest] - p.z())) {
      nearest = level;
    }
  }
  if (nearest < 0) {
    log->Report(ViolationKind::kContactGround, at, NameOf(robot, point) + ", no ground at all");
    return;
  }
  const bool on_height = log->RequireAtMost(
      ViolationKind::kContactGround, at, std::abs(levels[nearest] - p.z()), 0, kHeight, "m",
      [&] { return NameOf(robot, point) + " above or below the nearest ground"; });
  if (!on_height) return;
  log->RequireAtLeast(ViolationKind::kContactGround, at, ground.Clearance(nearest, p.head<2>()), 0,
                      kEdgeTolerance, "m",
                      [&] { return NameOf(robot, point) + " beyond the edge of the ground"; });
}

}  // namespace

std::vector<PhaseContacts> FollowContacts(const Plan& plan, const models::RobotModel& robot,
                                          StateEvaluator* evaluator) {
  std::vector<PhaseContacts> result;
  std::map<std::pair<int, int>, Vector3d> bearing;  // (patch, point) -> anchor
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) {
      const VerifierState state = evaluator->Evaluate(phase.knots.front());
      PhaseContacts contacts;
      contacts.points = BearingPoints(robot, phase);
      contacts.anchors.resize(3, contacts.points.size());
      std::map<std::pair<int, int>, Vector3d> still_bearing;
      for (std::size_t i = 0; i < contacts.points.size(); ++i) {
        const BearingPoint& point = contacts.points[i];
        const std::pair<int, int> key(point.patch, point.index);
        const auto before = bearing.find(key);
        const Vector3d anchor = before != bearing.end() ? before->second : state.Position(point);
        contacts.anchors.col(i) = anchor;
        still_bearing[key] = anchor;
      }
      bearing = std::move(still_bearing);
      result.push_back(std::move(contacts));
    }
  }
  return result;
}

void CheckContacts(const VerifierState& state, const PhaseContacts& contacts,
                   const models::RobotModel& robot, const models::GroundMap& ground,
                   const Instant& at, ViolationLog* log) {
  for (std::size_t i = 0; i < contacts.points.size(); ++i) {
    const BearingPoint& point = contacts.points[i];
    const Vector3d p = state.Position(point);
    log->RequireAtMost(ViolationKind::kContactMotion, at, (p - contacts.anchors.col(i)).norm(), 0,
                       kMotion, "m", [&] { return NameOf(robot, point) + " moved while bearing"; });
    log->RequireAtMost(ViolationKind::kContactMotion, at, state.Velocity(point).norm(), 0, kSlip,
                       "m/s", [&] { return NameOf(robot, point) + " slips"; });
    CheckGround(p, point, robot, ground, at, log);
  }
}

}  // namespace possibility::actions
