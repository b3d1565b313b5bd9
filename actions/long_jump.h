#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actions/jump_library.h"
#include "actions/locomotion_model.h"
#include "actions/pelvis_clearance.h"
#include "actions/placed_jump.h"
#include "actions/quasi_static_action.h"
#include "graph/action.h"
#include "models/collision.h"

namespace possibility::actions {

/// The standing long jump (paper, section "Standing Long Jump"): nonholonomic, from a stance of
/// one gait straight ahead into a stance of another, by distances on the jump library's grid. Its
/// necessary conditions are those of the paper; what they leave open costs a confirmation job. One
/// exploring thread per instance, beside any number of its jobs.
class LongJump : public graph::NonholonomicAction {
 public:
  /// Of a jump that is not solved yet, s.
  static constexpr double kNominalDuration = 4.5;

  /// `jump`: index into the model's. `launch`, `landing`: the actions of its gaits. `reach`: which
  /// jumps are worth examining. `model` and `world` must outlive the action.
  LongJump(const LocomotionModel& model, int jump, const World& world,
           std::shared_ptr<const QuasiStaticAction> launch,
           std::shared_ptr<const QuasiStaticAction> landing, JumpReach reach);
  ~LongJump() override;

  /// Jobs that ended with a "no" say why.
  struct Refusal {
    graph::PointPair edge;
    std::string reason;
  };

  std::string name() const override { return entry().name; }
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point& v1) const override;
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point& v1) const override;
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point& v1) const override;

  /// A stance that one can launch from or land in.
  bool CN(const graph::Point& vertex) const override;
  bool CN(const graph::PointPair& edge) const override;
  bool CS(const graph::Point& vertex) const override { return CN(vertex); }
  /// Whether a job has confirmed it.
  bool CS(const graph::PointPair& edge) const override;
  bool Explorable(const graph::Point& vertex) const override { return CN(vertex); }
  /// C_N, unless a job has refuted it, or the gaits have a way of their own straight on.
  bool Explorable(const graph::PointPair& edge) const override;

  double ExpectedDuration(const graph::PointPair& edge) const override;
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::PointPair& edge) const override;

  /// Which jumps are worth examining from now on. Not while FindPath explores in another thread.
  void SetReach(JumpReach reach) { reach_ = std::move(reach); }
  const JumpReach& reach() const { return reach_; }

  /// The edge failed as motion although a job had confirmed it: impossible from now on.
  /// `anywhere`: and so is every jump of its distance and height, for what is wrong with it does
  /// not depend on the place.
  void Forbid(const graph::PointPair& edge, const std::string& reason, bool anywhere = false);
  std::vector<Refusal> Refusals() const;

  const LocomotionModel::JumpEntry& entry() const { return model_->jumps[jump_]; }

 private:
  class Job;
  class SharedSolve;

  /// An edge, understood.
  struct Leap {
    GroundedStance launch;
    GroundedStance landing;
    JumpTask task;  ///< on the grid
  };
  struct Verdict {
    graph::PointPair edge;
    bool possible = false;
    std::string reason;
  };

  std::optional<Leap> AsLeap(const graph::PointPair& edge) const;
  /// The longest jump from `stance`, of at most `distance`, with ground to bear on at the other
  /// end: forward from a launch, or backward from a landing.
  std::optional<GroundedStance> OtherEnd(const GroundedStance& stance, double distance,
                                         bool forward) const;
  /// Whether C_S lets the robot walk straight on from the launch and change gait into the landing,
  /// or the other way round: such a jump leads nowhere new, and Algorithm 4 would make one from
  /// every new landing.
  bool IsNeedless(const GroundedStance& launch, const GroundedStance& landing) const;
  bool GroundIsWide(const GroundedStance& launch, double begin, double end) const;
  /// Whether nothing at all is near the straight way on from `launch`, `distance` (m) long.
  bool WayIsOpen(const GroundedStance& launch, double distance) const;
  std::optional<GroundedStance> LaunchStance(const graph::Point& v) const;
  std::optional<GroundedStance> LandingStance(const graph::Point& v) const;
  graph::Point PointOf(const GroundedStance& stance) const;
  bool SomeParabolaIsFree(const graph::PointPair& edge) const;
  bool ParabolaIsFree(const graph::PointPair& edge, double rise) const;

  std::optional<Verdict> VerdictOn(const graph::PointPair& edge) const;
  void Record(const graph::PointPair& edge, bool possible, const std::string& reason) const;
  void RecordImpossible(const JumpTask& task) const;
  bool IsImpossible(const JumpTask& task) const;
  /// With what it hits wherever it happens, if anything.
  struct Solved {
    std::shared_ptr<const SolvedJump> jump;
    std::shared_ptr<const JumpPoses> poses;
    std::string hit;
  };
  std::shared_ptr<SharedSolve> SolveOf(const JumpTask& task) const;
  Solved Examined(std::shared_ptr<const SolvedJump> jump) const;

  const LocomotionModel* model_;
  int jump_;
  World world_;
  std::shared_ptr<const QuasiStaticAction> launch_;
  std::shared_ptr<const QuasiStaticAction> landing_;
  JumpReach reach_;
  const LocomotionModel::TransitionEntry* transition_ = nullptr;  ///< from launch to landing gait
  Eigen::AlignedBox3d room_;  ///< that the gaits and the transition take, in the launch stance
  double highest_rise_ = 0;   ///< m, of a flight above its launch
  models::CollisionChecker pelvis_checker_;
  models::CollisionChecker robot_checker_;
  PelvisClearance pelvis_;

  /// What jobs found out; everything below under mutex_.
  mutable std::mutex mutex_;
  mutable std::vector<Verdict> verdicts_;
  mutable std::vector<JumpTask> impossible_;
  mutable std::vector<Solved> solved_;
  mutable std::vector<std::shared_ptr<SharedSolve>> solves_;
};

}  // namespace possibility::actions
