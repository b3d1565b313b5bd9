#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/conditions/pelvis_clearance.h"
#include "common/cancellation_token.h"
#include "experiments/examples/step_up_motion.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// A step up onto higher ground, square to its edge, or backwards down from it; from walking stance
/// to walking stance. The example of docs/tutorial_new_action.md.
class StepUp : public Manoeuvre {
 public:
  /// Rises that DRC-HUBO1 manages, m.
  static constexpr double kLowest = 0.01;
  static constexpr double kHighest = 0.15;

  explicit StepUp(const PlanningContext& context);

  using Manoeuvre::CN;
  bool CN(const graph::Edge& edge) const override;
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point& v1) const override;
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point& v1) const override;
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point& v1) const override;
  double ExpectedDuration(const graph::Edge& edge) const override;
  std::vector<Phase> Motion(const graph::Edge& edge,
                            const CancellationToken& cancellation) const override;
  ManoeuvreBounds Bounds() const override;

 private:
  /// An edge interpreted as a step.
  struct Step {
    GroundedStance low;
    GroundedStance high;
    bool up = true;
  };
  std::optional<Step> AsStep(const graph::Edge& edge) const;
  /// The other end of a step that has `stance` at one end: ahead on higher ground if `towards`
  /// points ahead, otherwise behind on lower ground. None if the ground does not hold at both ends.
  std::optional<GroundedStance> OtherEnd(const GroundedStance& stance,
                                         const Eigen::Vector2d& towards) const;
  /// The first stance on the way from v to v1 that is square to an edge and from which a step is
  /// possible; v itself if it is such a stance. None if there is no such stance.
  std::optional<graph::Point> StanceAtAnEdge(const graph::Point& v, const graph::Point& v1) const;

  StepUpMotion motion_;
  std::vector<double> headings_;  ///< rad, square to the edges of the ground
  models::CollisionChecker checker_;
  PelvisClearance pelvis_;
};

/// For PlanRequest::manoeuvres.
ManoeuvreFactory StepUpFactory();

}  // namespace possibility::actions
