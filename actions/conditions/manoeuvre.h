#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/conditions/manoeuvre_bounds.h"
#include "actions/conditions/quasi_static_action.h"
#include "actions/motion/motion_builder.h"
#include "actions/plan/plan.h"
#include "graph/action.h"
#include "models/world/collision.h"
#include "models/world/scenario.h"

namespace possibility::actions {

/// What a manoeuvre is made from. All of it outlives the manoeuvre.
struct PlanningContext {
  const LocomotionModel* model = nullptr;  ///< the robot, its gaits and the transitions
  World world;
  /// The gaits planned with, in the order of LocomotionModel::gaits.
  std::vector<std::shared_ptr<const QuasiStaticAction>> gaits;
  std::shared_ptr<const graph::ExplorationSpace> space;
  models::PlannerSettings settings;
  std::filesystem::path library;     ///< folder of solved motions and of reaches; empty: none
  bool solved_motions = true;        ///< false: nothing but reaches is taken from the library
  std::function<bool()> keep_going;  ///< false once time is up; may be empty
};

/// An action that goes in one piece from a nominal stance of one gait to a nominal stance of
/// another or the same (Frazzoli, Dahleh & Feron 2005 call it so beside their trim trajectories:
/// our gaits): a jump, a step up. Everything that planner, route, motion and floods ask of it is
/// here, beside the functions of the paper (graph/action.h), half of which this class answers by
/// what it keeps: the verdict on every edge that was examined. docs/tutorial_new_action.md adds
/// one.
///
/// One thread explores; jobs, `Motion` and what this class keeps are used from several at once.
class Manoeuvre : public graph::NonholonomicAction {
 public:
  /// An edge that is known to be impossible, and why.
  struct Refusal {
    graph::PointPair edge;
    std::string reason;
  };

  /// `from`, `to`: indices of the gaits that it starts from and ends in.
  /// @throws InputError if `context` has no such gait.
  Manoeuvre(const PlanningContext& context, std::string name, int from, int to);

  std::string name() const final { return name_; }
  int from() const { return from_; }
  int to() const { return to_; }

  /// A stance that the manoeuvre can start from or end in, by C_S of its gait.
  bool CN(const graph::Point& vertex) const override;
  bool CS(const graph::Point& vertex) const override { return CN(vertex); }
  bool Explorable(const graph::Point& vertex) const override { return CN(vertex); }

  /// Necessary conditions of an edge: optimistic, and cheap. Never depend on what was recorded.
  bool CN(const graph::PointPair& edge) const override = 0;
  /// Whether it is known to be possible.
  bool CS(const graph::PointPair& edge) const override;
  /// Only between nominal stances of its gaits; C_N there, unless more is known.
  bool Explorable(const graph::PointPair& edge) const override;

  /// A MotionJob if C_N holds (motion_job.h): it generates the motion and looks for collisions.
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::PointPair& edge) const override;

  /// The motion that executes an edge, in the world: from rest in the launch stance to rest in the
  /// landing stance, times from 0. The same edge has the same motion. Called for edges that meet
  /// C_N by jobs, and for confirmed edges by the planner, from any thread.
  /// `keep_going`: asked every few milliseconds, may be empty.
  /// @throws MotionError if there is none; Abandoned if `keep_going` says no.
  virtual std::vector<Phase> Motion(const graph::PointPair& edge,
                                    const std::function<bool()>& keep_going) const = 0;

  /// What the floods may take for granted; nothing unless overridden.
  virtual ManoeuvreBounds Bounds() const { return {}; }

  /// Called before the planner answers "no": bounds that were guessed are to be made true.
  /// Whether they changed. @throws Abandoned if `keep_going` (may be empty) says no.
  virtual bool ReplaceGuesses(const std::function<bool()>& keep_going);

  /// With what probability a cycle does not grow it (the paper's 0.9 for jumping).
  virtual double skip_growth() const { return 0; }

  /// The edge failed as motion although it was confirmed: impossible from now on. `anywhere`: what
  /// is wrong with it does not depend on the place.
  virtual void Forbid(const graph::PointPair& edge, const std::string& reason, bool anywhere);

  /// For jobs: what they found out. The last word on an edge counts.
  void Record(const graph::PointPair& edge, bool possible, const std::string& reason) const;
  /// In the order in which they were recorded.
  std::vector<Refusal> Refusals() const;

  const LocomotionModel& model() const { return *model_; }
  const World& world() const { return world_; }

 protected:
  struct Verdict {
    graph::PointPair edge;
    bool possible = false;
    std::string reason;
  };
  std::optional<Verdict> VerdictOn(const graph::PointPair& edge) const;

  const QuasiStaticAction& launch_gait() const { return *launch_; }
  const QuasiStaticAction& landing_gait() const { return *landing_; }
  /// The stance that a point of E is, if it is nominal for the gait.
  std::optional<GroundedStance> LaunchStance(const graph::Point& v) const;
  std::optional<GroundedStance> LandingStance(const graph::Point& v) const;
  graph::Point PointOf(const GroundedStance& stance) const;
  /// Of the whole robot in this world.
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

  mutable std::mutex mutex_;
  mutable std::vector<Verdict> verdicts_;  ///< under mutex_
};

/// How the planner comes by a manoeuvre.
struct ManoeuvreFactory {
  std::string name;  ///< by which scenarios and requests ask for it
  std::function<std::shared_ptr<Manoeuvre>(const PlanningContext&)> make;
};

/// Those of `factories` whose names are among `actions`, made in the order of `factories`.
/// @throws InputError, beginning with `where`, if a factory is empty, makes nothing or something of
/// another name; whatever it throws itself.
std::vector<std::shared_ptr<Manoeuvre>> MakeManoeuvres(
    const std::vector<ManoeuvreFactory>& factories, const std::vector<std::string>& actions,
    const PlanningContext& context, const std::string& where);

}  // namespace possibility::actions
