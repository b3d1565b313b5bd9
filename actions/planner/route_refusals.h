#pragma once

#include <string>
#include <vector>

#include "actions/verify/verifier.h"

namespace possibility::actions {

/// Counts routes that were confirmed edge by edge but failed as motion or in verification, and
/// keeps the fault of the first one, to explain an answer without a plan.
class RouteRefusals {
 public:
  /// Adds a route for which motion generation failed at `leg` (a description of the leg).
  void ByMotion(const std::string& leg, const std::string& why);

  /// Adds a route whose motion the verifier refused; a cancelled report holds the violations found
  /// so far. `legs`: descriptions of the route's legs, in the order of the plan's segments.
  void ByVerification(const VerificationReport& report, const std::vector<std::string>& legs);

  /// One sentence that begins with a space; empty if nothing was refused.
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
