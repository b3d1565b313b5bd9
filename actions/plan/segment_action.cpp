#include "actions/plan/segment_action.h"

#include <string_view>

#include "models/input/action_name.h"

namespace possibility::actions {

std::optional<SegmentAction> ParseSegmentAction(const std::string& text) {
  constexpr std::string_view kArrow = "->";
  const std::size_t arrow = text.find(kArrow);
  SegmentAction action;
  action.is_transition = arrow != std::string::npos;
  action.from = text.substr(0, arrow);
  action.to = action.is_transition ? text.substr(arrow + kArrow.size()) : action.from;
  if (!models::IsActionName(action.from) || !models::IsActionName(action.to)) return std::nullopt;
  return action;
}

}  // namespace possibility::actions
