#include "experiments/program/library_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "actions/conditions/locomotion_model.h"
#include "actions/crossing/step_over_motion.h"
#include "actions/gait/pace_library.h"
#include "actions/gait/pace_search.h"
#include "actions/jump/jump_sweep.h"
#include "actions/transition/transition_motion.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/motion_error.h"
#include "experiments/report/jump_reach_plot.h"
#include "experiments/support/count_line.h"
#include "experiments/support/hardware_threads.h"
#include "experiments/support/option_values.h"
#include "experiments/support/output_file.h"
#include "experiments/support/standard_streams.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"
#include "models/robot/robot_yaml.h"

namespace possibility::experiments {
namespace {

struct LibraryOptions {
  std::string robot;
  std::string out;
  std::string threads;
  std::string heights = "-0.2,-0.1,0,0.1,0.2";
  bool paces = false;
  bool json = false;
};

/// "0.1,0.2": numbers in m, ascending.
std::vector<double> ParseHeights(const std::string& text) {
  std::vector<double> heights;
  for (const std::string& word : ParseNames("--heights", text)) {
    char* end = nullptr;
    const double height = std::strtod(word.c_str(), &end);
    const bool ascends = heights.empty() || height > heights.back();
    if (*end != '\0' || !(std::abs(height) <= 10) || !ascends) {
      throw InputError(
          fmt::format("--heights: '{}': expected ascending numbers of m, at most 10", text));
    }
    heights.push_back(height);
  }
  return heights;
}

/// The jumps of one name.
struct Swept {
  std::string name;
  std::vector<actions::JumpSweepEntry> entries;
  actions::JumpReach reach;
};

void PrintText(const std::vector<Swept>& jumps) {
  for (const auto& [name, entries, reach] : jumps) {
    for (const actions::JumpSweepEntry& entry : entries) {
      PrintOut("{} {:.2f} m by {:+.3f} m  {}  {:.2f} s{}{}\n", name, entry.task.distance,
               entry.task.height, entry.is_possible ? "yes" : "no ", entry.effort.total,
               entry.was_known ? "  (known)" : "", entry.reason.empty() ? "" : "  " + entry.reason);
    }
    for (const actions::JumpReach::Row& row : reach.rows) {
      if (row.farthest < row.shortest) {
        PrintOut("{}, height {:+.3f} m: none\n", name, row.height);
      } else {
        PrintOut("{}, height {:+.3f} m: {:.2f} to {:.2f} m\n", name, row.height, row.shortest,
                 row.farthest);
      }
    }
  }
}

void PrintJson(const std::vector<Swept>& jumps) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  nlohmann::ordered_json table = nlohmann::ordered_json::array();
  for (const auto& [name, entries, reach] : jumps) {
    for (const actions::JumpSweepEntry& entry : entries) {
      rows.push_back({{"jump", name},
                      {"distance", entry.task.distance},
                      {"height", entry.task.height},
                      {"possible", entry.is_possible},
                      {"known", entry.was_known},
                      {"seconds", entry.effort.total},
                      {"reason", entry.reason}});
    }
    for (const actions::JumpReach::Row& row : reach.rows) {
      table.push_back({row.height, row.shortest, row.farthest, name});
    }
  }
  PrintOut("{}\n", models::JsonText(nlohmann::ordered_json{{"jumps", rows}, {"reach", table}}));
}

void SaveTransitions(const models::RobotModel& robot, const std::string& folder) {
  for (const models::Transition& transition : robot.transitions) {
    const auto from = actions::SolveNominalStance(robot, robot.GaitNamed(transition.from));
    const auto to = actions::SolveNominalStance(robot, robot.GaitNamed(transition.to));
    actions::TransitionMotion(robot, from, to, folder, {}).Save();
  }
}

void SavePaces(const models::RobotModel& robot, const std::string& folder) {
  const actions::PaceLibrary library(robot, folder);
  for (const models::Gait& gait : robot.gaits) {
    const actions::NominalStance stance = actions::SolveNominalStance(robot, gait);
    const CountLine progress("paces of " + gait.name);
    actions::PaceSearchSettings settings;
    settings.progress = [&](double, int done, int all) { progress.Show(done + 1, all); };
    const std::vector<actions::Pace> paces = actions::OptimisedPaces(robot, stance, settings);
    library.Save(gait, paces);
    if (paces.empty()) {
      PrintError("{}: no pace fits, the gait is quasi-static\n", gait.name);
    } else {
      PrintError("{}: {:.2f} m/s\n", gait.name, paces.front().speed());
    }
  }
}

/// Of the robot's first gait on two feet, if it has one and can step over anything.
void SaveStepOver(const models::RobotModel& robot, const std::string& folder) {
  const auto gait = std::find_if(robot.gaits.begin(), robot.gaits.end(),
                                 [](const models::Gait& g) { return g.limbs.size() == 2; });
  if (gait == robot.gaits.end()) return;
  const actions::LocomotionModel model =
      actions::BuildLocomotionModel(robot, {gait->name}, {}, folder);
  const actions::StepOverProblem problem(robot, *model.gaits.front());
  try {
    actions::StepOverMotion(problem, folder, {}).Save();
  } catch (const actions::MotionError& error) {
    PrintError("no step over: {}\n", error.what());
  }
}

/// @throws InputError if the robot cannot be reduced to one of its jumps, before any is solved.
void RequireJumps(const models::RobotModel& robot) {
  for (const models::Jump& jump : robot.jumps) {
    const auto launch = actions::SolveNominalStance(robot, robot.GaitNamed(jump.from));
    const auto landing = actions::SolveNominalStance(robot, robot.GaitNamed(jump.to));
    const actions::JumpSolver solver(robot, launch, landing);
  }
}

/// Solves a jump's distances and saves them with their table and picture.
Swept SolveJumps(const models::RobotModel& robot, const models::Jump& jump,
                 const std::string& folder, actions::JumpSweep sweep) {
  const auto launch = actions::SolveNominalStance(robot, robot.GaitNamed(jump.from));
  const auto landing = actions::SolveNominalStance(robot, robot.GaitNamed(jump.to));
  const actions::JumpSolver solver(robot, launch, landing);
  actions::JumpLibrary library(solver, folder);
  const CountLine progress(jump.name);
  sweep.progress = [&progress](int done, int all) { progress.Show(done, all); };
  Swept swept{jump.name, actions::SweepJumps(sweep, &library), {}};
  swept.reach = actions::ReachOf(swept.entries);
  library.SaveReach(swept.reach);
  WriteOutput(library.folder() / "reach.svg", JumpReachPicture(swept.entries));
  return swept;
}

ExitCode RunLibrary(const LibraryOptions& options) {
  const models::RobotModel robot = models::LoadRobotModel(options.robot);
  if (!options.paces) RequireJumps(robot);
  PrepareOutputFolder("--out", options.out);
  SavePaces(robot, options.out);
  if (options.paces) return kDone;
  actions::JumpSweep sweep;
  sweep.heights = ParseHeights(options.heights);
  sweep.threads =
      options.threads.empty()
          ? HardwareThreads()
          : static_cast<int>(ParseInteger("--threads", options.threads, 1, kMaxThreads));
  std::vector<Swept> jumps;
  for (const models::Jump& jump : robot.jumps) {
    jumps.push_back(SolveJumps(robot, jump, options.out, sweep));
  }
  SaveTransitions(robot, options.out);
  SaveStepOver(robot, options.out);
  if (options.json) {
    PrintJson(jumps);
  } else {
    PrintText(jumps);
  }
  return kDone;
}

}  // namespace

Command AddLibraryCommand(CLI::App& program) {
  CommandOptions command(program, "library",
                         "Solves a robot's jumps, transitions and step over, and optimises its "
                         "gaits, for later plans.");
  auto options = std::make_shared<LibraryOptions>();
  command.AddRequired("ROBOT", &options->robot, "Robot YAML");
  command.AddRequired("--out", &options->out, "Folder of the library");
  command.AddOptional("--heights", &options->heights, "Heights of landing grounds, m");
  command.AddOptional("--threads", &options->threads, "Solves at a time; default: all cores");
  command.AddFlag("--paces", &options->paces, "Only the paces of its gaits");
  command.AddFlag("--json", &options->json, "Print one JSON object");
  return {command, [options] { return RunLibrary(*options); }};
}

}  // namespace possibility::experiments
