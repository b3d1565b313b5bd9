#include "experiments/service/plan_watch.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "actions/replanning/replanner.h"
#include "common/cancellation_token.h"
#include "common/stopwatch.h"
#include "experiments/service/plan_output.h"
#include "experiments/service/watched_file.h"
#include "experiments/support/progress_line.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

std::string Share(std::int64_t kept, std::int64_t all, const char* what) {
  return fmt::format("{} of {} {}", kept, all, what);
}

/// One version of the scenario, and the answer to it.
struct Answer {
  const models::RobotModel& robot;
  const actions::PlanResult& result;
  const actions::Reuse& reuse;
  PlanFiles files;
  double seconds = 0;

  bool found() const { return result.status == actions::PlanStatus::kFound; }
};

Json ReuseJson(const Answer& answer) {
  const actions::VerificationReport& report = answer.result.verification;
  Json json;
  json["seconds"] = answer.seconds;
  json["plan_kept"] = answer.reuse.plan;
  json["model_kept"] = answer.reuse.model;
  json["samples"] = report.samples;
  json["samples_kept"] = report.kept_samples;
  json["simulations"] = report.rollouts.size();
  json["simulations_kept"] = report.kept_rollouts;
  return json;
}

void PrintJson(const Answer& answer) {
  Json json = Json::parse(SummaryJson(answer.result, answer.robot, answer.files));
  json["replanning"] = ReuseJson(answer);
  PrintOut("{}\n", models::JsonText(json));
}

void PrintLine(const Answer& answer) {
  if (!answer.found()) {
    PrintOut("no plan: {}, in {:.2f} s\n", actions::ToString(answer.result.status), answer.seconds);
    return;
  }
  const actions::VerificationReport& report = answer.result.verification;
  PrintOut("found: {:.2f} s, in {:.2f} s; kept {}{}, {}\n", answer.result.plan.duration(),
           answer.seconds,
           answer.reuse.plan    ? "the plan, "
           : answer.reuse.model ? "the robot's gaits, "
                                : "",
           Share(report.kept_samples, report.samples, "samples"),
           Share(report.kept_rollouts, static_cast<std::int64_t>(report.rollouts.size()),
                 "simulations"));
}

/// The state between one version of the file and the next.
class Watch {
 public:
  explicit Watch(const WatchJob& job) : job_(job), file_(job.scenario) {}

  void Run() {
    AnswerVersion();
    for (;;) {
      file_.AwaitChange();
      try {
        AnswerVersion();
      } catch (const InputError& error) {
        ReportError(error.what());
      }
    }
  }

 private:
  /// Answers what the file has now. Begins again where the file changes meanwhile.
  void AnswerVersion() {
    for (bool is_answered = false; !is_answered;) {
      file_.Accept();
      try {
        Plan();
        is_answered = true;
      } catch (const Cancelled&) {
      }
    }
  }

  void Plan() {
    const Stopwatch stopwatch;
    const models::Scenario scenario = models::LoadScenario(job_.scenario);
    if (!robot_ || robot_->file != scenario.robot_file ||
        robot_->content_hash != scenario.robot_hash) {
      robot_ = models::LoadRobotModel(scenario.robot_file);
    }
    actions::PlanRequest request = job_.request_for(scenario);
    request.cancellation = CancellationToken([this] { return !file_.HasChanged(); });
    const actions::PlanResult result = PlanWithProgress(scenario, request);
    const PlanFiles files = PlanFilesIn(job_.folder, request.plan_version);
    WriteOnlyPlan(result.plan, *robot_, files);
    Print({*robot_, result, replanner_.reuse(), files, stopwatch.Seconds()});
    WritePage(result.plan, *robot_, scenario, files);
  }

  actions::PlanResult PlanWithProgress(const models::Scenario& scenario,
                                       actions::PlanRequest request) {
    ProgressLine line(request.time_limit);
    request.progress = [&line](const actions::PlanProgress& progress) { line.Show(progress); };
    return replanner_.Plan(*robot_, scenario, std::move(request));
  }

  void Print(const Answer& answer) {
    if (job_.json) return PrintJson(answer);
    if (is_first_ && answer.found()) {
      PrintOut("{}", SummaryText(answer.result, answer.robot, answer.files));
    } else {
      PrintLine(answer);
    }
    is_first_ = false;
    if (!answer.found() && !answer.result.explanation.empty()) {
      PrintError("no plan: {}: {}\n", actions::ToString(answer.result.status),
                 answer.result.explanation);
    }
  }

  void ReportError(const std::string& line) const {
    PrintError("{}\n", line);
    if (job_.json) PrintOut("{}\n", models::JsonText(Json{{"status", "error"}, {"error", line}}));
  }

  const WatchJob& job_;
  WatchedFile file_;
  std::optional<models::RobotModel> robot_;
  actions::Replanner replanner_;
  bool is_first_ = true;
};

}  // namespace

void WatchAndPlan(const WatchJob& job) { Watch(job).Run(); }

}  // namespace possibility::experiments
