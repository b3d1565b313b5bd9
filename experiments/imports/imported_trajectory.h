#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace possibility::experiments {

/// The robot at one instant, as a file has it. Conventions of q, v, a: models::RobotModel.
struct ImportedSample {
  double t = 0;             ///< s
  Eigen::VectorXd q;        ///< nq, its quaternion of length 1
  Eigen::VectorXd v;        ///< nv; empty unless the file has velocities
  Eigen::VectorXd a;        ///< nv; empty unless the file has accelerations
  std::vector<bool> bears;  ///< by point of AllContactPoints
  int segment = 0;          ///< index into ImportedTrajectory::actions
};

/// A motion made by another program. Times do not decrease; two samples at the same time are the
/// end of one phase and the beginning of the next.
struct ImportedTrajectory {
  std::filesystem::path file;
  std::vector<ImportedSample> samples;  ///< at least two
  std::vector<std::string> actions;     ///< by segment; empty if the file names none

  bool has_velocities() const { return samples.front().v.size() > 0; }
  bool has_accelerations() const { return samples.front().a.size() > 0; }
};

/// Two times closer than this are one, s.
inline constexpr double kSameTime = 1e-9;

/// Whether the samples `i` and `i` + 1 are at the same time.
inline bool SharesTime(const ImportedTrajectory& trajectory, int i) {
  return trajectory.samples[i + 1].t - trajectory.samples[i].t < kSameTime;
}

}  // namespace possibility::experiments
