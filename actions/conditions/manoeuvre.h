#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/plan/plan.h"
#include "actions/wholebody/motion_builder.h"
#include "common/cancellation_token.h"
#include "graph/action/action.h"
#include "models/world/collision.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// Input of a manoeuvre. Everything in it must outlive the manoeuvre.
struct PlanningContext {
  const LocomotionModel* model = nullptr;  ///< the robot, its gaits and the transitions
  World world;
  /// Gaits in use, in the order of LocomotionModel::gaits.
  std::vector<std::shared_ptr<const QuasiStaticAction>> gaits;
  std::shared_ptr<const graph::ExplorationSpace> space;
  models::PlannerSettings settings;
  std::filesystem::path library;   ///< folder of solved motions and reaches; empty: none
  bool solved_motions = true;      ///< false: the library provides only reaches
  CancellationToken cancellation;  ///< cancels at the time limit
};

/// An action that leads in one piece from a nominal stance of one gait to a nominal stance of
/// another or the same gait, such as a jump or a step up. The term is from Frazzoli, Dahleh & Feron
/// 2005; their trim trajectories correspond to our gaits. A manoeuvre provides the paper's
/// functions (graph/action/action.h), the motion of its edges, and bounds for the floods. It stores
/// no verdicts: SearchedManoeuvre does. docs/tutorial_new_action.md adds a manoeuvre.
///
/// One thread explores. Jobs and `Motion` are used from several threads at once.
class Manoeuvre : public graph::NonholonomicAction {
 public:
  /// `from`, `to`: indices of the first and the last gait.
  /// @throws InputError if `context` has no such gait.
  Manoeuvre(const PlanningContext& context, std::string name, int from, int to);

  std::string name() const final { return name_; }
  /// Action of its segments in a plan.
  virtual std::string plan_action() const { return name_; }
  int from() const { return from_; }
  int to() const { return to_; }

  /// True if the manoeuvre can start from or end in this stance, by C_S of the gait.
  bool CN(const graph::Point& vertex) const override;
  bool CS(const graph::Point& vertex) const override { return CN(vertex); }
  bool Explorable(const graph::Point& vertex) const override { return CN(vertex); }

  /// Necessary conditions of an edge: optimistic and cheap.
  bool CN(const graph::Edge& edge) const override = 0;
  /// False unless overridden: every edge needs its job.
  bool CS(const graph::Edge&) const override { return false; }
  /// C_N of an edge that joins nominal stances of the two gaits.
  bool Explorable(const graph::Edge& edge) const override;

  /// A MotionJob if C_N holds (motion_job.h): it generates the motion and checks it for collisions.
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::Edge& edge) const override;

  /// Called by a job before `Motion`: finds what the motion of this edge has in common with others,
  /// so that the work survives a job that is cancelled. False if the job is cancelled. Nothing
  /// unless overridden. @throws MotionError as `Motion`.
  virtual bool Prepare(const graph::Edge&, graph::JobControl*) const { return true; }

  /// Motion of an edge in the world frame, from rest in the launch stance to rest in the landing
  /// stance, times from 0. Deterministic: the same edge has the same motion. Called from any
  /// thread, by jobs for edges that meet C_N and by the planner for confirmed edges. `cancellation`
  /// is to be asked every few milliseconds.
  /// @throws MotionError if there is no motion; Cancelled.
  virtual std::vector<Phase> Motion(const graph::Edge& edge,
                                    const CancellationToken& cancellation) const = 0;

  /// Whether `Motion` only returns what keeps off the robot itself and all obstacles, so that jobs
  /// need not test it again.
  virtual bool TestsItsMotions() const { return false; }

  /// Whether `Motion` ends by itself after a stated effort, so that jobs need no time limit.
  virtual bool BoundsItsEffort() const { return false; }

  /// Bounds that the floods may rely on; none unless overridden.
  virtual ManoeuvreBounds Bounds() const { return {}; }

  /// Replaces guessed bounds by valid ones and returns whether they changed. Called before the
  /// planner answers "no". @throws Cancelled.
  virtual bool ReplaceGuesses(const CancellationToken& cancellation);

  /// Greatest mean speed over the ground from launch to landing, seen from above, of all motions
  /// known so far, m/s; infinite unless overridden. For lower bounds of durations.
  virtual double GreatestSpeed() const { return std::numeric_limits<double>::infinity(); }

  /// Reports that the motion of a confirmed edge has a fault that does not depend on the place. A
  /// manoeuvre that has the same motion elsewhere should exclude it there. Does nothing unless
  /// overridden.
  virtual void RefuteEverywhere(const graph::Edge&) {}

  const LocomotionModel& model() const { return *model_; }
  const World& world() const { return world_; }

 protected:
  const QuasiStaticAction& launch_gait() const { return *launch_; }
  const QuasiStaticAction& landing_gait() const { return *landing_; }
  /// The point of E as a stance of the launch or landing gait; none if it is not nominal for it.
  std::optional<GroundedStance> LaunchStance(const graph::Point& v) const;
  std::optional<GroundedStance> LandingStance(const graph::Point& v) const;
  graph::Point PointOf(const GroundedStance& stance) const;
  /// Collision checker of the whole robot in this world.
  const std::shared_ptr<const models::CollisionChecker>& checker() const { return checker_; }

 private:
  std::string name_;
  int from_;
  int to_;
  const LocomotionModel* model_;
  World world_;
  std::shared_ptr<const QuasiStaticAction> launch_;
  std::shared_ptr<const QuasiStaticAction> landing_;
  std::shared_ptr<const models::CollisionChecker> checker_;
};

/// Makes a manoeuvre for the planner.
struct ManoeuvreFactory {
  std::string name;  ///< used in scenarios and requests
  std::function<std::shared_ptr<Manoeuvre>(const PlanningContext&)> make;
  /// Probability that a cycle of the random search skips growing this action.
  double skip_growth = 0;
};

/// Makes the manoeuvres of `factories` that `actions` names, in the order of `factories`.
/// @throws InputError, beginning with `where`, if a factory is empty, returns null or a manoeuvre
/// of another name. Exceptions of a factory pass through.
std::vector<std::shared_ptr<Manoeuvre>> MakeManoeuvres(
    const std::vector<ManoeuvreFactory>& factories, const std::vector<std::string>& actions,
    const PlanningContext& context, const std::string& where);

}  // namespace possibility::actions
