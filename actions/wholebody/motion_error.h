#pragma once

#include <stdexcept>
#include <string>

namespace possibility::actions {

/// Thrown when a motion cannot be generated: out of reach, beyond a limit, no contact forces.
class MotionError : public std::runtime_error {
 public:
  /// What a motion exceeds: the range of a joint, torque, friction, or something else that may depend
  /// on its speed.
  enum class Limit { kAny, kJointRange, kTorque, kFriction };

  /// `phase`: index of the phase at fault, -1 if none is; `share`: how much of it has passed.
  explicit MotionError(const std::string& message, int phase = -1, Limit limit = Limit::kAny,
                       double share = 0)
      : std::runtime_error(message), phase_(phase), limit_(limit), share_(share) {}
  int phase() const { return phase_; }
  Limit limit() const { return limit_; }
  double share() const { return share_; }

 private:
  int phase_;
  Limit limit_;
  double share_;
};

}  // namespace possibility::actions
