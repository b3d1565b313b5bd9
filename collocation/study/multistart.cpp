#include "collocation/study/multistart.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <utility>

namespace possibility::collocation {
namespace {

/// Waves of a departure: the k-th has k half periods in the phase and about 1/k of the size.
constexpr int kWaves = 3;
/// Shares of a phase at which motions are compared.
constexpr int kSamples = 20;

void Check(const MultistartSettings& settings) {
  if (settings.starts < 1) {
    throw std::invalid_argument(
        fmt::format("multistart: {} starts, expected 1 or more", settings.starts));
  }
  if (!(settings.noise >= 0 && std::isfinite(settings.noise))) {
    throw std::invalid_argument(
        fmt::format("multistart: noise is {}, expected 0 or more", settings.noise));
  }
  if (!(settings.same > 0 && std::isfinite(settings.same))) {
    throw std::invalid_argument(
        fmt::format("multistart: same is {}, expected more than 0", settings.same));
  }
}

/// A function of the share of a phase that vanishes at both ends.
class Departure {
 public:
  Departure(double size, std::mt19937* random) {
    // Not std::normal_distribution: its numbers differ between libraries.
    for (int k = 0; k < kWaves; ++k) {
      const double unit = 2.0 * (*random)() / static_cast<double>(std::mt19937::max()) - 1;
      amplitudes_[k] = size * unit / (k + 1);
    }
  }

  /// Differentiated `order` times by time, in a phase that lasts `duration`.
  double At(double s, int order, double duration) const {
    double sum = 0;
    for (int k = 0; k < kWaves; ++k) {
      const double half_turns = (k + 1) * std::numbers::pi;
      sum += amplitudes_[k] * std::pow(half_turns / duration, order) *
             std::sin(half_turns * s + order * std::numbers::pi / 2);
    }
    return sum;
  }

 private:
  std::array<double, kWaves> amplitudes_;
};

Trajectory OwnGuess(const OptimalControlProblem& problem, const OptimalControlOptions& options) {
  std::vector<Mesh> meshes = options.meshes;
  for (int p = static_cast<int>(meshes.size()); p < problem.num_phases(); ++p) {
    const bool is_one = options.intervals.size() == 1;
    meshes.push_back(UniformMesh(options.intervals.at(is_one ? 0 : p)));
  }
  const Transcription program(problem, options.scheme, std::move(meshes));
  return program.TrajectoryOf(program.InitialGuess());
}

Trajectory Departed(const OptimalControlProblem& problem, Trajectory guess, double noise,
                    std::mt19937* random) {
  for (int p = 0; p < problem.num_phases(); ++p) {
    const Phase& phase = problem.phase(p);
    PhaseTrajectory& motion = guess.phases[p];
    for (std::size_t c = 0; c < phase.coordinates().size(); ++c) {
      const Departure departure(noise * phase.coordinates()[c].front().scale, random);
      for (std::size_t order = 0; order < motion.coordinates.size(); ++order) {
        for (int point = 0; point < motion.num_points(); ++point) {
          motion.coordinates[order](static_cast<Eigen::Index>(c), point) +=
              departure.At(motion.PointShare(point), static_cast<int>(order), motion.duration);
        }
      }
    }
    for (std::size_t c = 0; c < phase.controls().size(); ++c) {
      const Departure departure(noise * phase.controls()[c].scale, random);
      for (int point = 0; point < motion.num_points(); ++point) {
        motion.controls(static_cast<Eigen::Index>(c), point) +=
            departure.At(motion.PointShare(point), 0, motion.duration);
      }
    }
  }
  return guess;
}

/// The greatest distance of two motions, in scales of the coordinates.
double DistanceOf(const OptimalControlProblem& problem, const Trajectory& a, const Trajectory& b) {
  double distance = 0;
  for (int p = 0; p < problem.num_phases(); ++p) {
    const auto& coordinates = problem.phase(p).coordinates();
    for (int i = 0; i <= kSamples; ++i) {
      const double s = static_cast<double>(i) / kSamples;
      const Eigen::VectorXd apart = a.phases[p].Coordinates(s) - b.phases[p].Coordinates(s);
      for (std::size_t c = 0; c < coordinates.size(); ++c) {
        distance = std::max(
            distance, std::abs(apart[static_cast<Eigen::Index>(c)]) / coordinates[c].front().scale);
      }
    }
  }
  return distance;
}

const char* WordsFor(StationaryPoint kind) {
  switch (kind) {
    case StationaryPoint::kMinimum:
      return ", a minimum";
    case StationaryPoint::kSaddle:
      return ", a saddle";
    default:
      return "";
  }
}

std::string Starts(int count) { return fmt::format("{} start{}", count, count == 1 ? "" : "s"); }

}  // namespace

MultistartResult SolveFromManyStarts(const OptimalControlProblem& problem,
                                     const OptimalControlOptions& options,
                                     const MultistartSettings& settings,
                                     const CancellationToken& cancellation) {
  Check(settings);
  const Trajectory own = OwnGuess(problem, options);
  std::mt19937 random(settings.seed);
  MultistartResult all;
  for (int start = 0; start < settings.starts; ++start) {
    const Trajectory guess = start == 0 ? own : Departed(problem, own, settings.noise, &random);
    OptimalControlResult result = SolveOptimalControl(problem, options, guess, cancellation);
    if (result.status == SolverStatus::kCancelled) {
      all.cancelled = true;
      break;
    }
    if (!result.succeeded()) {
      ++all.failures[result.message];
      continue;
    }
    const auto known =
        std::find_if(all.extremals.begin(), all.extremals.end(), [&](const Extremal& extremal) {
          return DistanceOf(problem, extremal.result.trajectory, result.trajectory) <=
                 settings.same;
        });
    if (known != all.extremals.end()) {
      ++known->count;
    } else {
      all.extremals.push_back({std::move(result), 1});
    }
  }
  std::stable_sort(
      all.extremals.begin(), all.extremals.end(),
      [](const Extremal& a, const Extremal& b) { return a.result.objective < b.result.objective; });
  return all;
}

std::string Summary(const MultistartResult& result) {
  std::string text;
  for (const Extremal& extremal : result.extremals) {
    text += fmt::format("{:.6g}: {}{}\n", extremal.result.objective, Starts(extremal.count),
                        WordsFor(extremal.result.stationary_point));
  }
  for (const auto& [message, count] : result.failures) {
    text += fmt::format("{} failed: {}\n", Starts(count), message);
  }
  return text;
}

}  // namespace possibility::collocation
