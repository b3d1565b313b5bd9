#pragma once

#include <optional>
#include <string>

namespace possibility::actions {

/// Parsed Segment::action: a gait, jump or manoeuvre ("walk"), or the transition from one gait to
/// another ("walk->crawl").
struct SegmentAction {
  std::string from;
  std::string to;  ///< equals `from` unless it is a transition
  bool is_transition = false;
};

/// None unless `text` is one name, or two joined by "->" (models/input/action_name.h).
std::optional<SegmentAction> ParseSegmentAction(const std::string& text);

}  // namespace possibility::actions
