#include "experiments/program/view_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "actions/plan/plan.h"
#include "experiments/command/loaded_plan.h"
#include "experiments/recording/film.h"
#include "experiments/recording/page_recording.h"
#include "experiments/support/count_line.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "experiments/viewer/jump_page.h"
#include "experiments/viewer/viewer_input.h"
#include "experiments/viewer/viewer_page.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJumpFormat = "possibility-solution/1";

struct ViewOptions {
  std::vector<std::string> files;
  std::string robot;
  std::string out;
  std::string record;
  std::string rate = "25";
  std::string size = "1280x720";
  std::string link;
};

struct Page {
  std::filesystem::path file;  ///< where it goes by default
  std::string html;
};

LoadedPlan PlanToShow(const std::string& file) {
  LoadedPlan loaded = LoadPlan(file);
  RequireFit(loaded);
  if (!loaded.IsCurrent()) {
    PrintError("warning: {}: robot or scenario changed since this plan was made\n",
               loaded.file.string());
  }
  return loaded;
}

PageSubject SubjectOf(const LoadedPlan& loaded) {
  return {loaded.plan, loaded.robot, loaded.scenario};
}

Page PlanPage(const ViewOptions& options) {
  if (!options.robot.empty()) {
    throw InputError(fmt::format("--robot: {} is a plan, which names its robot, expected a jump",
                                 options.files[0]));
  }
  const LoadedPlan loaded = PlanToShow(options.files[0]);
  if (options.files.size() == 1) {
    return {fs::path(loaded.file).replace_extension(".html"),
            ViewerPage(loaded.plan, loaded.robot, loaded.scenario)};
  }
  const LoadedPlan other = PlanToShow(options.files[1]);
  return {loaded.file.parent_path() / "comparison.html",
          ComparisonPage(SubjectOf(loaded), SubjectOf(other))};
}

Page PageOfJump(const ViewOptions& options) {
  const LoadedJump loaded = LoadJump(options.files[0], options.robot);
  if (!loaded.is_current) {
    PrintError("warning: {}: robot or settings changed since this jump was solved\n",
               loaded.file.string());
  }
  return {fs::path(loaded.file).replace_extension(".html"), JumpPage(loaded)};
}

/// Whether a file is a plan or, if not, a jump.
bool IsPlan(const std::string& file) {
  std::error_code ignored;  // LoadPlan reports paths that cannot be read
  if (fs::is_directory(file, ignored)) return true;
  const std::string format = FormatOf(file);
  if (format == kJumpFormat) return false;
  if (format == actions::kPlanFormat || format == actions::kPackedPlanFormat) return true;
  throw InputError(
      fmt::format("{}: neither a plan nor a jump, expected \"format\": \"{}\", \"{}\" or \"{}\"",
                  file, actions::kPlanFormat, actions::kPackedPlanFormat, kJumpFormat));
}

Page MakePage(const ViewOptions& options) {
  if (options.files.size() > 2) {
    throw InputError(fmt::format("{}: a third file, expected one or two", options.files[2]));
  }
  for (const std::string& file : options.files) {
    if (IsPlan(file)) continue;
    if (options.files.size() == 1) return PageOfJump(options);
    throw InputError(fmt::format("{}: is a jump, expected two plans to compare", file));
  }
  return PlanPage(options);
}

PictureSize ParseSize(const std::string& text) {
  const std::size_t cross = text.find('x');
  const auto number = [&](const std::string& part) {
    const auto pixels = static_cast<int>(ParseInteger("--size", part, 160, 7680));
    if (pixels % 2 == 0) return pixels;
    throw InputError(fmt::format("--size: expected even numbers, got '{}'", text));
  };
  if (cross == std::string::npos) {
    throw InputError(fmt::format("--size: expected WIDTHxHEIGHT, got '{}'", text));
  }
  return {number(text.substr(0, cross)), number(text.substr(cross + 1))};
}

RecordingSettings SettingsOf(const ViewOptions& options) {
  RecordingSettings settings;
  settings.rate = static_cast<int>(ParseInteger("--fps", options.rate, 1, 120));
  settings.size = ParseSize(options.size);
  settings.link = options.link.starts_with('#') ? options.link.substr(1) : options.link;
  ParseTimes(settings.link);
  return settings;
}

ExitCode Record(const ViewOptions& options) {
  const RecordingSettings settings = SettingsOf(options);
  const Page page = MakePage(options);
  const std::unique_ptr<Film> film = MakeFilm(options.record, settings.rate);
  const CountLine line("frame");
  RecordPage(page.html, settings, film.get(), [&](int done, int all) { line.Show(done, all); });
  if (!options.out.empty()) WriteOutput(options.out, page.html);
  PrintOut("{}\n", options.record);
  return kDone;
}

ExitCode RunView(const ViewOptions& options) {
  if (!options.record.empty()) return Record(options);
  const Page page = MakePage(options);
  const fs::path out = options.out.empty() ? page.file : fs::path(options.out);
  WriteOutput(out, page.html);
  PrintOut("{}\n", out.string());
  return kDone;
}

}  // namespace

Command AddViewCommand(CLI::App& program) {
  CommandOptions command(program, "view",
                         "Writes a page that plays a plan, two plans or a jump in a browser.");
  auto options = std::make_shared<ViewOptions>();
  command.AddRequired(
      "FILE", &options->files,
      "plan.json, plan.zip or their folder, or two of them; or a jump of a library");
  command.AddOptional("--robot", &options->robot,
                      "Robot YAML of a jump (default: the one beside its folder jumps)");
  command.AddOptional("--out", &options->out,
                      "The page (default: beside FILE, ending in .html; of two comparison.html)");
  command.AddOptional("--record", &options->record,
                      "Films the page instead: a folder for PNGs, or FILE.webm; needs Chromium");
  command.AddOptional("--fps", &options->rate, "Pictures per second of the film");
  command.AddOptional("--size", &options->size, "Of the film, WIDTHxHEIGHT");
  command.AddOptional("--link", &options->link,
                      "What the film shows, as in the page's address: t=2&until=5&view=side");
  return {command, [options] { return RunView(*options); }};
}

}  // namespace possibility::experiments
