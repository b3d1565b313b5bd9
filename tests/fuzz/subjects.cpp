#include "tests/fuzz/subjects.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "actions/gait/pace_library.h"
#include "actions/jump/jump_library.h"
#include "actions/motion/motion_folder.h"
#include "actions/plan/packed_writer.h"
#include "actions/plan/plan_reader.h"
#include "actions/plan/plan_writer.h"
#include "actions/planner/planner.h"
#include "actions/verify/verifier.h"
#include "actions/wholebody/nominal_stance.h"
#include "collocation/study/stored_solution_reader.h"
#include "experiments/command/loaded_plan.h"
#include "experiments/exports/csv_export.h"
#include "experiments/exports/csv_tables.h"
#include "experiments/exports/npz_export.h"
#include "experiments/exports/plan_export.h"
#include "experiments/imports/imported_plan.h"
#include "experiments/imports/trajectory_reader.h"
#include "experiments/viewer/jump_page.h"
#include "experiments/viewer/viewer_page.h"
#include "models/archive/zip_file.h"
#include "models/input/file_contents.h"
#include "models/mesh/height_map.h"
#include "models/mesh/mesh_reader.h"
#include "models/robot/robot_yaml.h"
#include "models/world/collision.h"
#include "models/world/ground_map.h"
#include "models/world/scenario.h"
#include "models/world/terrain.h"
#include "tests/actions/hop_plan.h"
#include "tests/experiments/standing_plan.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/models/mesh/png_files.h"
#include "tests/models/two_legged_robot.h"

namespace possibility::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = POSSIBILITY_SOURCE_DIR;
const fs::path kRobotFolder = kSource / "models/drchubo1";
const fs::path kScenario = kSource / "experiments/scenarios/three_routes_b.yaml";

/// Expensive uses of a readable file are made in one case of this many.
constexpr std::uint64_t kDear = 100;

fs::path Write(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

std::string ReplacedOnce(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The shipped scenarios, which find their robot from any folder.
std::vector<std::string> ScenarioTexts() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kScenario.parent_path())) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    const std::string text = ReplacedOnce(models::ReadFileContents(file), "../../models/drchubo1",
                                          kRobotFolder.string());
    texts.push_back(
        ReplacedOnce(text, "file: ", fmt::format("file: {}/", kScenario.parent_path().string())));
  }
  return texts;
}

void PlanBriefly(const models::RobotModel& robot, const models::Scenario& scenario) {
  actions::PlanRequest request;
  request.seed = scenario.seed;
  request.time_limit = 0.5;
  request.library = kRobotFolder / "jumps";
  actions::PlanTraversal(robot, scenario, request);
}

void UseRobot(const fs::path& file) {
  const models::RobotModel robot = models::LoadRobotModel(file);
  for (const models::Gait& gait : robot.gaits) actions::SolveNominalStance(robot, gait);
}

/// Keeps a knot every third of a second, so that texts stay short.
void Thin(actions::Plan* plan) {
  for (actions::Segment& segment : plan->segments) {
    for (actions::Phase& phase : segment.phases) {
      std::vector<actions::Knot> knots;
      for (std::size_t i = 0; i < phase.knots.size(); i += 30) knots.push_back(phase.knots[i]);
      if (knots.back().t < phase.knots.back().t) knots.push_back(phase.knots.back());
      phase.knots = std::move(knots);
    }
  }
}

/// The same plan with its numbers in a table, as long plans are written.
std::string WithSeries(const std::string& text) {
  nlohmann::ordered_json plan = nlohmann::ordered_json::parse(text);
  nlohmann::ordered_json series = nlohmann::ordered_json::array();
  for (auto& segment : plan["segments"]) {
    for (auto& phase : segment["phases"]) {
      for (const char* key : {"q", "v", "a", "tau", "forces"}) {
        const nlohmann::ordered_json rows = phase[key];
        nlohmann::ordered_json indices = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < rows[0].size(); ++i) {
          nlohmann::ordered_json course = nlohmann::ordered_json::array();
          for (const auto& row : rows) course.push_back(row[i]);
          indices.push_back(series.size());
          series.push_back(i >= 7 && i % 5 == 0 ? course[0] : course);
        }
        phase[key] = indices;
      }
    }
  }
  plan["series"] = series;
  return plan.dump();
}

/// Plans that contain everything a plan can hold: standing, a hop with flight and impact, the same
/// with a table, and a "no".
std::vector<std::string> PlanTexts(const fs::path& folder) {
  const fs::path file = folder / "whole_plan.json";
  std::vector<std::string> texts;
  const auto add = [&](const actions::Plan& plan) {
    actions::WritePlan(plan, file);
    texts.push_back(models::ReadFileContents(file));
  };
  experiments::testing::WriteStandingPlan(kScenario, file);
  actions::Plan plan = actions::ReadPlan(file);
  plan.statistics = {{"vertices", 12}, {"edges", 7}};
  plan.explored.vertices = {{{1, 2, 3}, 0.5}, {{2, 2, 3}, 0.5}};
  plan.explored.edges = {{0, 1, "walk"}};
  add(plan);
  const models::RobotModel robot = models::LoadRobotModel(plan.robot_file);
  plan.segments.push_back(actions::testing::Hop(robot).Build());
  const double begin = plan.segments[0].phases[0].knots.back().t;
  for (actions::Phase& phase : plan.segments[1].phases) {
    for (actions::Knot& knot : phase.knots) knot.t += begin;
  }
  Thin(&plan);
  add(plan);
  texts.push_back(WithSeries(texts.back()));
  plan.segments.clear();
  plan.no = actions::NoPlan{"exhausted", "why not", actions::Barrier{}};
  plan.no->barrier->closed_by = {"wall"};
  plan.no->barrier->reached = {{"walk", 0.1, {{{0, 0}, {1, 0}, {0, 1}}}}};
  add(plan);
  return texts;
}

/// The robot's jumps, ready to be realised.
struct Jumps {
  models::RobotModel robot = models::LoadRobotModel(kRobotFolder / "drchubo1.yaml");
  actions::NominalStance launch =
      actions::SolveNominalStance(robot, robot.GaitNamed(robot.jumps[0].from));
  actions::NominalStance landing =
      actions::SolveNominalStance(robot, robot.GaitNamed(robot.jumps[0].to));
  actions::JumpSolver solver{robot, launch, landing};
  std::string identity = solver.Identity();
  fs::path shipped = actions::MotionFolder(kRobotFolder / "jumps", identity);
};

}  // namespace

Subject ScenarioSubject(const fs::path& folder) {
  const auto robot = std::make_shared<const models::RobotModel>(
      models::LoadRobotModel(kRobotFolder / "drchubo1.yaml"));
  return {"scenario", ".yaml", Syntax::kYaml,
          [texts = ScenarioTexts()](std::uint64_t seed) { return texts[seed % texts.size()]; },
          [folder, robot](std::uint64_t seed, const std::string& text) {
            const models::Scenario scenario =
                models::LoadScenario(Write(folder / "scenario.yaml", text));
            if (seed % kDear == 0) PlanBriefly(*robot, scenario);
          }};
}

namespace {

/// As the world uses a surface.
void UseSurface(const models::TriangleMesh& mesh, std::optional<double> base) {
  models::Environment environment;
  models::AddTerrain({"terrain", mesh, true, base}, &environment);
  const models::CollisionChecker checker(environment);
  const models::GroundMap ground(environment);
  checker.IsFree(models::Shape::Sphere(0.1), Eigen::Isometry3d::Identity(), 0.01);
  ground.HeightBelow({0.5, 0.5}, 1);
}

}  // namespace

Subject MeshSubject(const fs::path& folder) {
  models::TriangleMesh mesh = models::testing::BoxMesh({1, 2, 0.5});
  models::testing::Append(models::testing::BoxMesh({0.4, 0.3, 1}), &mesh);
  const std::array<std::pair<std::string, std::string>, 6> files = {{
      {"mesh.stl", models::testing::TextStl(mesh)},
      {"mesh.stl", models::testing::BinaryStl(mesh)},
      {"mesh.obj", models::testing::Obj(mesh) + "f 1 2 4 3\nf -1/2/3 -2 -3//1 -4 -5\n"},
      {"mesh.ply", models::testing::TextPly(mesh)},
      {"mesh.ply", models::testing::BinaryPly(mesh)},
      {"mesh.dae", models::testing::Collada(mesh, 1, "Z_UP")},
  }};
  return {"mesh", ".mesh", Syntax::kYaml,
          [files](std::uint64_t seed) { return files[seed % files.size()].second; },
          [folder, files](std::uint64_t seed, const std::string& text) {
            const models::TriangleMesh read =
                models::ReadMesh(Write(folder / files[seed % files.size()].first, text));
            if (read.Bounds().sizes().maxCoeff() < 1000) UseSurface(read, std::nullopt);
          }};
}

Subject HeightMapSubject(const fs::path& folder) {
  Eigen::MatrixXd heights(12, 9);
  std::string csv;
  for (int row = 0; row < heights.rows(); ++row) {
    for (int column = 0; column < heights.cols(); ++column) {
      heights(row, column) = 10 * (row / 4) + 7 * (column % 3);
      csv += fmt::format("{}{}", column == 0 ? "" : ", ", heights(row, column) / 100);
    }
    csv += "\n";
  }
  const std::array<std::pair<std::string, std::string>, 3> files = {{
      {"map.csv", csv},
      {"map.png", models::testing::PngOf(heights, 8, 0)},
      {"map.png", models::testing::PngOf(heights, 16, 0)},
  }};
  return {"height_map", ".map", Syntax::kYaml,
          [files](std::uint64_t seed) { return files[seed % files.size()].second; },
          [folder, files](std::uint64_t seed, const std::string& text) {
            const Eigen::MatrixXd read =
                models::ReadHeights(Write(folder / files[seed % files.size()].first, text));
            const models::TriangleMesh mesh = models::MeshOfHeights(read / 100, 0.1);
            if (mesh.Bounds().sizes().maxCoeff() < 1000) {
              UseSurface(mesh, mesh.Bounds().min().z() - 0.5);
            }
          }};
}

Subject RobotSubject(const fs::path& folder) {
  Write(folder / "robot.urdf", models::TwoLeggedUrdf());
  const std::string large =
      ReplacedOnce(models::ReadFileContents(kRobotFolder / "drchubo1.yaml"), "drchubo1.urdf",
                   (kRobotFolder / "drchubo1.urdf").string());
  const std::string small = ReplacedOnce(
      models::TwoLeggedYaml(), "shapes:",
      "actuators:\n"
      "  - {joints: [l_yaw, r_yaw], armature: 0.3, viscous_friction: 1, reason: assumed}\n"
      "  - {joints: [l_roll], dry_friction: 2, dry_speed: 0.1, stall_torque: 60, "
      "no_load_speed: 9, reason: assumed}\n"
      "shapes:");
  return {"robot", ".yaml", Syntax::kYaml,
          [large, small](std::uint64_t seed) { return seed % 2 == 0 ? small : large; },
          [folder](std::uint64_t, const std::string& text) {
            UseRobot(Write(folder / "robot.yaml", text));
          }};
}

Subject UrdfSubject(const fs::path& folder) {
  const std::string large_yaml = models::ReadFileContents(kRobotFolder / "drchubo1.yaml");
  const std::string large_urdf = models::ReadFileContents(kRobotFolder / "drchubo1.urdf");
  Write(folder / "small.yaml", ReplacedOnce(models::TwoLeggedYaml(), "robot.urdf", "spoilt.urdf"));
  Write(folder / "large.yaml", ReplacedOnce(large_yaml, "drchubo1.urdf", "spoilt.urdf"));
  return {"urdf", ".urdf", Syntax::kXml,
          [large_urdf](std::uint64_t seed) {
            return seed % 2 == 0 ? models::TwoLeggedUrdf() : large_urdf;
          },
          [folder](std::uint64_t seed, const std::string& text) {
            Write(folder / "spoilt.urdf", text);
            UseRobot(folder / (seed % 2 == 0 ? "small.yaml" : "large.yaml"));
          }};
}

namespace {

/// As all commands use a plan file.
void UsePlan(const fs::path& file) {
  const experiments::LoadedPlan loaded = experiments::LoadPlan(file);
  actions::VerifierSettings settings;
  settings.simulates = false;
  actions::Verify(loaded.plan, loaded.robot, loaded.scenario, settings);
  experiments::RequireFit(loaded);
  experiments::ViewerPage(loaded.plan, loaded.robot, loaded.scenario);
  const experiments::TrajectoryTable trajectory(loaded.plan, loaded.robot);
  experiments::ContactForceTable forces(loaded.plan, loaded.robot);
  experiments::VisitKnots(loaded.plan, [&](const experiments::PlanSample& sample) {
    trajectory.Rows(sample);
    forces.Rows(sample);
  });
  const experiments::ExportSubject subject{loaded.plan, loaded.robot, loaded.scenario};
  for (const char* name : {"again.json", "again.zip"}) {
    experiments::WritePlanFile(subject, {}, file.parent_path() / name);
  }
}

/// What of a packed plan is spoilt: its document, a block of its motion (both under a CRC that is
/// right again), or the archive.
constexpr std::array<const char*, 3> kPackedParts = {"plan.json", "motion/0", ""};

/// The members of packed plans that contain everything a plan can hold; the third has no torques.
std::vector<std::map<std::string, std::string>> PackedPlans(const fs::path& folder) {
  std::vector<std::map<std::string, std::string>> plans;
  const fs::path file = folder / "whole_plan.zip";
  for (const std::string& text : PlanTexts(folder)) {
    actions::WritePackedPlan(
        actions::ParsePlan(text, folder / "whole_plan.json"), file,
        plans.size() == 2 ? actions::PackedTorques::kLeftOut : actions::PackedTorques::kStored);
    plans.push_back(models::ReadZip(models::ReadFileContents(file), file));
    plans.back().emplace("motion/0", "");  // that of a "no"
  }
  return plans;
}

std::string ZipOf(const std::map<std::string, std::string>& members, const fs::path& file) {
  models::ZipWriter archive(file);
  for (const auto& [name, content] : members) archive.Add(name, content);
  archive.Commit();
  return models::ReadFileContents(file);
}

}  // namespace

Subject PlanSubject(const fs::path& folder) {
  return {"plan", ".json", Syntax::kJson,
          [texts = PlanTexts(folder)](std::uint64_t seed) { return texts[seed % texts.size()]; },
          [folder](std::uint64_t, const std::string& text) {
            UsePlan(Write(folder / "plan.json", text));
          }};
}

Subject PackedPlanSubject(const fs::path& folder) {
  const auto plans = PackedPlans(folder);
  const auto plan_of = [plans](std::uint64_t seed) {
    return plans[seed / kPackedParts.size() % plans.size()];
  };
  const auto part_of = [](std::uint64_t seed) -> std::string {
    return kPackedParts[seed % kPackedParts.size()];
  };
  return {"packed_plan", ".zip", Syntax::kJson,
          [=](std::uint64_t seed) {
            const auto members = plan_of(seed);
            const std::string part = part_of(seed);
            return part.empty() ? ZipOf(members, folder / "whole.zip") : members.at(part);
          },
          [=](std::uint64_t seed, const std::string& text) {
            const std::string part = part_of(seed);
            if (part.empty()) return UsePlan(Write(folder / "plan.zip", text));
            auto members = plan_of(seed);
            members[part] = text;
            ZipOf(members, folder / "plan.zip");
            UsePlan(folder / "plan.zip");
          }};
}

Subject TrajectorySubject(const fs::path& folder) {
  experiments::testing::WriteStandingPlan(kScenario, folder / "whole_plan.json");
  const auto loaded = std::make_shared<const experiments::LoadedPlan>(
      experiments::LoadPlan(folder / "whole_plan.json"));
  const experiments::ExportSubject subject{loaded->plan, loaded->robot, loaded->scenario};
  experiments::WriteCsv(subject, {}, folder);
  experiments::WriteNpz(subject, {}, folder / "plan.npz");
  const std::array<std::string, 2> texts = {models::ReadFileContents(folder / "trajectory.csv"),
                                            models::ReadFileContents(folder / "plan.npz")};
  return {"trajectory", ".csv", Syntax::kYaml,
          [texts](std::uint64_t seed) { return texts[seed % texts.size()]; },
          [folder, loaded](std::uint64_t, const std::string& text) {
            const experiments::ImportedTrajectory trajectory =
                experiments::ReadTrajectory(Write(folder / "motion.csv", text), loaded->robot);
            const actions::Plan plan =
                experiments::ImportPlan(trajectory, loaded->robot, loaded->scenario);
            actions::WritePlan(plan, folder / "imported.json");
          }};
}

Subject SolutionSubject(const fs::path& folder) {
  const auto jumps = std::make_shared<const Jumps>();
  const std::string text = models::ReadFileContents(jumps->shipped / "jump_10_0.json");
  const fs::path library = actions::MotionFolder(folder / "solutions", jumps->identity);
  fs::create_directories(library);
  return {"solution", ".json", Syntax::kJson, [text](std::uint64_t) { return text; },
          [folder, jumps, library](std::uint64_t seed, const std::string& spoilt) {
            const fs::path file = Write(library / "jump_10_0.json", spoilt);
            if (seed % kDear == 0) {
              actions::JumpLibrary(jumps->solver, folder / "solutions").Find({0.5, 0});
            }
            if (seed % kDear == 1) {
              experiments::JumpPage(experiments::LoadJump(file, kRobotFolder / "drchubo1.yaml"));
            }
            collocation::ReadSolution(file);
          }};
}

Subject LibrarySubject(const fs::path& folder) {
  const auto jumps = std::make_shared<const Jumps>();
  const std::string reach = models::ReadFileContents(jumps->shipped / "reach.json");
  const models::Gait& gait = jumps->robot.gaits.front();
  const actions::PaceLibrary paces(jumps->robot, folder / "library");
  const actions::PaceLibrary shipped(jumps->robot, kRobotFolder / "jumps");
  paces.Save(gait, shipped.Find(gait).value());
  const std::string fitted = models::ReadFileContents(paces.FileOf(gait));
  const fs::path library = actions::MotionFolder(folder / "library", jumps->identity);
  fs::create_directories(library);
  return {"library", ".json", Syntax::kJson,
          [reach, fitted](std::uint64_t seed) { return seed % 2 == 0 ? reach : fitted; },
          [=](std::uint64_t seed, const std::string& spoilt) {
            Write(seed % 2 == 0 ? library / "reach.json" : paces.FileOf(gait), spoilt);
            paces.Find(gait);
            if (seed % 2 != 0) return;
            const actions::JumpLibrary reader(jumps->solver, folder / "library");
            for (const double height : {-1e6, -0.2, 0.0, 0.05, 1e6}) {
              reader.reach().Distances(height);
              reader.reach().Allows({0.5, height});
            }
          }};
}

}  // namespace possibility::fuzz
