#include "experiments/program/regress_command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/stopwatch.h"
#ifdef POSSIBILITY_WITH_NLOPT
#include "experiments/peers/slsqp_solver.h"
#endif
#include "experiments/regression/regression_comparison.h"
#include "experiments/regression/regression_pages.h"
#include "experiments/regression/regression_run.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/input/nearest_name.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

constexpr int kMaxIntervals = 10000;
constexpr double kSlsqpSeconds =
    60;  // a mesh; its time grows with the third power of the variables

struct RegressOptions {
  std::string out;
  std::string plots;
  std::string against;
  std::string problems;
  std::string robot = "models/drchubo1/drchubo1.yaml";
  std::string scheme;
  std::string intervals;
  std::string solver = "ipopt";
  std::string linear_solver = "ldlt";
  std::string hessian = "exact";
  bool work_precision = false;
  bool direct = false;
  bool json = false;
};

template <typename Value>
struct Choice {
  std::string name;
  Value value;
};

template <typename Value>
Value Choose(const std::string& option, const std::string& text,
             const std::vector<Choice<Value>>& choices) {
  std::vector<std::string> names;
  for (const auto& [name, value] : choices) {
    if (name == text) return value;
    names.push_back(name);
  }
  throw InputError(fmt::format("{}: '{}' is not valid, expected {}{}", option, text,
                               fmt::join(names, ", "), models::DidYouMean(text, names)));
}

const collocation::NonlinearSolver* Slsqp() {
#ifdef POSSIBILITY_WITH_NLOPT
  return &SlsqpSolver();
#else
  throw InputError(
      "--solver: 'slsqp' needs NLopt (libnlopt-dev), which was missing when this was built");
#endif
}

const collocation::NonlinearSolver* SolverOf(const std::string& name) {
  using Solver = const collocation::NonlinearSolver* (*)();
  const Solver ipopt = [] { return &collocation::IpoptSolver(); };
  return Choose<Solver>("--solver", name, {{"ipopt", ipopt}, {"slsqp", &Slsqp}})();
}

RegressionOptions RunOptions(const RegressOptions& options) {
  using namespace collocation;
  RegressionOptions run;
  if (!options.scheme.empty()) {
    run.scheme = Choose<TranscriptionScheme (*)()>(
        "--scheme", options.scheme,
        {{"trapezoidal", &Trapezoidal},
         {"hermite_simpson", &HermiteSimpson},
         {"hermite_simpson_compressed", &CompressedHermiteSimpson}})();
  }
  if (!options.intervals.empty()) {
    run.intervals =
        static_cast<int>(ParseInteger("--intervals", options.intervals, 1, kMaxIntervals));
  }
  run.solver = SolverOf(options.solver);
  if (run.solver != &IpoptSolver()) run.time_limit = kSlsqpSeconds;
  run.second_order_check = true;
  run.work_precision = options.work_precision;
  run.coarse_first = !options.direct;
  run.linear_solver =
      Choose<LinearSolver>("--linear-solver", options.linear_solver,
                           {{"ldlt", LinearSolver::kSparseLdlt}, {"mumps", LinearSolver::kMumps}});
  run.hessian = Choose<HessianMode>(
      "--hessian", options.hessian,
      {{"exact", HessianMode::kExact}, {"limited_memory", HessianMode::kLimitedMemory}});
  return run;
}

const RegressionProblem* Find(const std::vector<RegressionProblem>& problems,
                              const std::string& name) {
  const auto found = std::find_if(problems.begin(), problems.end(),
                                  [&](const RegressionProblem& p) { return p.name == name; });
  return found == problems.end() ? nullptr : &*found;
}

/// The problems to run, in the suite's order. The robot is loaded only for problems that need it.
std::vector<RegressionProblem> Select(const std::string& list, const std::string& robot) {
  std::vector<RegressionProblem> all = RegressionProblems();
  const std::vector<std::string> wanted =
      list.empty() ? std::vector<std::string>{} : ParseNames("--problem", list);
  const auto is_known = [&](const std::string& name) { return Find(all, name) != nullptr; };
  if (wanted.empty() || !std::all_of(wanted.begin(), wanted.end(), is_known)) {
    all = RegressionProblems(models::LoadRobotModel(robot));
  }
  if (wanted.empty()) return all;
  for (const std::string& name : wanted) {
    if (is_known(name)) continue;
    std::vector<std::string> known;
    for (const RegressionProblem& problem : all) known.push_back(problem.name);
    throw InputError(fmt::format("--problem: there is no problem '{}', expected some of {}{}", name,
                                 fmt::join(known, ", "), models::DidYouMean(name, known)));
  }
  std::erase_if(all, [&](const RegressionProblem& problem) {
    return std::find(wanted.begin(), wanted.end(), problem.name) == wanted.end();
  });
  return all;
}

/// Checks the output file before the work rather than after it.
void CheckOutput(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(
        fmt::format("--out: '{}' is a folder, expected a file to write", file.string()));
  }
  const std::filesystem::path folder = file.parent_path();
  PrepareOutputFolder("--out", folder.empty() ? "." : folder);
}

/// Rewrites "problem 3 of 17: kirk, about 12 s left" on stderr, if it is a terminal.
class RegressionProgress {
 public:
  explicit RegressionProgress(int count)
      : count_(count), is_terminal_(::isatty(STDERR_FILENO) == 1) {}
  ~RegressionProgress() {
    if (is_terminal_) PrintError("\r\x1b[K");
  }
  RegressionProgress(const RegressionProgress&) = delete;
  RegressionProgress& operator=(const RegressionProgress&) = delete;

  void Show(int done, const std::string& name) const {
    if (!is_terminal_) return;
    const double elapsed = stopwatch_.Seconds();
    const std::string left =
        done == 0 ? "" : fmt::format(", about {:.0f} s left", elapsed / done * (count_ - done));
    PrintError("\r\x1b[Kproblem {} of {}: {}{}", done + 1, count_, name, left);
  }

 private:
  int count_;
  bool is_terminal_;
  Stopwatch stopwatch_;
};

RegressionReport RunWithProgress(const std::vector<RegressionProblem>& problems,
                                 const RegressionOptions& options) {
  const RegressionProgress progress(static_cast<int>(problems.size()));
  return RunRegression(problems, options, [&progress](int done, const std::string& name) {
    progress.Show(done, name);
  });
}

void Print(const RegressionReport& report, const std::optional<RegressionComparison>& comparison,
           bool as_json) {
  if (!as_json) {
    PrintOut("{}{}", report.Text(), comparison ? comparison->Text() : "");
    return;
  }
  nlohmann::ordered_json json = report.Json();
  if (comparison) json["comparison"] = comparison->Json();
  PrintOut("{}\n", models::JsonText(json));
}

ExitCode Verdict(const RegressionReport& report,
                 const std::optional<RegressionComparison>& comparison) {
  const std::vector<std::string> failures = report.Failures();
  if (!failures.empty()) {
    PrintError("regress: {} of {} problems not within tolerance: {}\n", failures.size(),
               report.problems.size(), fmt::join(failures, ", "));
  }
  const bool worse = comparison && comparison->failed();
  if (worse) PrintError("regress: worse than the old run\n");
  return failures.empty() && !worse ? kDone : kVerificationFailed;
}

ExitCode RunRegress(const RegressOptions& options) {
  if (options.work_precision && options.plots.empty() && options.out.empty() && !options.json) {
    throw InputError(
        "--work-precision: expected --plots, --out or --json beside it, for its results");
  }
  const RegressionOptions run_options = RunOptions(options);
  const std::vector<RegressionProblem> problems = Select(options.problems, options.robot);
  std::optional<nlohmann::json> old_run;
  if (!options.against.empty()) old_run = ReadRegressionFile(options.against);
  if (!options.out.empty()) CheckOutput(options.out);
  if (!options.plots.empty()) PrepareOutputFolder("--plots", options.plots);

  const RegressionReport report = RunWithProgress(problems, run_options);
  if (!options.out.empty()) {
    WriteOutput(options.out, models::JsonText(report.Json(), 2) + "\n");
  }
  if (!options.plots.empty()) WriteRegressionPages(report, options.plots);
  std::optional<RegressionComparison> comparison;
  if (old_run) {
    comparison = CompareRegressions(*old_run, report.Json(), options.problems.empty());
  }
  Print(report, comparison, options.json);
  return Verdict(report, comparison);
}

}  // namespace

Command AddRegressCommand(CLI::App& program) {
  CommandOptions command(
      program, "regress",
      "Solves optimal-control problems whose answers are known, to see what changed.");
  auto options = std::make_shared<RegressOptions>();
  command.AddOptional("--out", &options->out, "File for the results, JSON");
  command.AddOptional("--against", &options->against,
                      "File of an earlier run: what got worse since?");
  command.AddOptional("--plots", &options->plots,
                      "Folder for pictures of the solutions, SVG, and a page with all of them");
  command.AddOptional("--problem", &options->problems, "Names and commas (default: all)");
  command.AddOptional("--robot", &options->robot, "For the robot's problems");
  command.AddOptional(
      "--scheme", &options->scheme,
      "trapezoidal, hermite_simpson or hermite_simpson_compressed (default: each problem's own)");
  command.AddOptional("--intervals", &options->intervals,
                      "Per phase to begin with, 1 to 10000 (default: each problem's own)");
  command.AddOptional("--solver", &options->solver, "ipopt, or slsqp: dense, for small problems");
  command.AddOptional("--linear-solver", &options->linear_solver, "ldlt or mumps");
  command.AddOptional("--hessian", &options->hessian, "exact or limited_memory");
  command.AddFlag("--direct", &options->direct, "Solve no large problem on coarser meshes first");
  command.AddFlag("--work-precision", &options->work_precision,
                  "Also each scheme's error and time on meshes from coarse to fine");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunRegress(*options); }};
}

}  // namespace possibility::experiments
