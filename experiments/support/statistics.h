#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace possibility::experiments {

/// Statistics of a sample of numbers. Unless stated otherwise, functions throw
/// std::invalid_argument if the sample is empty.

double Mean(const std::vector<double>& values);
/// Root of the unbiased variance (divided by n - 1); 0 for one value.
double SampleStd(const std::vector<double>& values);
/// The middle value; the mean of the two middle values of an even number.
double Median(std::vector<double> values);
/// By nearest rank: the smallest value of the sample that at least `percent` per cent of it do not
/// exceed. `percent` within (0, 100].
double Percentile(std::vector<double> values, double percent);

struct SampleSummary {
  double mean = 0;
  double std = 0;
  double median = 0;
  double p95 = 0;
  double max = 0;
};
SampleSummary Summarise(const std::vector<double>& values);

/// Wilson's score interval (Wilson 1927) of a probability, from `successes` in `trials`, at 95 %
/// confidence. [0, 1] if there are no trials.
std::pair<double, double> WilsonInterval(std::int64_t successes, std::int64_t trials);

/// Percentile interval of the median (Efron 1979) at 95 % confidence, from `rounds` samples drawn
/// with replacement. Independent of the order of values.
std::pair<double, double> BootstrapMedianInterval(std::vector<double> values, int rounds = 2000);

}  // namespace possibility::experiments
