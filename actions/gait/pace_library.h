#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "actions/gait/pace.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// The fitted paces of a robot's gaits in a folder, so that a robot is fitted once. A robot whose
/// files change gets a new part of the folder. Stale paces do no harm: every motion is checked when
/// it is made.
class PaceLibrary {
 public:
  /// `library`: empty for none; need not exist.
  PaceLibrary(const models::RobotModel& robot, const std::filesystem::path& library);

  /// From quick to slow; none if the folder has no plausible paces of `gait`.
  std::optional<std::vector<Pace>> Find(const models::Gait& gait) const;
  /// Without a folder it does nothing. @throws InputError if the file cannot be written.
  void Save(const models::Gait& gait, const std::vector<Pace>& paces) const;

  std::filesystem::path FileOf(const models::Gait& gait) const;

 private:
  std::string identity_;
  std::filesystem::path folder_;
};

}  // namespace possibility::actions
