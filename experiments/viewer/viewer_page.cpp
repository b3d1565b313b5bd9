#include "experiments/viewer/viewer_page.h"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "experiments/viewer/viewer_resources.h"

namespace possibility::experiments {
namespace {

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '&':
        escaped += "&amp;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

/// Replaces every {{name}} of the template in one pass, so that inserted text is never searched.
std::string FillIn(std::string_view text,
                   const std::map<std::string_view, std::string_view>& parts) {
  std::string filled;
  while (true) {
    const std::size_t begin = text.find("{{");
    const std::size_t end = text.find("}}", begin);
    filled += text.substr(0, begin);
    if (end == std::string_view::npos) return filled;
    filled += parts.at(text.substr(begin + 2, end - begin - 2));
    text.remove_prefix(end + 2);
  }
}

}  // namespace

std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario) {
  return ViewerPage(plan, robot, scenario, HeadingOf(plan, robot, scenario));
}

std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario, const PageHeading& heading) {
  const std::string title = EscapeHtml(heading.title);
  const std::string data = ViewerDataJson(plan, robot, scenario, heading);
  return FillIn(viewer_resources::page, {{"title", title},
                                         {"data", data},
                                         {"style", viewer_resources::style},
                                         {"three", viewer_resources::three},
                                         {"convex_hull", viewer_resources::convex_hull},
                                         {"convex_geometry", viewer_resources::convex_geometry},
                                         {"orbit_controls", viewer_resources::orbit_controls},
                                         {"scripts", viewer_resources::scripts}});
}

}  // namespace possibility::experiments
