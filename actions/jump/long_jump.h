#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "actions/conditions/manoeuvre.h"
#include "actions/conditions/pelvis_clearance.h"
#include "actions/jump/jump_library.h"
#include "actions/jump/jump_solver.h"
#include "actions/wholebody/motion_collision.h"
#include "models/world/collision.h"

namespace possibility::actions {

class SharedJumpSolve;

/// The standing long jump (paper, section "Standing Long Jump"): nonholonomic, from a stance of one
/// gait straight ahead into a stance of another, by distances on the jump library's grid. C_N is
/// the paper's; edges that meet it need a confirmation job. One exploring thread per instance, and
/// any number of its jobs at once.
class LongJump : public Manoeuvre {
 public:
  /// Expected duration of an unsolved jump without its preparation, s.
  static constexpr double kNominalDuration = 3.1;

  /// Takes the reach from the context's library if that has a table, otherwise guesses it for the
  /// heights of the context's ground.
  /// @throws InputError if the context lacks one of the jump's gaits, or the robot cannot be
  /// reduced to its sagittal plane.
  LongJump(const PlanningContext& context, const models::Jump& jump);
  ~LongJump() override;

  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point& v1) const override;
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point& v1) const override;
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point& v1) const override;

  using Manoeuvre::CN;
  using Manoeuvre::Explorable;
  bool CN(const graph::Edge& edge) const override;
  /// C_N, unless such a jump is known to be impossible anywhere, the gaits can go straight on
  /// without a jump, or a jump beside it keeps farther from the edges of the ground.
  bool Explorable(const graph::Edge& edge) const override;

  double ExpectedDuration(const graph::Edge& edge) const override;
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::Edge& edge) const override;
  std::vector<Phase> Motion(const graph::Edge& edge,
                            const CancellationToken& cancellation) const override;

  ManoeuvreBounds Bounds() const override;
  /// Replaces a guessed reach by solving. Must not run while FindPath explores in another thread.
  bool ReplaceGuesses(const CancellationToken& cancellation) override;

  /// Of the jumps between the levels of the world that the library knows.
  double GreatestSpeed() const override;

  /// Excludes every jump of the same distance and height.
  void RefuteEverywhere(const graph::Edge& edge) override;

  const JumpReach& reach() const { return reach_; }
  const JumpSolver& solver() const { return *solver_; }

 private:
  class Job;

  /// An edge as a jump.
  struct Leap {
    GroundedStance launch;
    GroundedStance landing;
    JumpTask task;  ///< on the grid
  };
  std::optional<Leap> AsLeap(const graph::Edge& edge) const;
  /// The other end of the longest jump from `stance`, of at most `distance` (m), that has ground to
  /// bear on there, wide ground (kWideEnds) if there is any: forward from a launch, or backward
  /// from a landing.
  std::optional<GroundedStance> OtherEnd(const GroundedStance& stance, double distance,
                                         bool forward) const;
  /// The stance at v (a launch or a landing) turned along `way` (m), and moved along it if that
  /// widens the ground at the jump's ends; none unless a jump of at most that length connects there
  /// and is not needless.
  std::optional<graph::Point> LinedUp(const graph::Point& v, const Eigen::Vector2d& way,
                                      bool launches) const;
  /// Whether C_S allows walking straight on from the launch and changing gait into the landing, or
  /// in the opposite order. Such a jump leads nowhere new, and Algorithm 4 would make one from
  /// every new landing.
  bool IsNeedless(const GroundedStance& launch, const GroundedStance& landing) const;
  /// A jump with wide ground at both ends (kWideEnds) over the same gap as a jump without. The
  /// launch gait goes straight from one launch to the other, and LandingsConnect. None if the jump
  /// has wide ground itself, or nothing is better.
  std::optional<Leap> Widened(const Leap& leap) const;
  /// Whether the robot gets from one landing straight to the other, or stands up and walks straight
  /// to where it would stand up from the other.
  bool LandingsConnect(const GroundedStance& from, const GroundedStance& to) const;
  /// The same by one jump. `moves`: of the launch, ascending.
  std::optional<Leap> WidenedTo(const Leap& leap, const JumpTask& task,
                                const std::vector<int>& moves) const;
  /// The stance moved ahead by a number of steps.
  static GroundedStance Moved(GroundedStance stance, int move);
  bool GroundIsWide(const GroundedStance& launch, double begin, double end) const;
  /// Sufficient: the straight way on from `launch`, `distance` (m) long, is free all around and on
  /// wide ground.
  bool WayIsOpen(const GroundedStance& launch, double distance) const;
  bool SomeParabolaIsFree(const graph::Edge& edge) const;
  bool ParabolaIsFree(const graph::Edge& edge, double rise) const;

  void RecordRefuted(const Leap& leap) const;
  bool IsRefuted(const Leap& leap) const;
  void RecordImpossible(const JumpTask& task) const;
  bool IsImpossible(const JumpTask& task) const;
  /// A solved jump, which collides with nothing on bare ground, and its poses, all and in the air.
  struct Solved {
    std::shared_ptr<const SolvedJump> jump;
    std::shared_ptr<const MotionPoses> poses;
    std::shared_ptr<const MotionPoses> flight;
  };
  std::shared_ptr<SharedJumpSolve> SolveOf(const JumpTask& task) const;
  Solved Examined(std::shared_ptr<const SolvedJump> jump) const;

  std::unique_ptr<JumpSolver> solver_;
  std::unique_ptr<JumpLibrary> library_;
  JumpReach reach_;
  const LocomotionModel::TransitionEntry* transition_ = nullptr;  ///< from launch to landing gait
  Eigen::AlignedBox3d room_;  ///< of the gaits and the transition, in the launch stance
  /// Ground this wide around the frames of both stances is enough, m. Narrower ground is tested in
  /// detail.
  double wide_ground_;
  double highest_rise_ = 0;  ///< m, of a flight above its launch
  models::CollisionChecker pelvis_checker_;
  PelvisClearance pelvis_;

  /// Results of jobs; everything below is guarded by mutex_.
  mutable std::mutex mutex_;
  mutable std::vector<JumpTask> impossible_;
  mutable std::vector<Leap> refuted_;  ///< at their places
  mutable std::vector<Solved> solved_;
  mutable std::vector<std::shared_ptr<SharedJumpSolve>> solves_;
};

/// Factories of the jumps in a robot's file, for the planner. `skip_growth`:
/// ManoeuvreFactory::skip_growth.
std::vector<ManoeuvreFactory> JumpFactories(const models::RobotModel& robot,
                                            double skip_growth = 0);

}  // namespace possibility::actions
