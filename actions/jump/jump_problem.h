#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "actions/sagittal/sagittal_problem.h"
#include "collocation/transcription/transcription.h"

namespace possibility::actions {

/// A jump in the plane: displacement of the stance frame from launch to landing.
struct JumpTask {
  double distance = 0;  ///< m, forward
  double height = 0;    ///< m, of the landing ground above the launch ground
};

/// l: the leg's length (NaturalUnits).
struct JumpSettings : SagittalSettings {
  double min_stance_pitch = -0.5;  ///< rad: lean backward at most, while the feet push
  double max_stance_pitch = 1.1;   ///< rad: lean forward at most
  /// Times sqrt(g l), along x and z, of the contact points before touchdown: limits the impact.
  double max_contact_speed = 0.6;
  /// Largest leg length at touchdown, as a fraction of the stretched leg's: nearly straight legs
  /// cannot absorb an impact.
  double leg_reach = 0.93;
  /// Times sqrt(l / g): the robot balances on the line of its toes for no longer. It falls over
  /// that line meanwhile, and a slope or a push that the plan does not know grows with it.
  double longest_toe_push = 0.58;
  /// Least shares of the soles' load until the hands touch down. The way to the toes is what a
  /// robot that lands too fast or leans too far has to stop in.
  SoleShares settling = {.heel = 0.35, .toe = 0.15};
  /// Share of the torques that may be used until the hands touch down, if that is less than
  /// `limits` allows.
  double settling_torque = 1;
  double time_weight = 0;  ///< 1/s, of the duration in the cost

  /// The defaults. A jump that lands on its feet alone is over when it stands: its time counts,
  /// too. A robot whose rotors are known uses less of its torque.
  static JumpSettings For(const models::RobotModel& robot, const NominalStance& launch,
                          const NominalStance& landing);
};

/// Hash of what solved jumps from one gait to another depend on (motion_identity.h).
std::string JumpIdentity(const models::RobotModel& robot, const JumpSettings& settings,
                         const std::string& from, const std::string& to);

/// The sagittal jump as one optimal-control problem: crouch and push on the soles, push on the
/// toes, rise and descend (equal times), inelastic impact of the feet, settle on the feet until the
/// hands touch down at zero speed, and move on until the robot rests in the landing stance. A leap
/// lands on the feet alone: both of the last phases bear on them.
class JumpProblem : public SagittalProblem {
 public:
  enum PhaseIndex { kCrouch, kToes, kRise, kDescent, kSettle, kLanding, kNumPhases };
  static constexpr double kLongestHalfFlight = 2;  ///< times sqrt(l / g), rise and descent each

  /// `model` must outlive the problem.
  JumpProblem(const SagittalModel& model, const JumpTask& task, const JumpSettings& settings);

  JumpTask task() const { return {distance_, height_}; }
  const SagittalSettings& settings() const { return settings_; }

  /// Impulses of the feet's impact at heel and toe, x and z, N s.
  Eigen::Matrix2Xd Impulses(const collocation::Trajectory& trajectory) const;

 private:
  void AddPhases(const JumpSettings& settings);
  void Push(const JumpSettings& settings);
  void Fly(const JumpSettings& settings);
  void Land(const JumpSettings& settings);
  void AddImpact();
  void GuessMotion();
  /// The root is `above` (m, by share of the phase) the line that GuessLine draws.
  void GuessHeight(int phase, double from, double to, const std::function<double(double)>& above);

  std::vector<collocation::Variable> impulses_;
};

}  // namespace possibility::actions
