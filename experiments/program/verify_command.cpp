#include "experiments/program/verify_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "experiments/program/loaded_plan.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/standard_streams.h"

namespace possibility::experiments {
namespace {

struct VerifyOptions {
  std::string plan;
  std::string robot;
  std::string scenario;
  bool json = false;
};

ExitCode RunVerify(const VerifyOptions& options) {
  const LoadedPlan loaded = LoadPlanToVerify(options.plan, {options.robot, options.scenario});
  RequireMotion(loaded);
  actions::VerifierSettings settings;
  settings.threads = HardwareThreads();
  const actions::VerificationReport report =
      actions::Verify(loaded.plan, loaded.robot, loaded.scenario, settings);
  if (options.json) {
    PrintOut("{}\n", actions::FormatJson(report));
  } else {
    PrintOut("{}", actions::FormatText(report));
  }
  return report.accepted() ? kDone : kVerificationFailed;
}

}  // namespace

Command AddVerifyCommand(CLI::App& program) {
  CLI::App* app = program.add_subcommand("verify", "Checks a plan from first principles.");
  auto options = std::make_shared<VerifyOptions>();
  app->add_option("PLAN", options->plan, "plan.json or its folder")->required();
  app->add_option("--robot", options->robot, "Robot YAML (default: the scenario's)");
  app->add_option("--scenario", options->scenario, "Scenario YAML (default: the plan's)");
  app->add_flag("--json", options->json, "Print one JSON object");
  return {app, [options] { return RunVerify(*options); }};
}

}  // namespace possibility::experiments
