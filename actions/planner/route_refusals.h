#pragma once

#include <string>
#include <vector>

#include "actions/verify/verifier.h"

namespace possibility::actions {

/// Routes that were confirmed edge by edge and came to nothing all the same: how many, and what was
/// wrong with the first of them. Kept for the explanation of an answer without a plan.
class RouteRefusals {
 public:
  /// Motion generation could not turn `leg`, words for one of the route's, into motion.
  void ByMotion(const std::string& leg, const std::string& why);

  /// The verifier refused the motion; what it had found, if it was abandoned. `legs`: words for
  /// the route's, in the order of the plan's segments.
  void ByVerification(const VerificationReport& report, const std::vector<std::string>& legs);

  /// One sentence that begins with a space; nothing if nothing was refused.
  std::string Explain() const;

 private:
  void Add(const std::string& what);

  int by_motion_ = 0;
  int by_verification_ = 0;
  std::string first_;
};

/// "penetration, left wrist against floor, 0.012 m (limit 0.0001)".
std::string Describe(const Violation& violation);

}  // namespace possibility::actions
