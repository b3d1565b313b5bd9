#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/conditions/pelvis_clearance.h"
#include "experiments/examples/step_up_motion.h"
#include "models/world/collision.h"

namespace possibility::actions {

/// Steps up onto ground that lies higher, square to its edge, and down again backwards, from
/// walking stance to walking stance: the example of docs/tutorial_new_action.md.
class StepUp : public Manoeuvre {
 public:
  /// Rises that DRC-HUBO1 manages, m.
  static constexpr double kLowest = 0.01;
  static constexpr double kHighest = 0.15;

  explicit StepUp(const PlanningContext& context);

  using Manoeuvre::CN;
  bool CN(const graph::PointPair& edge) const override;
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point& v1) const override;
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point& v1) const override;
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point& v1) const override;
  double ExpectedDuration(const graph::PointPair& edge) const override;
  std::vector<Phase> Motion(const graph::PointPair& edge,
                            const std::function<bool()>& keep_going) const override;
  ManoeuvreBounds Bounds() const override;

 private:
  /// An edge, understood.
  struct Step {
    GroundedStance low;
    GroundedStance high;
    bool up = true;
  };
  std::optional<Step> AsStep(const graph::PointPair& edge) const;
  /// The stance at the other end of a step from `stance` (or to it): up ahead if that is where
  /// `towards` points, otherwise down behind. Nothing if the ground there or here does not hold.
  std::optional<GroundedStance> OtherEnd(const GroundedStance& stance,
                                         const Eigen::Vector2d& towards) const;
  /// The first stance on the way from v to v1, square to an edge, that a step joins with the
  /// ground beyond; v itself if that is one.
  std::optional<graph::Point> StanceAtAnEdge(const graph::Point& v, const graph::Point& v1) const;

  StepUpMotion motion_;
  std::vector<double> headings_;  ///< rad, square to the edges of the ground
  models::CollisionChecker checker_;
  PelvisClearance pelvis_;
};

/// How PlanRequest::manoeuvres asks for it.
ManoeuvreFactory StepUpFactory();

}  // namespace possibility::actions
