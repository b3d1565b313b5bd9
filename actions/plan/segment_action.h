#pragma once

#include <optional>
#include <string>

namespace possibility::actions {

/// What Segment::action says: a gait, jump or manoeuvre ("walk"), or the transition from one gait
/// to another ("walk->crawl").
struct SegmentAction {
  std::string from;
  std::string to;  ///< the same unless it is a transition
  bool is_transition = false;
};

/// Nothing unless it is one name, or two with "->" between (models/input/action_name.h).
std::optional<SegmentAction> ParseSegmentAction(const std::string& text);

}  // namespace possibility::actions
