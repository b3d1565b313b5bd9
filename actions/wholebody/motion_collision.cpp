#include "actions/wholebody/motion_collision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "actions/plan/interpolation.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

/// Distances below this count as hits, because the robot moves between samples, m.
constexpr double kClearance = 0.01;
/// Tolerances of the verifier: bearing links against ground, and all other pairs, m.
constexpr double kGroundTolerance = 1e-3;
constexpr double kTolerance = 1e-4;

/// Largest time between samples, s.
constexpr double kInterval = 0.005;
/// Samples between questions to the token: a millisecond or less.
constexpr size_t kSamplesPerQuestion = 16;

bool GoOn(size_t sample, const CancellationToken& cancellation) {
  return sample % kSamplesPerQuestion != 0 || cancellation.Proceed();
}

/// Calls visit(t, X_SL) for samples of the motion, in order, until it returns false.
template <typename Visit>
void VisitSamples(const models::RobotModel& robot, const std::vector<Phase>& motion,
                  const Visit& visit) {
  dynamics::TreeKinematics kinematics(robot);
  const auto go_on = [&](double t, const Eigen::VectorXd& q) {
    kinematics.SetPosition(q);
    return visit(t, kinematics.X_WL());
  };
  for (const Phase& phase : motion) {
    for (size_t i = 0; i + 1 < phase.knots.size(); ++i) {
      const Knot& from = phase.knots[i];
      const Knot& to = phase.knots[i + 1];
      if (!go_on(from.t, from.q)) return;
      const int parts = std::max(1, static_cast<int>(std::ceil((to.t - from.t) / kInterval)));
      if (parts == 1) continue;
      const KnotInterpolant between(from, to);
      for (int part = 1; part < parts; ++part) {
        const double t = from.t + (to.t - from.t) * part / parts;
        if (!go_on(t, between.ConfigurationAt(t))) return;
      }
    }
    if (!phase.knots.empty() && !go_on(phase.knots.back().t, phase.knots.back().q)) return;
  }
}

/// Looks for hits of the whole robot with obstacles, pose by pose.
class HitSearch {
 public:
  /// `roughness`: hits that are less deep than this are left out, m.
  HitSearch(const models::RobotModel& robot, const models::Environment& environment,
            const models::CollisionChecker& checker, double roughness = 0)
      : robot_(robot),
        environment_(environment),
        checker_(checker),
        roughness_(roughness),
        bears_(robot.links.size()) {
    for (const models::ContactPatch& patch : robot.contacts) bears_[patch.link] = true;
  }

  /// Empty if nothing is hit.
  std::string HitAt(double t, const std::vector<Eigen::Isometry3d>& X_WL) const {
    for (const models::Proximity& pair : checker_.EnvironmentProximities(X_WL, kClearance)) {
      const models::Obstacle& obstacle = environment_.obstacles[pair.other];
      const double allowed = !obstacle.is_ground ? kClearance
                             : bears_[pair.link] ? -kGroundTolerance
                                                 : -kTolerance;
      if (pair.distance >= allowed - roughness_) continue;
      return fmt::format("hits '{}' with {} at {:.2f} s", obstacle.name,
                         robot_.links[pair.link].name, t);
    }
    return {};
  }

 private:
  const models::RobotModel& robot_;
  const models::Environment& environment_;
  const models::CollisionChecker& checker_;
  double roughness_;
  std::vector<bool> bears_;  ///< by link
};

}  // namespace

MotionPoses::MotionPoses(const models::RobotModel& robot, const std::vector<Phase>& motion) {
  VisitSamples(robot, motion, [&](double t, const std::vector<Eigen::Isometry3d>& X_SL) {
    samples_.push_back({t, X_SL});
    return true;
  });
}

std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const MotionPoses& poses,
                     const Eigen::Isometry3d& X_WS, const CancellationToken& cancellation) {
  const HitSearch search(robot, environment, checker);
  std::vector<Eigen::Isometry3d> X_WL(robot.links.size());
  for (size_t i = 0; i < poses.samples().size(); ++i) {
    const MotionPoses::Sample& sample = poses.samples()[i];
    if (!GoOn(i, cancellation)) return {};
    for (size_t link = 0; link < X_WL.size(); ++link) X_WL[link] = X_WS * sample.X_SL[link];
    std::string hit = search.HitAt(sample.t, X_WL);
    if (!hit.empty()) return hit;
  }
  return {};
}

std::string FirstHit(const models::RobotModel& robot, const models::Environment& environment,
                     const models::CollisionChecker& checker, const std::vector<Phase>& motion,
                     const CancellationToken& cancellation) {
  const HitSearch search(robot, environment, checker);
  std::string hit;
  size_t sample = 0;
  VisitSamples(robot, motion, [&](double t, const std::vector<Eigen::Isometry3d>& X_WL) {
    if (!GoOn(sample++, cancellation)) return false;
    hit = search.HitAt(t, X_WL);
    return hit.empty();
  });
  return hit;
}

std::string FirstRoughHit(const models::RobotModel& robot, const models::Environment& environment,
                          const models::CollisionChecker& checker, const std::vector<Phase>& rough,
                          double roughness, const CancellationToken& cancellation) {
  const HitSearch search(robot, environment, checker, roughness);
  dynamics::TreeKinematics kinematics(robot);
  size_t sample = 0;
  for (const Phase& phase : rough) {
    for (const Knot& knot : phase.knots) {
      if (!GoOn(sample++, cancellation)) return {};
      kinematics.SetPosition(knot.q);
      std::string hit = search.HitAt(knot.t, kinematics.X_WL());
      if (!hit.empty()) return hit;
    }
  }
  return {};
}

std::string FirstSelfHit(const models::RobotModel& robot, const models::CollisionChecker& checker,
                         const std::vector<Phase>& motion, const CancellationToken& cancellation) {
  std::string hit;
  size_t sample = 0;
  VisitSamples(robot, motion, [&](double t, const std::vector<Eigen::Isometry3d>& X_WL) {
    if (!GoOn(sample++, cancellation)) return false;
    const std::vector<models::Proximity> close = checker.SelfProximities(X_WL, 0);
    if (close.empty()) return true;
    hit = fmt::format("hits {} with {} at {:.2f} s", robot.links[close.front().other].name,
                      robot.links[close.front().link].name, t);
    return false;
  });
  return hit;
}

}  // namespace possibility::actions
