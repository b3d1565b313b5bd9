#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "experiments/commands.h"
#include "experiments/loaded_plan.h"
#include "experiments/output_file.h"
#include "experiments/viewer_page.h"

namespace possibility::experiments {
namespace {

struct ViewOptions {
  std::string plan;
  std::string out;
};

ExitCode RunView(const ViewOptions& options) {
  const LoadedPlan loaded = LoadPlan(options.plan);
  RequireFit(loaded);
  if (!loaded.IsCurrent()) {
    fmt::print(stderr, "warning: {}: robot or scenario changed since this plan was made\n",
               loaded.file.string());
  }
  std::filesystem::path page = options.out;
  if (page.empty()) page = std::filesystem::path(loaded.file).replace_extension(".html");
  WriteOutput(page, ViewerPage(loaded.plan, loaded.robot, loaded.scenario));
  fmt::print("{}\n", page.string());
  return kDone;
}

}  // namespace

Command AddViewCommand(CLI::App& program) {
  CLI::App* app = program.add_subcommand("view", "Writes a page that plays a plan in a browser.");
  auto options = std::make_shared<ViewOptions>();
  app->add_option("PLAN", options->plan, "plan.json or its folder")->required();
  app->add_option("--out", options->out, "The page (default: plan.html beside the plan)");
  return {app, [options] { return RunView(*options); }};
}

}  // namespace possibility::experiments
