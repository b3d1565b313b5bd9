#include "actions/route/rounded_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "actions/gait/rounded_way.h"
#include "actions/route/gait_run.h"
#include "actions/wholebody/motion_collision.h"
#include "actions/wholebody/motion_error.h"

namespace possibility::actions {
namespace {

/// Half the window of a bend at first; it is halved where it is in the way, m. Below the least one
/// a bend is not rounded.
constexpr double kWidest = 1;
constexpr double kLeast = 0.15;
constexpr int kTries = 4;

/// Least distance of a bearing point from the edge of the ground, m.
constexpr double kEdge = 0.01;

/// Tells levels apart, m.
constexpr double kOfOneLevel = 1e-3;

/// The legs of a run around which something is in the way, by index within the run.
using Legs = std::set<int>;

/// One run, and how far its bends are rounded.
class RoundedRun {
 public:
  RoundedRun(const LocomotionModel& model, const RunWorld& world, const Route& route, int first,
             int count)
      : model_(model),
        world_(world),
        route_(route),
        first_(first),
        count_(count),
        windows_(count - 1, kWidest) {}

  bool IsRounded() const {
    return std::any_of(windows_.begin(), windows_.end(), [](double window) { return window > 0; });
  }

  /// Bends whose stances reach over the edge of the ground become narrower until none does.
  void StayOnGround() {
    for (Legs legs = LegsOffGround(); !legs.empty() && Narrow(legs); legs = LegsOffGround()) {
    }
  }

  std::vector<std::vector<Phase>> Motion(const FlowEnd& end,
                                         const CancellationToken& cancellation) const {
    return FlowAlong(model_, route_, first_, count_, Lines(), end, cancellation);
  }

  /// Legs whose motions hit something.
  Legs LegsThatHit(const std::vector<std::vector<Phase>>& motion,
                   const CancellationToken& cancellation) const {
    Legs legs;
    for (int leg = 0; leg < count_; ++leg) {
      const std::string hit =
          FirstHit(*model_.robot, world_.environment, world_.checker, motion[leg], cancellation);
      if (!cancellation.Proceed()) throw Cancelled();
      if (!hit.empty()) legs.insert(leg);
    }
    return legs;
  }

  /// Narrows the bends at the ends of legs. False if all of them are sharp.
  bool Narrow(const Legs& legs) {
    bool changed = false;
    for (int bend = 0; bend < static_cast<int>(windows_.size()); ++bend) {
      if (windows_[bend] <= 0 || !(legs.contains(bend) || legs.contains(bend + 1))) continue;
      windows_[bend] = windows_[bend] / 2 < kLeast ? 0 : windows_[bend] / 2;
      changed = true;
    }
    return changed;
  }
  bool NarrowAll() {
    Legs all;
    for (int leg = 0; leg < count_; ++leg) all.insert(leg);
    return Narrow(all);
  }

 private:
  std::vector<StanceLine> Lines() const {
    const PlanarPose& begin = route_[first_].from;
    std::vector<PlanarPose> corners = {SeenFrom(begin, begin)};
    for (int leg = 0; leg < count_; ++leg) {
      corners.push_back(SeenFrom(begin, route_[first_ + leg].to));
    }
    return RoundedLines(corners, windows_);
  }

  /// The leg whose way is nearest to a stance.
  int NearestLeg(const PlanarPose& stance) const {
    int nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int leg = 0; leg < count_; ++leg) {
      const Eigen::Vector2d a = route_[first_ + leg].from.position();
      const Eigen::Vector2d along = route_[first_ + leg].to.position() - a;
      const Eigen::Vector2d to = stance.position() - a;
      const double share =
          std::clamp(to.dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
      const double distance = (to - share * along).norm();
      if (distance >= least) continue;
      least = distance;
      nearest = leg;
    }
    return nearest;
  }

  Legs LegsOffGround() const {
    const RouteLeg& begin = route_[first_];
    const NominalStance& stance = model_.gaits[begin.gait]->stance;
    Legs legs;
    for (const StanceLine& line : Lines()) {
      for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const PlanarPose from = Placed(line[i]);
        if (!StandsBetween(stance, from, Placed(line[i + 1]))) legs.insert(NearestLeg(from));
      }
    }
    return legs;
  }
  PlanarPose Placed(const PlanarPose& seen) const {
    const PlanarPose& origin = route_[first_].from;
    return {origin.x + seen.x, origin.y + seen.y, seen.yaw};
  }

  /// Whether all bearing points are on the run's level on the way between two close stances.
  bool StandsBetween(const NominalStance& stance, const PlanarPose& from,
                     const PlanarPose& to) const {
    for (const auto& points : stance.bearing_points) {
      for (const Eigen::Vector2d& point : points) {
        if (!IsGroundBetween(from * point, to * point)) return false;
      }
    }
    return true;
  }
  bool IsGroundBetween(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const {
    const auto level = world_.ground.LevelAt(from, route_[first_].z, kOfOneLevel);
    if (!level) return false;
    return world_.ground.OneFaceHolds(*level, from, to, kEdge) ||
           world_.ground.Clearance(*level, from) >= kEdge + (to - from).norm();
  }

  const LocomotionModel& model_;
  const RunWorld& world_;
  const Route& route_;
  const int first_;
  const int count_;
  std::vector<double> windows_;  ///< by bend
};

}  // namespace

std::optional<std::vector<std::vector<Phase>>> RoundedFlow(const LocomotionModel& model,
                                                           const RunWorld& world,
                                                           const Route& route, int first, int count,
                                                           const FlowEnd& end,
                                                           const CancellationToken& cancellation) {
  RoundedRun run(model, world, route, first, count);
  for (int i = 0; i < kTries; ++i) {
    run.StayOnGround();
    if (!run.IsRounded()) return std::nullopt;
    try {
      std::vector<std::vector<Phase>> motion = run.Motion(end, cancellation);
      const Legs hits = run.LegsThatHit(motion, cancellation);
      if (hits.empty()) return motion;
      if (!run.Narrow(hits)) return std::nullopt;
    } catch (const MotionError&) {
      run.NarrowAll();
    }
  }
  return std::nullopt;
}

}  // namespace possibility::actions
