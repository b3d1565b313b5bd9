#include "actions/verify/verifier_margins.h"

#include <memory>
#include <optional>

#include "actions/verify/verdict_subject.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

constexpr double kMarginReach = 1e-3;  // m, beyond what is measured

/// Margins measured on demand: the collision checker costs as much as many knots.
class PhaseMargins {
 public:
  explicit PhaseMargins(const VerifiedPlan& subject) : subject_(subject) {}

  PlanMargins Measure(const Phase& phase) {
    if (!margins_) {
      margins_ = std::make_unique<PhaseMeasurement>(subject_.robot, subject_.scenario.environment,
                                                    subject_.ground);
    }
    return margins_->Of(phase);
  }

  /// Around all that the margins of a phase depend on.
  models::WorldReach ReachOf(const Phase& phase, const PlanMargins& margins) {
    if (!evaluator_) evaluator_ = std::make_unique<StateEvaluator>(subject_.robot);
    models::WorldReach reach;
    const std::vector<BearingPoint> points = BearingPoints(subject_.robot, phase);
    dynamics::TreeKinematics kinematics(subject_.robot);
    for (const Knot& knot : phase.knots) {
      kinematics.SetPosition(knot.q);
      for (std::size_t link = 0; link < kinematics.X_WL().size(); ++link) {
        const Eigen::Vector3d p = kinematics.X_WL()[link].translation();
        const double radius =
            evaluator_->link_radii()[link] + PlanMargins::kFarthest + kMarginReach;
        reach.solids.extend((p.array() - radius).matrix());
        reach.solids.extend((p.array() + radius).matrix());
      }
      // Ground farther from a point than the least distance from an edge does not bring one nearer.
      const double edge = std::max(0.0, margins.ground_edge.value) + 2 * kMarginReach;
      for (const BearingPoint& point : points) {
        const Eigen::Vector3d p = kinematics.Position(point.link, point.p_L);
        reach.ground.extend((p.array() - edge).matrix());
        reach.ground.extend((p.array() + edge).matrix());
      }
    }
    return reach;
  }

 private:
  const VerifiedPlan& subject_;
  std::unique_ptr<PhaseMeasurement> margins_;
  std::unique_ptr<StateEvaluator> evaluator_;
};

void InSegment(int segment, Margin* margin) {
  if (margin->segment >= 0) margin->segment = segment;
}

PlanMargins InSegment(int segment, PlanMargins margins) {
  for (Margin* margin :
       {&margins.zmp, &margins.ground_edge, &margins.torque, &margins.friction,
        &margins.joint_speed, &margins.self_distance, &margins.obstacle_distance}) {
    InSegment(segment, margin);
  }
  return margins;
}

}  // namespace

PlanMargins MarginsOf(const VerifiedPlan& subject, VerdictStore* store) {
  PhaseMargins measurement(subject);
  PlanMargins all;
  for (std::size_t segment = 0; segment < subject.plan.segments.size(); ++segment) {
    for (const Phase& phase : subject.plan.segments[segment].phases) {
      const std::string key = store ? SubjectOf(phase, subject.robot) : std::string();
      std::optional<PlanMargins> margins =
          store ? store->margins.Find(key, subject.local_world) : std::nullopt;
      if (!margins) {
        margins = measurement.Measure(phase);
        if (store) {
          store->margins.Add(key, measurement.ReachOf(phase, *margins), subject.local_world,
                             *margins);
        }
      }
      all.Add(InSegment(static_cast<int>(segment), *margins));
    }
  }
  return all;
}

}  // namespace possibility::actions
