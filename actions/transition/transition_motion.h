#pragma once

#include <filesystem>
#include <vector>

#include "actions/transition/transition_solver.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/planar_pose.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The transition from one gait's nominal stance to another's. Patches that both gaits use stay in
/// place; the others touch down at zero speed at their nominal places in the second gait.
class TransitionMotion {
 public:
  /// `library`: folder of solved motions; empty: none. A motion that it lacks is solved.
  /// @throws InputError if the two stances disagree about the shared patches, or the robot cannot
  /// execute the transition; Cancelled.
  TransitionMotion(const models::RobotModel& robot, const NominalStance& from,
                   const NominalStance& to, const std::filesystem::path& library,
                   const CancellationToken& cancellation);

  const NominalStance& from() const { return *from_; }
  const NominalStance& to() const { return *to_; }

  /// Stance frame of the second gait in the frame of the first.
  const PlanarPose& displacement() const { return displacement_; }

  /// In the first gait's stance frame, from rest to rest; the backward motion is its Reversed().
  const std::vector<Phase>& phases() const { return solved_.phases; }
  double ExpectedDuration() const { return phases().back().knots.back().t; }  ///< s

  bool was_known() const { return was_known_; }  ///< read from the library
  /// Saves the solution to the library. @throws InputError if that fails.
  void Save() const;

 private:
  void AlignStances(const models::RobotModel& robot);
  bool FindInLibrary(const TransitionSolver& solver);

  const NominalStance* from_;
  const NominalStance* to_;
  PlanarPose displacement_;
  std::filesystem::path file_;  ///< of the solution; empty: no library
  SolvedTransition solved_;
  bool was_known_ = false;
};

}  // namespace possibility::actions
