#include "actions/checks/contacts_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Planes that p bears on.
std::vector<int> PlanesUnder(const Vector3d& p, const models::GroundMap& ground) {
  return ground.PlanesAt(p.head<2>(), p.z() - kPointHeight, p.z() + kPointHeight);
}

/// The plane whose ground is nearest to p, in height and beyond its edge; -1 without any.
int NearestPlane(const Vector3d& p, const models::GroundMap& ground) {
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int plane = 0; plane < static_cast<int>(ground.planes().size()); ++plane) {
    const double above = ground.planes()[plane].HeightAt(p.head<2>()) - p.z();
    const double beyond = std::max(0.0, -ground.Clearance(plane, p.head<2>()));
    const double distance = std::hypot(above, beyond);
    if (nearest >= 0 && !(distance < least)) continue;
    nearest = plane;
    least = distance;
  }
  return nearest;
}

void CheckGround(const Vector3d& p, const BearingPoint& point, const models::RobotModel& robot,
                 const models::GroundMap& ground, const Instant& at, ViolationLog* log) {
  if (!PlanesUnder(p, ground).empty()) return;
  const int nearest = NearestPlane(p, ground);
  if (nearest < 0) {
    log->Report(ViolationKind::kContactGround, at, NameOf(robot, point) + ", no ground at all");
    return;
  }
  const bool on_height = log->RequireAtMost(
      ViolationKind::kContactGround, at,
      std::abs(ground.planes()[nearest].HeightAt(p.head<2>()) - p.z()), 0, kPointHeight, "m",
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
    SetGround(state, &contacts);
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

  /// A patch bears on the plane that holds most of its points, of several on the most slippery one;
  /// the plane's normal and friction count for them.
  void SetGround(const VerifierState& state, PhaseContacts* contacts) const {
    const std::vector<BearingPoint>& points = contacts->points;
    std::vector<std::vector<int>> planes;
    std::map<int, std::map<int, int>> votes;  // by patch and plane
    for (const BearingPoint& point : points) {
      planes.push_back(PlanesUnder(state.Position(point), ground_));
      for (const int plane : planes.back()) ++votes[point.patch][plane];
    }
    const auto count = static_cast<Eigen::Index>(points.size());
    contacts->normals = Vector3d::UnitZ().replicate(1, count);
    contacts->friction = Eigen::VectorXd::Constant(count, robot_.friction);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::map<int, int>& of_patch = votes[points[i].patch];
      const auto best = std::max_element(planes[i].begin(), planes[i].end(), [&](int a, int b) {
        return std::pair(of_patch.at(a), -ground_.planes()[a].friction) <
               std::pair(of_patch.at(b), -ground_.planes()[b].friction);
      });
      if (best == planes[i].end()) continue;
      const models::GroundPlane& plane = ground_.planes()[*best];
      contacts->normals.col(static_cast<Eigen::Index>(i)) = plane.normal;
      contacts->friction[static_cast<Eigen::Index>(i)] = std::min(robot_.friction, plane.friction);
    }
  }

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
    const std::optional<double> height = ground_.HeightBelow(p.head<2>(), p.z());
    return !height || p.z() - *height > kPointHeight;
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
