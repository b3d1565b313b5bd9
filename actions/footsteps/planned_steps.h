#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/footsteps/footstep_motion.h"
#include "actions/footsteps/footstep_plan.h"
#include "actions/footsteps/step_reach.h"
#include "actions/footsteps/step_refusals.h"

namespace possibility::actions {

/// Steps of a gait where C_S of the gait says no: over cracks, sills and stairs, through doors and
/// from stone to stone, upright, on all fours or crawling. An edge joins two nominal stances that
/// meet C_S. Its job is contact planning: it searches footholds, makes a motion of them and tests
/// it, and asks for other footholds where a step is beyond the robot. It ends after a stated
/// effort. In a plan the motion is one of the gait.
class PlannedSteps final : public Manoeuvre {
 public:
  /// `gait`: index of a gait whose steps can be searched (FootstepSearch::Knows).
  PlannedSteps(const PlanningContext& context, int gait);

  static std::string NameOf(const models::Gait& gait) { return gait.name + " over obstacles"; }

  std::string plan_action() const override { return stance().gait->name; }

  using Manoeuvre::CN;
  bool CN(const graph::Edge& edge) const override;
  /// Edges are proposed by the search for footsteps, not grown at random.
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point&) const override {
    return v0;
  }
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point&) const override {
    return v0;
  }
  std::optional<graph::Point> FindLaunchPoint(const graph::Point&,
                                              const graph::Point&) const override {
    return std::nullopt;
  }
  std::optional<graph::Point> FindLandingPoint(const graph::Point&,
                                               const graph::Point&) const override {
    return std::nullopt;
  }
  double ExpectedDuration(const graph::Edge& edge) const override;
  /// Of a motion of steps, s.
  double ExpectedDuration(const std::vector<Footstep>& steps) const {
    return motion_.ExpectedDuration(steps);
  }
  std::vector<Phase> Motion(const graph::Edge& edge,
                            const CancellationToken& cancellation) const override;

  /// Of the longest steps, each with the least time.
  double GreatestSpeed() const override;

  bool TestsItsMotions() const override { return true; }
  bool BoundsItsEffort() const override { return true; }

  /// A search for steps has ended for want of effort.
  void OnCutShort() const { is_cut_short_ = true; }
  /// Doubles the effort, if that may help: `edges` are those that failed with the former one, which
  /// are forgotten. The effort ends after kMostDoublings.
  bool AskAgain(std::vector<graph::Edge>* edges);
  static constexpr int kMostDoublings = 1;
  /// How often the effort has been doubled.
  int doublings() const { return doublings_; }

  /// Steps that a search has found from one end of an edge to the other: its job tries them first,
  /// and searches others only if they are beyond the robot. To be called before the edge is
  /// proposed; once an edge is planned, it stays as it is. `most_duration`: slower steps are of no
  /// use, s.
  void Suggest(const graph::Edge& edge, std::vector<Footstep> steps,
               double most_duration = std::numeric_limits<double>::infinity()) const;

  const FootstepLimits& limits() const { return limits_; }
  /// Made when it is first asked for.
  std::shared_ptr<const StepGround> known_ground() const;

 private:
  using EdgeKey = std::vector<std::int64_t>;  ///< both ends, rounded

  struct Suggestion {
    std::vector<Footstep> steps;                                     ///< empty: none are known
    double most_duration = std::numeric_limits<double>::infinity();  ///< s
  };

  /// What is known of an edge.
  struct Outcome {
    graph::Edge edge;
    std::vector<Phase> motion;
    std::string fault;        ///< why there is none; empty if there is one
    bool is_decided = false;  ///< more effort would not change it
  };

  /// What a job may still do.
  struct Effort {
    int sequences = 0;         ///< of steps, of which a motion is made
    std::int64_t states = 0;   ///< of all its searches
    std::int64_t each = 0;     ///< of a search
    bool proves_none = false;  ///< the last search has a proof that no steps exist
  };
  Effort FullEffort() const;

  static EdgeKey KeyOf(const graph::Edge& edge);
  /// Of the planned motion, s, if there is one.
  std::optional<double> DurationOfOutcome(const EdgeKey& key) const;
  Suggestion SuggestedFor(const EdgeKey& key) const;
  /// Begins with the suggested steps.
  Outcome Plan(const GroundedStance& from, const GroundedStance& to, const Suggestion& suggestion,
               const CancellationToken& cancellation) const;
  /// With at most this share of the torques. `suggestion`: without steps it gets the first ones.
  Outcome PlanWithin(double most_torque, Effort effort, const GroundedStance& from,
                     const GroundedStance& to, Suggestion* suggestion,
                     const CancellationToken& cancellation) const;
  /// Raises swings that hit something. @throws FootstepError, Cancelled.
  std::vector<Phase> FreeMotion(const GroundedStance& from, std::vector<Footstep> steps,
                                double most_torque, const CancellationToken& cancellation) const;
  /// With these swings. `style`: as FootstepMotion::Build has it. @throws FootstepError, Cancelled.
  std::vector<Phase> MotionOffObstacles(const GroundedStance& from,
                                        const std::vector<Footstep>& steps, double most_torque,
                                        int* style, const CancellationToken& cancellation) const;
  const NominalStance& stance() const { return model().gaits[from()]->stance; }

  /// Empty if none are found with at most so many states. `effort`: less what it takes.
  std::vector<Footstep> Search(const GroundedStance& from, const GroundedStance& to,
                               const FootstepLimits& limits, const StepRefusals& refusals,
                               std::int64_t states, Effort* effort,
                               const CancellationToken& cancellation) const;
  /// Other steps, with the trunk farther from obstacles. Empty if there are none.
  std::vector<Footstep> StepsFartherAway(const GroundedStance& from, const GroundedStance& to,
                                         const std::vector<Footstep>& steps,
                                         const StepRefusals& refusals, FootstepLimits* limits,
                                         Effort* effort,
                                         const CancellationToken& cancellation) const;
  /// Refuses what a motion failed at.
  static void Refuse(const FootstepError& error, const Footstep& step, const Foothold& rest,
                     StepRefusals* refusals);
  /// Whether the root has to be lower than usual in any of the steps.
  bool SinkLow(const GroundedStance& from, const std::vector<Footstep>& steps) const;
  /// Of the root all through a step (StepReach). `feet`: before it.
  std::optional<double> HighestRoot(std::vector<Foothold> feet, const Footstep& step) const;

  FootstepLimits limits_;
  StepReach reach_;
  FootstepMotion motion_;
  mutable std::once_flag ground_is_known_;
  mutable std::shared_ptr<const StepGround> known_ground_;
  std::atomic<int> doublings_ = 0;
  mutable std::atomic<bool> is_cut_short_ = false;
  mutable std::mutex mutex_;
  mutable std::map<EdgeKey, Outcome> outcomes_;
  mutable std::map<EdgeKey, Suggestion> suggested_;
};

}  // namespace possibility::actions
