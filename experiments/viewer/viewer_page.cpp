#include "experiments/viewer/viewer_page.h"

#include <fmt/format.h>

#include <map>
#include <string_view>

#include "experiments/support/xml_text.h"
#include "experiments/viewer/viewer_resources.h"

namespace possibility::experiments {
namespace {

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

/// `others`: elements with the data of further plans.
std::string PageOf(const std::string& title, const std::string& data, const std::string& others) {
  const std::string escaped_title = XmlText(title);
  return FillIn(viewer_resources::page, {{"title", escaped_title},
                                         {"data", data},
                                         {"others", others},
                                         {"style", viewer_resources::style},
                                         {"three", viewer_resources::three},
                                         {"convex_hull", viewer_resources::convex_hull},
                                         {"convex_geometry", viewer_resources::convex_geometry},
                                         {"orbit_controls", viewer_resources::orbit_controls},
                                         {"scripts", viewer_resources::scripts}});
}

std::string DataOf(const PageSubject& subject) {
  return ViewerDataJson(subject.plan, subject.robot, subject.scenario,
                        HeadingOf(subject.plan, subject.robot, subject.scenario));
}

}  // namespace

std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario) {
  return ViewerPage(plan, robot, scenario, HeadingOf(plan, robot, scenario));
}

std::string ViewerPage(const actions::Plan& plan, const models::RobotModel& robot,
                       const models::Scenario& scenario, const PageHeading& heading) {
  return PageOf(heading.title, ViewerDataJson(plan, robot, scenario, heading), "");
}

std::string ComparisonPage(const PageSubject& left, const PageSubject& right) {
  const std::string other = fmt::format(
      "<script type=\"application/json\" id=\"plan-data-b\">{}</script>", DataOf(right));
  return PageOf(fmt::format("{} and {} – possibility", left.scenario.name, right.scenario.name),
                DataOf(left), other);
}

}  // namespace possibility::experiments
