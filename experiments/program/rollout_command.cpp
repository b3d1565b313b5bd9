#include "experiments/program/rollout_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "actions/rollout/perturbed_rollouts.h"
#include "actions/verify/verifier.h"
#include "experiments/command/loaded_plan.h"
#include "experiments/command/perturbation_option.h"
#include "experiments/report/rollout_table.h"
#include "experiments/support/count_line.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using actions::PerturbedRollout;
using actions::RolloutDrift;
using actions::StretchRollout;

struct RolloutOptions {
  std::string plan;
  std::string robot;
  std::string scenario;
  std::vector<std::string> perturbations;
  bool json = false;
};

void PrintTable(const actions::Plan& plan, const std::vector<NamedPerturbation>& cases,
                const std::vector<PerturbedRollout>& rollouts) {
  std::vector<std::string> names;
  for (const NamedPerturbation& named : cases) names.push_back(named.text);
  PrintOut("{}", RolloutTable(plan, names, rollouts).Markdown());
}

nlohmann::ordered_json ToJson(const StretchRollout& stretch) {
  const RolloutDrift& drift = stretch.drift;
  nlohmann::ordered_json json = {{"segment", stretch.segment},
                                 {"last_segment", stretch.last_segment},
                                 {"start_s", drift.start},
                                 {"end_s", drift.end},
                                 {"survives", drift.survives()},
                                 {"fell_at_s", nullptr},
                                 {"worst_position_m", drift.worst_position},
                                 {"worst_orientation_rad", drift.worst_orientation},
                                 {"worst_joint", drift.worst_joint},
                                 {"end_position_m", drift.end_position},
                                 {"end_orientation_rad", drift.end_orientation},
                                 {"torque_used", drift.torque_used},
                                 {"slide_m", drift.slide},
                                 {"failure", drift.failure}};
  if (drift.fell_at) json["fell_at_s"] = *drift.fell_at;
  return json;
}

void PrintJson(const LoadedPlan& loaded, const std::vector<NamedPerturbation>& cases,
               const std::vector<PerturbedRollout>& rollouts) {
  nlohmann::ordered_json json = {{"plan", loaded.file.string()},
                                 {"cases", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    nlohmann::ordered_json entry = {{"perturbation", nlohmann::ordered_json::object()},
                                    {"survives", rollouts[i].survives()},
                                    {"stretches", nlohmann::ordered_json::array()}};
    for (const auto& [name, value] : cases[i].values) entry["perturbation"][name] = value;
    for (const StretchRollout& stretch : rollouts[i].stretches) {
      entry["stretches"].push_back(ToJson(stretch));
    }
    json["cases"].push_back(entry);
  }
  PrintOut("{}\n", models::JsonText(json));
}

/// A plan that breaks other rules has no motion worth simulating.
/// @throws InputError with the first violation.
void RequireRules(const LoadedPlan& loaded) {
  actions::VerifierSettings settings;
  settings.threads = HardwareThreads();
  settings.simulates = false;
  const actions::VerificationReport report =
      actions::Verify(loaded.plan, loaded.robot, loaded.scenario, settings);
  if (report.accepted()) return;
  const actions::Violation& violation = report.violations.front();
  throw InputError(
      fmt::format("{}: the plan is not simulated because it is rejected: {}, {} "
                  "(see possibility verify)",
                  loaded.file.string(), ToString(violation.kind), violation.quantity));
}

ExitCode RunRollout(const RolloutOptions& options) {
  std::vector<NamedPerturbation> cases;
  for (const std::string& text : options.perturbations) cases.push_back(ParsePerturbation(text));
  if (cases.empty()) cases = UsualPerturbations();
  const LoadedPlan loaded = LoadPlanToVerify(options.plan, {options.robot, options.scenario});
  RequireMotion(loaded);
  RequireRules(loaded);
  std::vector<actions::Perturbation> perturbations;
  perturbations.reserve(cases.size());
  for (const NamedPerturbation& named : cases) perturbations.push_back(named.perturbation);
  const CountLine progress("simulation");
  actions::PerturbedRolloutsSettings settings;
  settings.threads = HardwareThreads();
  settings.progress = [&progress](int done, int all) { progress.Show(done, all); };
  const std::vector<PerturbedRollout> rollouts = actions::RollOutPerturbed(
      loaded.plan, loaded.robot, loaded.scenario, perturbations, settings);
  options.json ? PrintJson(loaded, cases, rollouts) : PrintTable(loaded.plan, cases, rollouts);
  const bool all_survive =
      std::all_of(rollouts.begin(), rollouts.end(),
                  [](const PerturbedRollout& rollout) { return rollout.survives(); });
  return all_survive ? kDone : kVerificationFailed;
}

}  // namespace

Command AddRolloutCommand(CLI::App& program) {
  CommandOptions command(program, "rollout",
                         "Simulates a plan on a perturbed robot and ground, and says who falls.");
  auto options = std::make_shared<RolloutOptions>();
  command.AddRequired("PLAN", &options->plan, "plan.json, plan.zip or their folder");
  command.AddOptional("--perturb", &options->perturbations,
                      "One case, such as mass=1.05,slope_deg=1; repeatable (default: a usual set)");
  command.AddOptional("--robot", &options->robot, "Robot YAML (default: the scenario's)");
  command.AddOptional("--scenario", &options->scenario, "Scenario YAML (default: the plan's)");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunRollout(*options); }};
}

}  // namespace possibility::experiments
