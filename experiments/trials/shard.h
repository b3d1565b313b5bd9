#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace possibility::experiments {

/// One of `count` parts of an experiment, each for another machine: the trials whose index leaves
/// the remainder `index`.
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

/// The shard of this task of a Slurm job array, counted from the array's first; the whole
/// experiment if there is none.
/// @throws InputError if the variables contradict each other or the array has holes.
Shard ShardOfSlurmTask(const Environment& environment);

}  // namespace possibility::experiments
