#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "actions/conditions/locomotion_model.h"
#include "actions/verify/verdict_store.h"
#include "common/cancellation_token.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// What plans of one robot have in common, kept from one request to the next
/// (PlanRequest::memory): the robot's locomotion, and verdicts on parts of plans. Any thread may
/// use it. Robots of one content hash must be equal.
class PlannerMemory {
 public:
  /// BuildLocomotionModel, or the model that was last built with the same arguments. It belongs to
  /// a copy of the robot. The library's files are read once.
  std::shared_ptr<const LocomotionModel> ModelOf(const models::RobotModel& robot,
                                                 const std::vector<std::string>& gaits,
                                                 const CancellationToken& cancellation,
                                                 const std::filesystem::path& library, int threads);

  VerdictStore& verdicts() { return verdicts_; }

 private:
  struct Built {
    std::string key;
    models::RobotModel robot;
    LocomotionModel model;
  };

  std::mutex mutex_;
  std::shared_ptr<Built> built_;
  VerdictStore verdicts_;
};

}  // namespace possibility::actions
