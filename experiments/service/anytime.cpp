#include "experiments/service/anytime.h"

#include <algorithm>
#include <utility>

#include "common/deadline.h"
#include "experiments/service/plan_output.h"
#include "experiments/support/progress_line.h"
#include "experiments/support/standard_streams.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

void PrintImprovement(const actions::PlanResult& result, const Deadline& deadline) {
  PrintOut(
      "{:.1f} s: plan of {:.2f} s, no plan takes less than {:.2f} s, gap {:.1f} %, {:.1f} s "
      "left\n",
      deadline.Elapsed(), result.plan.duration(), result.least_duration, 100 * GapOf(result),
      deadline.Remaining());
}

void PrintImprovementJson(const actions::PlanResult& result, const models::RobotModel& robot,
                          const PlanFiles& files, const Deadline& deadline) {
  Json json = Json::parse(SummaryJson(result, robot, files));
  json["anytime"] = {{"elapsed_s", deadline.Elapsed()},
                     {"least_duration_s", result.least_duration},
                     {"gap", GapOf(result)},
                     {"left_s", deadline.Remaining()}};
  PrintOut("{}\n", models::JsonText(json));
}

}  // namespace

double GapOf(const actions::PlanResult& result) {
  const double duration = result.plan.duration();
  return duration > 0 ? std::max(0.0, 1 - result.least_duration / duration) : 0;
}

actions::PlanResult PlanAnytime(const models::RobotModel& robot, const models::Scenario& scenario,
                                actions::PlanRequest request, const PlanFiles& files, bool json) {
  const Deadline deadline(request.time_limit);
  ProgressLine line(request.time_limit);
  request.progress = [&line](const actions::PlanProgress& progress) { line.Show(progress); };
  request.improved = [&](const actions::PlanResult& result) {
    WriteOnlyPlan(result.plan, robot, files);
    if (json) return PrintImprovementJson(result, robot, files, deadline);
    PrintImprovement(result, deadline);
  };
  return actions::PlanTraversal(robot, scenario, request);
}

}  // namespace possibility::experiments
