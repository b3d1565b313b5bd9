#include "actions/planner/planner_memory.h"

#include <string_view>

#include "models/input/byte_text.h"

namespace possibility::actions {

std::shared_ptr<const LocomotionModel> PlannerMemory::ModelOf(const models::RobotModel& robot,
                                                              const std::vector<std::string>& gaits,
                                                              const CancellationToken& cancellation,
                                                              const std::filesystem::path& library,
                                                              int threads) {
  models::ByteText key;
  key.Add(std::string_view(robot.content_hash)).Add(std::string_view(library.native()));
  for (const std::string& gait : gaits) key.Add(std::string_view(gait));
  const std::lock_guard lock(mutex_);
  if (!built_ || built_->key != key.text()) {
    auto built = std::make_shared<Built>();
    built->key = key.text();
    built->robot = robot;
    built->model = BuildLocomotionModel(built->robot, gaits, cancellation, library, {}, threads);
    built_ = std::move(built);
  }
  return {built_, &built_->model};
}

}  // namespace possibility::actions
