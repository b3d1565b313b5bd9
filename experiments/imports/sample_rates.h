#pragma once

#include <Eigen/Core>
#include <vector>

#include "experiments/imports/imported_trajectory.h"

namespace possibility::experiments {

/// v and a of every sample, nv each.
struct SampleRates {
  std::vector<Eigen::VectorXd> v;
  std::vector<Eigen::VectorXd> a;
};

/// Those of the file, or the derivatives of the polynomial through the seven nearest samples of
/// the same run (SteadyRuns), five near its ends, because accelerations may jump where contacts
/// change. A file without velocities is taken to begin and end at rest.
SampleRates RatesOf(const ImportedTrajectory& trajectory);

}  // namespace possibility::experiments
