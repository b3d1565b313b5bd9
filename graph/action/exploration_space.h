#pragma once

#include <Eigen/Core>
#include <random>

namespace possibility::graph {

/// A point of the possibility exploration space E. The actions define the meaning of its
/// coordinates (for a humanoid the SE(3) pose of its pelvis; for the stick figure of Fig. 3, x and
/// z). At most 8 coordinates, so that points need no heap memory.
using Point = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 8, 1>;

using RandomGenerator = std::mt19937_64;

/// The space E: random targets and the distance between points.
class ExplorationSpace {
 public:
  virtual ~ExplorationSpace() = default;

  /// Uniform sample of E.
  virtual Point RandomSample(RandomGenerator* generator) const = 0;

  /// Metric of E, >= 0, symmetric; 0 exactly for the same point.
  virtual double Distance(const Point& a, const Point& b) const = 0;
};

}  // namespace possibility::graph
