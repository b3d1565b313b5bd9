#include "actions/jump/jump_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "actions/jump/jump_motion_file.h"
#include "actions/motion/motion_folder.h"
#include "collocation/study/stored_solution_reader.h"
#include "collocation/study/stored_solution_writer.h"
#include "common/stopwatch.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/input/atomic_file.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/input/json_cursor.h"
#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

constexpr const char* kFormat = "possibility-jumps/1";
constexpr const char* kReachFile = "reach.json";
constexpr const char* kMotionEnding = ".zip";
constexpr const char* kSolutionEnding = ".json";
constexpr double kSame = 1e-9;  // m

/// Optimistic bound: ballistic flight at take-off speed v = greatest joint speed * leg length, with
/// a rise of v^2 / (2 g) and a range of v^2 / g plus two leg lengths.
JumpReach OptimisticReach(const SagittalModel& model) {
  const SagittalModel::Limb& leg = model.leg();
  double fastest = 0;
  for (const double speed : model.planar()->velocity()) {
    if (std::isfinite(speed)) fastest = std::max(fastest, speed);
  }
  const double speed = fastest * leg.length;
  const double rise = speed * speed / (2 * dynamics::kGravity);
  const double range = speed * speed / dynamics::kGravity + 2 * leg.length;
  return {{{-rise, JumpLibrary::kDistanceStep, range}, {rise, JumpLibrary::kDistanceStep, range}}};
}

}  // namespace

bool JumpReach::Allows(const JumpTask& task) const {
  const auto distances = Distances(task.height);
  return distances && task.distance >= distances->first - kSame &&
         task.distance <= distances->second + kSame;
}

std::optional<std::pair<double, double>> JumpReach::Distances(double height) const {
  std::optional<std::pair<double, double>> result;
  const auto join = [&result](const Row& row) {
    if (row.farthest < row.shortest) return;
    if (!result) result = {row.shortest, row.farthest};
    result->first = std::min(result->first, row.shortest);
    result->second = std::max(result->second, row.farthest);
  };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool at_row = std::abs(rows[i].height - height) < kSame;
    const bool before =
        i + 1 < rows.size() && rows[i].height < height && rows[i + 1].height > height;
    const bool after = i > 0 && rows[i - 1].height < height && rows[i].height > height;
    if (at_row || before || after) join(rows[i]);
  }
  return result;
}

JumpLibrary::JumpLibrary(const JumpSolver& solver, const std::filesystem::path& folder, Use use)
    : solver_(solver),
      identity_(solver.Identity()),
      folder_(MotionFolder(folder, identity_)),
      use_(use),
      reach_(OptimisticReach(solver.model())) {
  if (!folder_.empty()) ReadReach();
}

JumpTask JumpLibrary::OnGrid(const JumpTask& task) {
  return {kDistanceStep * std::round(task.distance / kDistanceStep),
          kHeightStep * std::round(task.height / kHeightStep)};
}

JumpLibrary::Key JumpLibrary::KeyOf(const JumpTask& task) {
  return {static_cast<int>(std::lround(task.distance / kDistanceStep)),
          static_cast<int>(std::lround(task.height / kHeightStep))};
}

std::optional<JumpAnswer> JumpLibrary::Find(const JumpTask& task) {
  {
    const std::lock_guard lock(mutex_);
    const auto known = answers_.find(KeyOf(task));
    if (known != answers_.end()) return known->second;
  }
  if (folder_.empty() || use_ == Use::kReachAlone) return std::nullopt;
  const JumpAnswer answer = Read(task);
  if (!answer.jump) return std::nullopt;
  const std::lock_guard lock(mutex_);
  return answers_.emplace(KeyOf(task), answer).first->second;
}

// A motion that cannot be read is realised from the solution; without that, the jump is solved
// again.
JumpAnswer JumpLibrary::Read(const JumpTask& task) const {
  const Stopwatch stopwatch;
  const std::filesystem::path motion = FileOf(task, kMotionEnding);
  const std::filesystem::path solution = FileOf(task, kSolutionEnding);
  if (std::filesystem::exists(motion)) {
    try {
      JumpAnswer answer;
      answer.jump =
          std::make_shared<const SolvedJump>(ReadJumpMotion(OnGrid(task), solver_.robot(), motion));
      answer.effort.total = stopwatch.Seconds();
      return answer;
    } catch (const std::exception&) {
    }
  }
  if (!std::filesystem::exists(solution)) return {};
  try {
    return solver_.Realise(OnGrid(task), collocation::ReadSolution(solution));
  } catch (const std::exception&) {
    return {};
  }
}

JumpAnswer JumpLibrary::FindOrSolve(const JumpTask& task, const CancellationToken& cancellation,
                                    const JumpSolver::Log& log) {
  if (auto known = Find(task)) return *known;
  JumpAnswer answer = solver_.Solve(OnGrid(task), cancellation, log);
  if (answer.cancelled) return answer;
  const std::lock_guard lock(mutex_);
  return answers_.emplace(KeyOf(task), answer).first->second;
}

std::filesystem::path JumpLibrary::FileOf(const JumpTask& task, const char* ending) const {
  const auto [distance, height] = KeyOf(task);
  return folder_ / fmt::format("jump_{}_{}{}", distance, height, ending);
}

void JumpLibrary::Save(const JumpAnswer& answer, const JumpTask& task) const {
  if (folder_.empty() || !answer.solution) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  collocation::WriteSolution(FileOf(task, kSolutionEnding), *answer.solution);
  WriteJumpMotion(*answer.jump, solver_.robot(), FileOf(task, kMotionEnding));
}

void JumpLibrary::SaveReach(const JumpReach& reach) const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  nlohmann::json rows = nlohmann::json::array();
  for (const JumpReach::Row& row : reach.rows) {
    rows.push_back({row.height, row.shortest, row.farthest});
  }
  const nlohmann::json document = {{"format", kFormat}, {"identity", identity_}, {"reach", rows}};
  models::WriteAtomically(folder_ / kReachFile, models::JsonText(document, 1) + "\n");
}

void JumpLibrary::ReadReach() {
  const std::filesystem::path file = folder_ / kReachFile;
  if (!std::filesystem::exists(file)) return;
  const nlohmann::json document =
      models::ParseJson(models::ReadFileContents(file), file, "a jump library");
  const models::JsonCursor root(document, file);
  root.ExpectFormat(kFormat);
  root.ExpectKeys({"format", "identity", "reach"});
  if (root["identity"].String() != identity_) return;
  JumpReach reach;
  const models::JsonCursor rows = root["reach"];
  for (std::size_t i = 0; i < rows.ArraySize(); ++i) {
    const models::JsonCursor row = rows[i];
    if (row.ArraySize() != 3) row.Fail("expected height, shortest and farthest distance");
    reach.rows.push_back(
        {row[std::size_t{0}].Number(), row[std::size_t{1}].Number(), row[std::size_t{2}].Number()});
    if (i > 0 && reach.rows[i].height <= reach.rows[i - 1].height)
      row[std::size_t{0}].Fail("must ascend");
  }
  if (reach.rows.empty()) return;
  reach_ = std::move(reach);
  reach_is_derived_ = true;
}

}  // namespace possibility::actions
