#pragma once

#include <functional>
#include <string>
#include <vector>

#include "actions/footholds/footstep.h"
#include "actions/plan/plan.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/self_clearance.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Thrown when a step of a sequence cannot be executed.
class FootstepError : public MotionError {
 public:
  /// What of the step is at fault: all of it, or the posture at one of its ends.
  enum class Part { kStep, kFrom, kTo };

  /// Whether the robot hits an obstacle: while a limb swings, or all of them bear.
  enum class Hit { kNone, kSwinging, kBearing };

  /// `step`: index; -1 if it is not known which one.
  FootstepError(const std::string& message, int step, Hit hit = Hit::kNone, Part part = Part::kStep,
                Limit limit = Limit::kAny)
      : MotionError(message, -1, limit), step_(step), hit_(hit), part_(part) {}
  int step() const { return step_; }
  Hit hit() const { return hit_; }
  bool is_hit() const { return hit_ != Hit::kNone; }
  Part part() const { return part_; }

 private:
  int step_;
  Hit hit_;
  Part part_;
};

/// Motion of footsteps over ground of any heights, from rest to rest: pattern motion
/// (pattern_motion.h), as tall as the legs reach. Steps that the robot cannot execute as quickly
/// are slowed down, with their neighbours. Immutable; may be used in several threads.
class FootstepMotion {
 public:
  /// Throws FootstepError if a motion like this rough one, in a fifth of the time to build, is of
  /// no use. Knots have time and configuration alone. A hit ends the building in all styles.
  using RoughTest = std::function<void(const std::vector<Phase>& rough)>;

  /// Both must outlive this.
  FootstepMotion(const models::RobotModel& robot, const NominalStance& stance);

  /// From the nominal stance at `start`, in which the first steps begin, to that in which the last
  /// ones end; times from 0.
  /// @throws FootstepError naming the limit that the robot would exceed; Cancelled.
  /// `style`: number of the first style to try, 0 at first; becomes that of the result, or of
  /// the hit that ends the building. So steps of which only lifts have changed need not fail in the
  /// others again. May be null.
  /// `most_torque`: share of the joints' torques that is never exceeded, whatever the style.
  /// `require_rough`: may be empty; asked before a motion is built.
  std::vector<Phase> Build(const Foothold& start, const std::vector<Footstep>& steps,
                           const CancellationToken& cancellation = {}, int* style = nullptr,
                           double most_torque = 1, const RoughTest& require_rough = {}) const;

  /// Of the motion, if no step has to be slower, s.
  double ExpectedDuration(const std::vector<Footstep>& steps) const;

  /// From one step to the next at least, s.
  double LeastStepTime() const;

  /// Index of the step in which phase `phase` of such a motion swings, or that it follows or leads
  /// to.
  static int StepOfPhase(int phase, int steps);
  /// Whether a limb swings in that phase: phases alternate.
  static bool SwingsIn(int phase) { return phase % 2 == 1; }

 private:
  /// How the whole motion is carried out.
  struct Style {
    double rise = 0;           ///< PatternSettings
    double lean = 0;           ///< PatternSettings
    double spacing = 0;        ///< PatternSettings::height_spacing
    double torque_margin = 0;  ///< MotionSettings
    double self_distance = 0;  ///< m, between links
    double least_load = 0;     ///< MotionSettings::normal_reserve
    double zmp_ahead = 0;      ///< PatternSettings
    double zmp_margin = 0;     ///< of PatternSettings, as a share of the gait's
    double sway = 0;           ///< of all steps: PatternSettings
    bool is_patient = true;    ///< steps that need too much torque or friction are slowed down
  };

  /// How a single step is carried out.
  struct Pace {
    double slowness = 1;  ///< times its duration
    double sway = 0;      ///< rad, PatternSettings
  };

  std::vector<Phase> BuildAtOrigin(const Foothold& start, const std::vector<Footstep>& steps,
                                   double most_torque, const CancellationToken& cancellation,
                                   int* first, const RoughTest& require_rough) const;
  std::vector<Style> Styles() const;
  /// Whether a slower motion may keep a limit that one in this style exceeds.
  static bool SpeedMatters(const Style& style, MotionError::Limit limit);
  /// Whether a style may keep a limit that another one exceeded.
  static bool MayHelp(const Style& style, MotionError::Limit limit);
  std::vector<Phase> BuildIn(const Style& style, const Foothold& start,
                             const std::vector<Footstep>& steps,
                             const CancellationToken& cancellation,
                             const RoughTest& require_rough) const;
  /// Changes the paces of steps so that a motion may keep a limit that it exceeded at one of them.
  /// False if nothing is left to change.
  static bool Ease(const MotionError& error, const Style& style, int step,
                   std::vector<Pace>* paces);
  std::vector<Phase> BuildAt(const std::vector<Pace>& paces, const Style& style,
                             const Foothold& start, const std::vector<Footstep>& steps,
                             const CancellationToken& cancellation) const;
  /// How closely a pattern's centre of mass is computed: see PatternSettings.
  struct Accuracy {
    double grid = 0;  ///< s
    int least_steps = 1;
    int filter_passes = 1;
  };
  std::vector<MotionPhase> PhasesOf(const std::vector<Pace>& paces, const Style& style,
                                    const Accuracy& accuracy, const Foothold& start,
                                    const std::vector<Footstep>& steps,
                                    const CancellationToken& cancellation) const;
  /// Of the footholds, in the phases of the motion.
  void SetFriction(const Foothold& start, const std::vector<Footstep>& steps,
                   std::vector<MotionPhase>* phases) const;
  Eigen::VectorXd GuessAt(const Foothold& start) const;
  /// Empty where it cannot be built.
  std::vector<Phase> RoughMotion(const Style& style, const Foothold& start,
                                 const std::vector<Footstep>& steps,
                                 const CancellationToken& cancellation) const;
  models::ContactSchedule ScheduleOf(const std::vector<Pace>& paces, const Foothold& start,
                                     const std::vector<Footstep>& steps) const;
  void RequireSelfClearance(const std::vector<Phase>& motion, double distance, int steps) const;

  const models::RobotModel* robot_;
  const NominalStance* stance_;
  SelfClearance self_clearance_;
  bool has_two_limbs_;
  double sideways_load_;  ///< of two limbs
  double tempo_;          ///< durations of steps: share of a biped's
};

}  // namespace possibility::actions
