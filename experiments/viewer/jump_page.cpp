#include "experiments/viewer/jump_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <system_error>
#include <vector>

#include "actions/jump/jump_library.h"
#include "actions/plan/contact_name.h"
#include "actions/wholebody/nominal_stance.h"
#include "collocation/study/stored_solution.h"
#include "collocation/study/stored_solution_reader.h"
#include "dynamics/tree/tree_kinematics.h"
#include "experiments/viewer/viewer_momentum.h"
#include "experiments/viewer/viewer_page.h"
#include "models/input/input_error.h"
#include "models/robot/mimic_joints.h"
#include "models/robot/robot_yaml.h"
#include "models/world/scenario.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

constexpr double kFloorBehind = 0.8;  // m, of floor beyond the stances
constexpr double kFloorWidth = 1.6;   // m
constexpr double kFloorDepth = 0.3;   // m

/// LIBRARY/jumps/IDENTITY/jump_10_0.json: the YAML in LIBRARY.
fs::path RobotBeside(const fs::path& file) {
  std::vector<fs::path> found;
  const fs::path jumps = fs::absolute(file).lexically_normal().parent_path().parent_path();
  std::error_code error;
  if (jumps.filename() == "jumps") {
    for (const auto& entry : fs::directory_iterator(jumps.parent_path(), error)) {
      if (entry.path().extension() == ".yaml") found.push_back(entry.path());
    }
  }
  if (found.size() == 1) return found.front();
  throw InputError(fmt::format(
      "{}: cannot tell the robot of this jump ({}), expected --robot ROBOT.yaml", file.string(),
      found.empty() ? "no YAML beside a folder 'jumps' that it is in"
                    : "several YAMLs beside the folder 'jumps'"));
}

actions::JumpTask TaskOf(const collocation::StoredSolution& solution, const fs::path& file) {
  static const std::regex kPattern(R"(jump of (-?\d{1,3}\.\d+) m by (-?\d{1,3}\.\d+) m)");
  std::smatch match;
  if (!std::regex_match(solution.problem, match, kPattern)) {
    throw InputError(fmt::format("{}: problem: expected 'jump of D m by H m', got '{}'",
                                 file.string(), solution.problem.substr(0, 40)));
  }
  return {std::strtod(match[1].str().c_str(), nullptr),
          std::strtod(match[2].str().c_str(), nullptr)};
}

/// A library's folders are named by the identity of their jumps.
bool IsInFolder(const fs::path& file, const fs::path& expected) {
  static const std::regex kIdentity("[0-9a-f]{16}");
  const std::string folder = fs::absolute(file).lexically_normal().parent_path().filename();
  return !std::regex_match(folder, kIdentity) || folder == expected.filename();
}

/// The least and the greatest x of the bearing points in a phase's first knot.
std::pair<double, double> ExtentOnGround(const models::RobotModel& robot,
                                         const actions::Phase& phase) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(phase.knots.front().q);
  std::pair<double, double> extent = {INFINITY, -INFINITY};
  for (const actions::BearingPatch& bearing : actions::BearingPatches(robot, phase)) {
    const models::ContactPatch& patch = robot.contacts[bearing.patch];
    for (const int point : bearing.points) {
      const double x = kinematics.Position(patch.link, patch.points[point]).x();
      extent = {std::min(extent.first, x), std::max(extent.second, x)};
    }
  }
  return extent;
}

models::Obstacle Floor(const std::string& name, double begin, double end, double height) {
  models::Obstacle floor;
  floor.name = name;
  floor.shape = models::Shape::Box({end - begin, kFloorWidth, kFloorDepth});
  floor.X_WO.translation() << (begin + end) / 2, 0, height - kFloorDepth / 2;
  floor.is_ground = true;
  return floor;
}

struct Gap {
  double begin = 0;  ///< m, at the toes at take-off
  double end = 0;    ///< m, least x of the landing contacts
};

Gap GapOf(const LoadedJump& loaded) {
  const std::vector<actions::Phase>& phases = loaded.jump->phases;
  const double begin = ExtentOnGround(loaded.robot, phases.front()).second;
  return {begin, std::max(begin, ExtentOnGround(loaded.robot, phases.back()).first)};
}

models::Scenario TwoFloors(const LoadedJump& loaded) {
  const actions::JumpTask& task = loaded.jump->task;
  const Gap gap = GapOf(loaded);
  const double end = task.distance + kFloorBehind;
  models::Scenario scenario;
  scenario.environment.obstacles = {Floor("launch ground", -kFloorBehind, gap.begin, 0),
                                    Floor("landing ground", gap.end, end, task.height)};
  scenario.environment.bounds = {Eigen::Vector2d(-kFloorBehind, -kFloorWidth / 2),
                                 Eigen::Vector2d(end, kFloorWidth / 2)};
  scenario.start = {loaded.kind.from, 0, 0, 0, 0};
  scenario.goals = {{loaded.kind.to, task.distance, 0, task.height, 0}};
  return scenario;
}

/// The quantity of a joint that comes closest to its limit.
struct Extreme {
  double fraction = 0;
  std::string joint;
  double time = 0;  ///< s
  std::string Text() const {
    return fmt::format("{:.0f} % ({}, {:.2f} s)", 100 * fraction, joint, time);
  }
  void Consider(double value, double limit, const std::string& name, double t) {
    if (!(limit > 0) || std::abs(value) / limit <= fraction) return;
    *this = {std::abs(value) / limit, name, t};
  }
};

/// Adds flights and impacts to the heading.
void AddFlight(const LoadedJump& loaded, PageHeading* heading) {
  dynamics::TreeKinematics kinematics(loaded.robot);
  for (const actions::Phase& phase : loaded.jump->phases) {
    if (phase.contacts.empty()) {
      const CentroidalState start = CentroidalStateAt(phase.knots.front(), &kinematics);
      const double up = start.linear.z() / kinematics.total_mass();
      heading->facts.emplace_back(
          "Flight",
          fmt::format("{:.2f} s, {:.3f} m up", phase.knots.back().t - phase.knots.front().t,
                      std::pow(std::max(0.0, up), 2) / (2 * dynamics::kGravity)));
    }
    if (phase.impulses.cols() > 0) {
      heading->facts.emplace_back("Impact", fmt::format("{:.1f} N s, {:.1f} J, {:.0f} % friction",
                                                        phase.impulses.rowwise().sum().norm(),
                                                        loaded.jump->report->energy_lost,
                                                        100 * loaded.jump->report->impact_friction));
    }
  }
}

void AddExtremes(const LoadedJump& loaded, PageHeading* heading) {
  Extreme speed;
  Extreme torque;
  for (const actions::Phase& phase : loaded.jump->phases) {
    for (const actions::Knot& knot : phase.knots) {
      const Eigen::VectorXd motors = models::MotorTorques(loaded.robot, knot.tau);
      for (int i = 0; i < loaded.robot.num_joints(); ++i) {
        const models::Joint& joint = loaded.robot.joints[i];
        speed.Consider(knot.v[6 + i], joint.velocity, joint.name, knot.t);
        if (joint.mimic) continue;
        const double limit = joint.actuator.Limit(joint.effort, motors[i], knot.v[6 + i]);
        torque.Consider(motors[i], limit, joint.name, knot.t);
      }
    }
  }
  heading->facts.emplace_back("Joint speed", speed.Text());
  heading->facts.emplace_back("Joint torque", torque.Text());
}

PageHeading JumpHeading(const LoadedJump& loaded) {
  const actions::JumpTask& task = loaded.jump->task;
  const Gap gap = GapOf(loaded);
  const std::string name =
      task.height == 0 ? fmt::format("{:.2f} m", task.distance)
                       : fmt::format("{:.2f} m, {:.3f} m {}", task.distance, std::abs(task.height),
                                     task.height > 0 ? "up" : "down");
  PageHeading heading;
  heading.title = fmt::format("{} of {} – possibility", loaded.kind.name, name);
  heading.plots_first = true;
  heading.facts = {{"Jump", name},
                   {"Robot", loaded.robot.name},
                   {"From, to", fmt::format("{}, {}", loaded.kind.from, loaded.kind.to)},
                   {"Widest gap", fmt::format("{:.2f} m", gap.end - gap.begin)},
                   {"Duration", fmt::format("{:.2f} s", loaded.jump->duration())}};
  AddFlight(loaded, &heading);
  AddExtremes(loaded, &heading);
  return heading;
}

}  // namespace

namespace {

actions::NominalStance StanceOf(const models::RobotModel& robot, const std::string& gait) {
  return actions::SolveNominalStance(robot, robot.GaitNamed(gait));
}

/// Whether the file is in the solver's folder of a library.
bool IsOfLibrary(const fs::path& file, const actions::JumpSolver& solver) {
  return IsInFolder(file, actions::JumpLibrary(solver, file.parent_path().parent_path()).folder());
}

/// The robot's jump in whose folder the file is, or its first one.
models::Jump KindOf(const fs::path& file, const models::RobotModel& robot) {
  for (const models::Jump& jump : robot.jumps) {
    const actions::NominalStance launch = StanceOf(robot, jump.from);
    const actions::NominalStance landing = StanceOf(robot, jump.to);
    if (IsOfLibrary(file, actions::JumpSolver(robot, launch, landing))) return jump;
  }
  return robot.jumps.front();
}

}  // namespace

LoadedJump LoadJump(const fs::path& file, const fs::path& robot_file) {
  const collocation::StoredSolution solution = collocation::ReadSolution(file);
  const actions::JumpTask task = TaskOf(solution, file);
  LoadedJump loaded;
  loaded.file = file;
  loaded.robot = models::LoadRobotModel(robot_file.empty() ? RobotBeside(file) : robot_file);
  if (loaded.robot.jumps.empty()) {
    throw InputError(fmt::format("{}: jumps: the robot has none, expected that of {}",
                                 loaded.robot.file.string(), file.string()));
  }
  loaded.kind = KindOf(file, loaded.robot);
  const actions::NominalStance launch = StanceOf(loaded.robot, loaded.kind.from);
  const actions::NominalStance landing = StanceOf(loaded.robot, loaded.kind.to);
  const actions::JumpSolver solver(loaded.robot, launch, landing);
  loaded.is_current = IsOfLibrary(file, solver);
  try {
    const actions::JumpAnswer answer = solver.Realise(task, solution);
    if (!answer.jump) throw InputError(fmt::format("{}: {}", file.string(), answer.reason));
    loaded.jump = answer.jump;
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: no jump of the robot {}: {}", file.string(),
                                 loaded.robot.file.string(), error.what()));
  }
  return loaded;
}

std::string JumpPage(const LoadedJump& loaded) {
  actions::Plan plan;
  for (const models::Joint& joint : loaded.robot.joints) plan.joints.push_back(joint.name);
  plan.segments = {{loaded.kind.name, loaded.jump->phases}};
  return ViewerPage(plan, loaded.robot, TwoFloors(loaded), JumpHeading(loaded));
}

}  // namespace possibility::experiments
