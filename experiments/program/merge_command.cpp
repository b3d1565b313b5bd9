#include "experiments/program/merge_command.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/command/report_output.h"
#include "experiments/support/output_file.h"
#include "experiments/trials/merge.h"
#include "experiments/trials/results_file.h"
#include "experiments/trials/sweep_report.h"
#include "experiments/trials/table_report.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out;
  bool json = false;
};

/// The union of the folders' files of that name and the output folder's own, written to the output
/// folder.
std::vector<TrialRecord> MergeFiles(const MergeOptions& options, const std::string& name) {
  const fs::path target = fs::path(options.out) / name;
  std::vector<std::pair<fs::path, std::vector<TrialRecord>>> parts;
  for (const std::string& folder : options.folders) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file)) parts.emplace_back(file, ReadResults(file));
  }
  if (parts.empty()) return {};
  ResultsFile results(target);
  parts.emplace_back(target, results.records());
  for (const TrialRecord& record : MergeRecords(parts)) {
    if (!results.Contains(record.key)) results.Append(record);
  }
  results.Sort(TableRowOrder());
  return results.records();
}

void CopyPictures(const MergeOptions& options) {
  const fs::path target = fs::path(options.out) / "plans";
  for (const std::string& folder : options.folders) {
    const fs::path source = fs::path(folder) / "plans";
    if (!fs::is_directory(source) || fs::equivalent(source, target)) continue;
    for (const auto& entry : fs::directory_iterator(source)) {
      if (entry.path().extension() != ".svg") continue;
      fs::copy_file(entry.path(), target / entry.path().filename(),
                    fs::copy_options::overwrite_existing);
    }
  }
}

ExitCode RunMerge(const MergeOptions& options) {
  for (const std::string& folder : options.folders) {
    if (fs::is_regular_file(fs::path(folder) / "results.jsonl") ||
        fs::is_regular_file(fs::path(folder) / "twins.jsonl")) {
      continue;
    }
    throw InputError(
        fmt::format("{}: has no results, expected a folder of table or sweep", folder));
  }
  PrepareOutputFolder("--out", fs::path(options.out) / "plans");
  const std::vector<TrialRecord> trials = MergeFiles(options, "results.jsonl");
  const std::vector<TrialRecord> twins = MergeFiles(options, "twins.jsonl");
  if (trials.empty() && twins.empty()) {
    throw InputError(fmt::format("{}: no folder has a finished trial", options.folders.front()));
  }
  CopyPictures(options);
  if (!trials.empty() && !trials.front().parameter.empty()) {
    PutOutReport(SweepReport{trials}, options.out, options.json);
  } else {
    PutOutReport(TableReport{trials, twins}, options.out, options.json);
  }
  return kDone;
}

}  // namespace

Command AddMergeCommand(CLI::App& program) {
  CommandOptions command(program, "merge",
                         "Puts the parts of a table or sweep (--shard) together.");
  auto options = std::make_shared<MergeOptions>();
  command.AddRequired("DIR", &options->folders, "Folders of the parts");
  command.AddRequired("--out", &options->out, "Folder for the whole");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunMerge(*options); }};
}

}  // namespace possibility::experiments
