#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace possibility::experiments {

/// One of `count` parts of an experiment, for distribution over machines: the trials whose index
/// modulo `count` is `index`.
struct Shard {
  int index = 0;
  int count = 1;

  bool Has(std::size_t trial) const {
    return trial % static_cast<std::size_t>(count) == static_cast<std::size_t>(index);
  }
};

inline constexpr int kMaxShards = 100000;

/// "k/n", 0 <= k < n.
/// @throws InputError naming the option for anything else.
Shard ParseShard(const std::string& option, const std::string& text);

/// The value of an environment variable, null if it is not set (std::getenv).
using Environment = std::function<const char*(const char*)>;

/// The shard of this task in a Slurm job array, counted from the array's first task; the whole
/// experiment if there is no array.
/// @throws InputError if the variables contradict each other or the array has holes.
Shard ShardOfSlurmTask(const Environment& environment);

}  // namespace possibility::experiments
