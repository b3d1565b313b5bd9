#include "actions/checks/contacts_check.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "actions/plan/interpolation.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;

constexpr double kMotion = 1e-3;         // m, since the point was set down
constexpr double kSlip = 2e-3;           // m/s
constexpr double kPointHeight = 1e-3;    // m
constexpr double kEdgeTolerance = 1e-6;  // m
constexpr double kLiftOffStep = 5e-3;    // s, between tests of a point that may leave the ground

void CheckGround(const Vector3d& p, const BearingPoint& point, const models::RobotModel& robot,
                 const models::GroundMap& ground, const Instant& at, ViolationLog* log) {
  // LevelAt returns the highest level within reach, so abutting faces at one height form no seam.
  if (ground.LevelAt(p.head<2>(), p.z(), kPointHeight)) return;
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
      ViolationKind::kContactGround, at, std::abs(levels[nearest] - p.z()), 0, kPointHeight, "m",
      [&] { return NameOf(robot, point) + " above or below the nearest ground"; });
  if (!on_height) return;
  log->RequireAtLeast(ViolationKind::kContactGround, at, ground.Clearance(nearest, p.head<2>()), 0,
                      kEdgeTolerance, "m",
                      [&] { return NameOf(robot, point) + " beyond the edge of the ground"; });
}

/// (patch, point).
using PointKey = std::pair<int, int>;

/// Remembers where points were set down, until they leave the ground.
class Footprints {
 public:
  Footprints(const models::RobotModel& robot, const models::GroundMap& ground,
             StateEvaluator* evaluator)
      : robot_(robot), ground_(ground), evaluator_(evaluator) {}

  PhaseContacts Follow(const Phase& phase) {
    PhaseContacts contacts;
    contacts.points = BearingPoints(robot_, phase);
    contacts.anchors.resize(3, static_cast<Eigen::Index>(contacts.points.size()));
    const VerifierState state = evaluator_->Evaluate(phase.knots.front());
    for (std::size_t i = 0; i < contacts.points.size(); ++i) {
      const BearingPoint& point = contacts.points[i];
      contacts.anchors.col(i) = SetDown(point, state);
      contacts.lands = bearing_.insert({point.patch, point.index}).second || contacts.lands;
    }
    for (const BearingPoint& point : contacts.points) SetDownPatch(point.patch, state);
    LiftOff(phase, contacts.points);
    return contacts;
  }

 private:
  struct Footprint {
    BearingPoint point;
    Vector3d anchor;
  };

  const Vector3d& SetDown(const BearingPoint& point, const VerifierState& state) {
    const PointKey key(point.patch, point.index);
    return footprints_.emplace(key, Footprint{point, state.Position(point)}).first->second.anchor;
  }

  /// Sets down all points of a bearing patch that are on the ground, listed or not.
  void SetDownPatch(int patch, const VerifierState& state) {
    const models::ContactPatch& contact = robot_.contacts[patch];
    for (int i = 0; i < static_cast<int>(contact.points.size()); ++i) {
      const BearingPoint point{patch, i, contact.link, contact.points[i]};
      if (!IsOffGround(point, state)) SetDown(point, state);
    }
  }

  bool IsOffGround(const BearingPoint& point, const VerifierState& state) const {
    const Vector3d p = state.Position(point);
    const std::optional<int> level = ground_.LevelBelow(p.head<2>(), p.z());
    return !level || p.z() - ground_.levels()[*level] > kPointHeight;
  }

  /// Forgets the points that leave the ground in a phase that does not list them.
  void LiftOff(const Phase& phase, const std::vector<BearingPoint>& listed) {
    std::map<PointKey, Footprint> idle = footprints_;
    for (const BearingPoint& point : listed) idle.erase({point.patch, point.index});
    const auto look = [&](const Knot& knot) {
      const VerifierState state = evaluator_->Evaluate(knot);
      for (auto it = idle.begin(); it != idle.end();) {
        const bool leaves = IsOffGround(it->second.point, state);
        if (leaves) {
          footprints_.erase(it->first);
          bearing_.erase(it->first);
        }
        it = leaves ? idle.erase(it) : std::next(it);
      }
    };
    // Most feet are off the ground half-way through a phase.
    if (!idle.empty()) look(phase.knots[phase.knots.size() / 2]);
    for (std::size_t i = 0; i < phase.knots.size() && !idle.empty(); ++i) look(phase.knots[i]);
    for (std::size_t i = 0; i + 1 < phase.knots.size() && !idle.empty(); ++i) {
      const Knot& k0 = phase.knots[i];
      const KnotInterpolant interpolant(k0, phase.knots[i + 1]);
      const int steps = static_cast<int>(std::ceil(interpolant.duration() / kLiftOffStep));
      for (int step = 1; step < steps && !idle.empty(); ++step) {
        look(interpolant.At(k0.t + step * interpolant.duration() / steps));
      }
    }
  }

  const models::RobotModel& robot_;
  const models::GroundMap& ground_;
  StateEvaluator* evaluator_;
  std::map<PointKey, Footprint> footprints_;
  std::set<PointKey> bearing_;  ///< listed since they were set down
};

}  // namespace

std::vector<PhaseContacts> FollowContacts(const Plan& plan, const models::RobotModel& robot,
                                          const models::GroundMap& ground,
                                          StateEvaluator* evaluator) {
  std::vector<PhaseContacts> result;
  Footprints footprints(robot, ground, evaluator);
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) result.push_back(footprints.Follow(phase));
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
