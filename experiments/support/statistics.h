#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace possibility::experiments {

/// Of a sample of numbers. All functions but where said otherwise: std::invalid_argument if the
/// sample is empty.

double Mean(const std::vector<double>& values);
/// Root of the unbiased variance (divided by n - 1); 0 for one value.
double SampleStd(const std::vector<double>& values);
/// The middle value; the mean of the two in the middle of an even number.
double Median(std::vector<double> values);
/// By nearest rank: the smallest value that at least `percent` per cent of the sample do not
/// exceed, so one that was measured. `percent` within (0, 100].
double Percentile(std::vector<double> values, double percent);

struct SampleSummary {
  double mean = 0;
  double std = 0;
  double median = 0;
  double p95 = 0;
  double max = 0;
};
SampleSummary Summarise(const std::vector<double>& values);

/// Wilson's score interval (Wilson 1927) of a probability, of which `successes` of `trials` came
/// out, at 95 % confidence. [0, 1] if there are no trials.
std::pair<double, double> WilsonInterval(std::int64_t successes, std::int64_t trials);

/// Percentile interval of the median (Efron 1979) at 95 % confidence, from `rounds` samples drawn
/// anew with replacement. The same values, in whatever order, give the same interval.
std::pair<double, double> BootstrapMedianInterval(std::vector<double> values, int rounds = 2000);

}  // namespace possibility::experiments
