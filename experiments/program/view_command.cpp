#include "experiments/program/view_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

#include "actions/plan/plan.h"
#include "experiments/command/loaded_plan.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "experiments/viewer/jump_page.h"
#include "experiments/viewer/viewer_input.h"
#include "experiments/viewer/viewer_page.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr const char* kJumpFormat = "possibility-solution/1";

struct ViewOptions {
  std::string file;
  std::string robot;
  std::string out;
};

struct Page {
  std::filesystem::path shown;  ///< the plan or jump
  std::string html;
};

Page PlanPage(const ViewOptions& options) {
  if (!options.robot.empty()) {
    throw InputError(
        fmt::format("--robot: {} is a plan, which names its robot, expected a jump", options.file));
  }
  const LoadedPlan loaded = LoadPlan(options.file);
  RequireFit(loaded);
  if (!loaded.IsCurrent()) {
    PrintError("warning: {}: robot or scenario changed since this plan was made\n",
               loaded.file.string());
  }
  return {loaded.file, ViewerPage(loaded.plan, loaded.robot, loaded.scenario)};
}

Page PageOfJump(const ViewOptions& options) {
  const LoadedJump loaded = LoadJump(options.file, options.robot);
  if (!loaded.is_current) {
    PrintError("warning: {}: robot or settings changed since this jump was solved\n",
               loaded.file.string());
  }
  return {loaded.file, JumpPage(loaded)};
}

Page MakePage(const ViewOptions& options) {
  std::error_code ignored;  // LoadPlan reports paths that cannot be read
  if (std::filesystem::is_directory(options.file, ignored)) return PlanPage(options);
  const std::string format = FormatOf(options.file);
  if (format == kJumpFormat) return PageOfJump(options);
  if (format == actions::kPlanFormat) return PlanPage(options);
  throw InputError(
      fmt::format("{}: neither a plan nor a jump, expected \"format\": \"{}\" or \"{}\"",
                  options.file, actions::kPlanFormat, kJumpFormat));
}

ExitCode RunView(const ViewOptions& options) {
  const Page page = MakePage(options);
  std::filesystem::path out = options.out;
  if (out.empty()) out = std::filesystem::path(page.shown).replace_extension(".html");
  WriteOutput(out, page.html);
  PrintOut("{}\n", out.string());
  return kDone;
}

}  // namespace

Command AddViewCommand(CLI::App& program) {
  CommandOptions command(program, "view",
                         "Writes a page that plays a plan or a jump in a browser.");
  auto options = std::make_shared<ViewOptions>();
  command.AddRequired("FILE", &options->file, "plan.json or its folder, or a jump of a library");
  command.AddOptional("--robot", &options->robot,
                      "Robot YAML of a jump (default: the one beside its folder jumps)");
  command.AddOptional("--out", &options->out, "The page (default: beside FILE, ending in .html)");
  return {command, [options] { return RunView(*options); }};
}

}  // namespace possibility::experiments
