#include "experiments/imports/trajectory_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/imports/trajectory_csv.h"
#include "experiments/imports/trajectory_npz.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr std::uintmax_t kLargestTrajectory = 1u << 30;  // bytes
constexpr double kLargestNumber = 1e6;
constexpr double kQuaternionTolerance = 1e-3;  // of its length; files may have few digits

void RequireNumbers(const Eigen::VectorXd& numbers, const std::string& where) {
  if ((numbers.array().abs() <= kLargestNumber).all()) return;  // false for NaN
  throw InputError(fmt::format("{}: expected numbers up to {}", where, kLargestNumber));
}

void CheckSample(const std::string& where, ImportedSample* sample) {
  for (const auto* numbers : {&sample->q, &sample->v, &sample->a}) RequireNumbers(*numbers, where);
  RequireNumbers(Eigen::VectorXd::Constant(1, sample->t), where);
  const double length = sample->q.head<4>().norm();
  if (std::abs(length - 1) > kQuaternionTolerance) {
    throw InputError(fmt::format("{}: root orientation: expected a unit quaternion, got length {}",
                                 where, length));
  }
  sample->q.head<4>() /= length;
}

/// Checks all samples, and lets time begin at 0.
void CheckTrajectory(ImportedTrajectory* trajectory) {
  const std::string file = trajectory->file.string();
  if (trajectory->samples.size() < 2) {
    throw InputError(fmt::format("{}: expected at least two samples", file));
  }
  const double begin = trajectory->samples.front().t;
  double before = begin;
  for (std::size_t i = 0; i < trajectory->samples.size(); ++i) {
    ImportedSample& sample = trajectory->samples[i];
    const std::string where = fmt::format("{}: sample {}", file, i);
    CheckSample(where, &sample);
    if (sample.t < before - kSameTime) {
      throw InputError(fmt::format("{}: t: {} comes after {}, expected times in order", where,
                                   sample.t, before));
    }
    sample.t = before = std::max(sample.t, before);
    sample.t -= begin;
  }
  if (trajectory->samples.back().t < kSameTime) {
    throw InputError(fmt::format("{}: t: expected a motion that lasts", file));
  }
}

}  // namespace

ImportedTrajectory ReadTrajectory(const std::filesystem::path& file,
                                  const models::RobotModel& robot) {
  const std::string bytes = models::ReadFileContents(file, kLargestTrajectory);
  ImportedTrajectory trajectory = bytes.starts_with("PK\x03\x04")
                                      ? ParseTrajectoryNpz(bytes, file, robot)
                                      : ParseTrajectoryCsv(bytes, file, robot);
  trajectory.file = file;
  CheckTrajectory(&trajectory);
  return trajectory;
}

}  // namespace possibility::experiments
