#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "actions/planner/planner.h"
#include "actions/rollout/perturbed_rollouts.h"
#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "common/cancellation_token.h"
#include "common/stopwatch.h"
#include "experiments/command/perturbation_option.h"
#include "experiments/support/preset_names.h"
#include "models/input/input_error.h"
#include "models/robot/robot_yaml.h"
#include "python/bindings.h"
#include "python/interruptible.h"

namespace possibility::python {
namespace {

namespace py = pybind11;
using actions::PlanProgress;
using actions::PlanRequest;
using actions::PlanResult;
using experiments::LoadedPlan;
using SharedScenario = std::shared_ptr<models::Scenario>;

/// The planner's latest report, from its thread to Python's.
class ProgressMail {
 public:
  void Put(const PlanProgress& progress) {
    const std::lock_guard lock(mutex_);
    progress_ = progress;
  }
  /// A report of another stage, or one that is 0.1 s younger than the last one taken.
  std::optional<PlanProgress> Take() {
    constexpr double kInterval = 0.1;  // s
    const std::lock_guard lock(mutex_);
    if (!progress_ || (progress_->stage == stage_ && since_.Seconds() < kInterval)) return {};
    stage_ = progress_->stage;
    since_ = {};
    return std::exchange(progress_, std::nullopt);
  }

 private:
  std::string stage_;  ///< of the report last taken
  Stopwatch since_;    ///< it was taken
  std::mutex mutex_;
  std::optional<PlanProgress> progress_;
};

/// What a planning thread uses and leaves behind.
struct PlanningTask {
  SharedScenario scenario;
  PlanRequest request;
  ProgressMail progress;
  std::shared_ptr<LoadedPlan> loaded = std::make_shared<LoadedPlan>();
  PlanResult result;
};

void PlanOnThisThread(PlanningTask* task, const CancellationToken& cancellation) {
  task->loaded->robot = models::LoadRobotModel(task->scenario->robot_file);
  task->loaded->file = "the plan";
  task->loaded->scenario = *task->scenario;
  PlanRequest& request = task->request;
  if (request.library.empty()) request.library = task->loaded->robot.file.parent_path() / "jumps";
  request.cancellation = cancellation;
  request.progress = [task](const PlanProgress& progress) { task->progress.Put(progress); };
  task->result = actions::PlanTraversal(task->loaded->robot, *task->scenario, request);
  request.progress = {};
  request.cancellation = {};
  task->loaded->plan = std::move(task->result.plan);
}

py::dict ToDict(const PlanProgress& progress) {
  py::dict entry;
  entry["stage"] = progress.stage;
  entry["fraction"] = progress.fraction;
  entry["seconds"] = progress.graph.seconds;
  entry["vertices"] = progress.graph.vertices;
  entry["edges"] = progress.graph.edges;
  entry["jobs"] = progress.graph.jobs;
  return entry;
}

py::tuple PlanScenario(const SharedScenario& scenario, std::uint64_t seed, int threads,
                       double time_limit, const std::vector<std::string>& actions,
                       const std::string& preset, const std::string& library,
                       const py::object& progress) {
  auto task = std::make_shared<PlanningTask>();
  task->scenario = scenario;
  task->request.seed = seed;
  task->request.threads = threads;
  task->request.time_limit = time_limit;
  task->request.actions = actions;
  task->request.library = library;
  task->request.preset = experiments::ParsePreset("preset", preset);
  std::function<void()> poll;
  if (!progress.is_none()) {
    poll = [&] {
      if (const auto latest = task->progress.Take()) progress(ToDict(*latest));
    };
  }
  RunInterruptibly([task](const CancellationToken& token) { PlanOnThisThread(task.get(), token); },
                   poll);
  return py::make_tuple(actions::ToString(task->result.status), task->result.explanation,
                        task->loaded, actions::FormatJson(task->result.verification));
}

/// The verifier's report. Cancelled by Ctrl-C.
actions::VerificationReport Verified(const SharedPlan& loaded, int threads, bool simulates,
                                     bool measures_margins) {
  experiments::RequireMotion(*loaded);
  auto report = std::make_shared<actions::VerificationReport>();
  RunInterruptibly([=](const CancellationToken& cancellation) {
    actions::VerifierSettings settings;
    settings.cancellation = cancellation;
    settings.threads = threads;
    settings.simulates = simulates;
    settings.measures_margins = measures_margins;
    *report = actions::Verify(loaded->plan, loaded->robot, loaded->scenario, settings);
  });
  return *report;
}

py::dict ToDict(const actions::StretchRollout& stretch) {
  const actions::RolloutDrift& drift = stretch.drift;
  py::dict entry;
  entry["segment"] = stretch.segment;
  entry["last_segment"] = stretch.last_segment;
  entry["start_s"] = drift.start;
  entry["end_s"] = drift.end;
  entry["survives"] = drift.survives();
  entry["fell_at_s"] = drift.fell_at;
  entry["worst_position_m"] = drift.worst_position;
  entry["worst_orientation_rad"] = drift.worst_orientation;
  entry["worst_joint"] = drift.worst_joint;
  entry["end_position_m"] = drift.end_position;
  entry["end_orientation_rad"] = drift.end_orientation;
  entry["torque_used"] = drift.torque_used;
  entry["slide_m"] = drift.slide;
  entry["failure"] = drift.failure;
  return entry;
}

/// A plan that breaks other rules has no motion worth simulating, and may not have one at all.
void RequireAccepted(const SharedPlan& loaded, int threads) {
  const actions::VerificationReport report = Verified(loaded, threads, false, false);
  if (report.accepted()) return;
  const actions::Violation& violation = report.violations.front();
  throw InputError(fmt::format("the plan is not simulated because it is rejected: {}, {}",
                               ToString(violation.kind), violation.quantity));
}

/// `text`: as on the command line; empty: the robot and the ground as planned.
py::list RollOut(const SharedPlan& loaded, const std::string& text, int threads) {
  const actions::Perturbation perturbation =
      text.empty() ? actions::Perturbation() : experiments::ParsePerturbation(text).perturbation;
  RequireAccepted(loaded, threads);
  auto rollouts = std::make_shared<std::vector<actions::PerturbedRollout>>();
  RunInterruptibly([=](const CancellationToken& cancellation) {
    actions::PerturbedRolloutsSettings settings;
    settings.threads = threads;
    settings.cancellation = cancellation;
    *rollouts = actions::RollOutPerturbed(loaded->plan, loaded->robot, loaded->scenario,
                                          {perturbation}, settings);
  });
  py::list stretches;
  for (const actions::StretchRollout& stretch : rollouts->front().stretches) {
    stretches.append(ToDict(stretch));
  }
  return stretches;
}

}  // namespace

void BindPlanning(py::module_& module) {
  module.def("plan", &PlanScenario);
  module.def("verify", [](const std::shared_ptr<LoadedPlan>& loaded, int threads, bool simulates) {
    return actions::FormatJson(Verified(loaded, threads, simulates, true));
  });
  module.def("rollout", [](const std::shared_ptr<LoadedPlan>& loaded, const std::string& text,
                           int threads) { return RollOut(loaded, text, threads); });
}

}  // namespace possibility::python
