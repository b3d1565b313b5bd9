#include "experiments/program/verify_command.h"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "actions/verify/verification_report.h"
#include "actions/verify/verifier.h"
#include "experiments/command/loaded_plan.h"
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
  CommandOptions command(program, "verify", "Checks a plan from first principles.");
  auto options = std::make_shared<VerifyOptions>();
  command.AddRequired("PLAN", &options->plan, "plan.json, plan.zip or their folder");
  command.AddOptional("--robot", &options->robot, "Robot YAML (default: the scenario's)");
  command.AddOptional("--scenario", &options->scenario, "Scenario YAML (default: the plan's)");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunVerify(*options); }};
}

}  // namespace possibility::experiments
