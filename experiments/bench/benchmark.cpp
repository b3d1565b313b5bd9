#include "experiments/bench/benchmark.h"

#include <fmt/format.h>

#include <algorithm>
#include <barrier>
#include <stdexcept>
#include <thread>

#include "common/stopwatch.h"

namespace possibility::experiments {
namespace {

double TimeCalls(const std::function<void(int)>& call, int calls) {
  const Stopwatch stopwatch;
  for (int i = 0; i < calls; ++i) call(i);
  return stopwatch.Seconds();
}

/// Number of calls that take about `seconds`.
int CallsFor(const std::function<void(int)>& call, double seconds) {
  int calls = 1;
  double taken = TimeCalls(call, calls);
  while (taken < seconds / 10) {
    calls *= 2;
    taken = TimeCalls(call, calls);
  }
  return std::max(1, static_cast<int>(calls * seconds / taken));
}

double TimeTwoThreads(const std::function<std::function<void(int)>()>& worker, int calls) {
  std::barrier start(3);
  std::barrier end(3);
  const auto work = [&] {
    const auto call = worker();
    start.arrive_and_wait();
    for (int i = 0; i < calls; ++i) call(i);
    end.arrive_and_wait();
  };
  std::jthread first(work);
  std::jthread second(work);
  start.arrive_and_wait();
  const Stopwatch stopwatch;
  end.arrive_and_wait();
  return stopwatch.Seconds();
}

}  // namespace

std::vector<BenchmarkRow> TimeInTurn(const std::vector<BenchmarkCase>& cases, int rounds,
                                     double seconds_per_batch,
                                     const std::function<void(int, int)>& progress) {
  std::vector<BenchmarkRow> rows;
  std::vector<int> calls;
  for (const BenchmarkCase& c : cases) {
    rows.push_back({c.name, 0, {}, {}});
    calls.push_back(CallsFor(c.call, seconds_per_batch));
  }
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      rows[i].rounds.push_back(TimeCalls(cases[i].call, calls[i]) / calls[i] * 1e6);
    }
    progress(round + 1, rounds);
  }
  for (BenchmarkRow& row : rows) row.microseconds = Median(row.rounds);
  return rows;
}

double TwoThreadThroughput(const std::function<std::function<void(int)>()>& worker, int calls,
                           int rounds) {
  std::vector<double> ratios;
  const auto alone = worker();
  for (int round = 0; round < rounds; ++round) {
    const double one = TimeCalls(alone, calls);
    ratios.push_back(2 * one / TimeTwoThreads(worker, calls));
  }
  return Median(ratios);
}

double BenchmarkReport::Ratio(const std::string& slow, const std::string& fast) const {
  const auto rounds = [this](const std::string& name) -> const std::vector<double>& {
    for (const BenchmarkRow& row : rows) {
      if (row.name == name) return row.rounds;
    }
    throw std::invalid_argument("BenchmarkReport: no row named " + name);
  };
  const std::vector<double>& numerators = rounds(slow);
  const std::vector<double>& denominators = rounds(fast);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < numerators.size(); ++i) {
    ratios.push_back(numerators[i] / denominators[i]);
  }
  return Median(ratios);
}

nlohmann::ordered_json BenchmarkReport::Json() const {
  nlohmann::ordered_json json;
  json["rows"] = nlohmann::ordered_json::array();
  for (const BenchmarkRow& row : rows) {
    nlohmann::ordered_json& added = json["rows"].emplace_back();
    added = {{"name", row.name}, {"microseconds", row.microseconds}};
    for (const auto& [name, value] : row.figures) added[name] = value;
  }
  json["ratios"] = nlohmann::ordered_json::object();
  for (const BenchmarkRatio& ratio : ratios) json["ratios"][ratio.name] = ratio.value;
  for (const auto& [name, value] : figures) json[name] = value;
  for (const auto& [group, values] : groups) {
    for (const auto& [name, value] : values) json[group][name] = value;
  }
  return json;
}

std::string BenchmarkReport::Text() const {
  std::string text;
  for (const BenchmarkRow& row : rows) {
    text += fmt::format("{:<58}{:>10.2f} us", row.name, row.microseconds);
    for (const auto& [name, value] : row.figures) text += fmt::format("  {} {:.4g}", name, value);
    text += "\n";
  }
  for (const BenchmarkRatio& ratio : ratios) {
    text += fmt::format("{:<28}{:>8.2f}   {}\n", ratio.name, ratio.value, ratio.meaning);
  }
  for (const auto& [group, values] : groups) {
    text += group + ":";
    for (const auto& [name, value] : values) text += fmt::format("  {} {:.4g}", name, value);
    text += "\n";
  }
  return text;
}

}  // namespace possibility::experiments
