#include "experiments/support/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>

namespace possibility::experiments {
namespace {

constexpr double kQuantile = 1.959963984540054;  // of the normal distribution at 0.975

void RequireValues(const std::vector<double>& values) {
  if (values.empty()) throw std::invalid_argument("statistics of an empty sample");
}

/// Median of an ascending sample.
double MedianOf(const std::vector<double>& sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

/// Percentile of an ascending sample, by nearest rank.
double PercentileOf(const std::vector<double>& sorted, double percent) {
  const double rank = std::ceil(percent / 100 * static_cast<double>(sorted.size()) - 1e-9);
  const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  return sorted[std::min(index, sorted.size() - 1)];
}

}  // namespace

double Mean(const std::vector<double>& values) {
  RequireValues(values);
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double SampleStd(const std::vector<double>& values) {
  const double mean = Mean(values);
  if (values.size() == 1) return 0;
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double Median(std::vector<double> values) {
  RequireValues(values);
  std::sort(values.begin(), values.end());
  return MedianOf(values);
}

double Percentile(std::vector<double> values, double percent) {
  RequireValues(values);
  if (!(percent > 0 && percent <= 100)) {
    throw std::invalid_argument("a percentile is within (0, 100]");
  }
  std::sort(values.begin(), values.end());
  return PercentileOf(values, percent);
}

SampleSummary Summarise(const std::vector<double>& values) {
  return {Mean(values), SampleStd(values), Median(values), Percentile(values, 95),
          *std::max_element(values.begin(), values.end())};
}

std::pair<double, double> WilsonInterval(std::int64_t successes, std::int64_t trials) {
  if (trials < 0 || successes < 0 || successes > trials) {
    throw std::invalid_argument("expected 0 <= successes <= trials");
  }
  if (trials == 0) return {0, 1};
  const double n = static_cast<double>(trials);
  const double p = static_cast<double>(successes) / n;
  const double z2 = kQuantile * kQuantile;
  const double centre = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = kQuantile / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  // Exactly 0 and 1 at the ends, in spite of rounding.
  return {successes == 0 ? 0 : std::max(0.0, centre - half),
          successes == trials ? 1 : std::min(1.0, centre + half)};
}

std::pair<double, double> BootstrapMedianInterval(std::vector<double> values, int rounds) {
  RequireValues(values);
  if (rounds < 1) throw std::invalid_argument("expected at least one round");
  std::sort(values.begin(), values.end());
  std::mt19937_64 generator(values.size());
  std::vector<double> medians, drawn(values.size());
  for (int round = 0; round < rounds; ++round) {
    for (double& value : drawn) value = values[generator() % values.size()];
    medians.push_back(Median(drawn));
  }
  std::sort(medians.begin(), medians.end());
  return {PercentileOf(medians, 2.5), PercentileOf(medians, 97.5)};
}

}  // namespace possibility::experiments
