#include "experiments/trials/shard.h"

#include <fmt/format.h>

#include "experiments/support/option_values.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr std::uint64_t kMaxTask = 1000000000;

/// The variable as an integer, or `otherwise` if it is not set.
std::uint64_t Integer(const Environment& environment, const char* name, std::uint64_t otherwise,
                      std::uint64_t least) {
  const char* text = environment(name);
  return text == nullptr ? otherwise : ParseInteger(name, text, least, kMaxTask);
}

}  // namespace

Shard ParseShard(const std::string& option, const std::string& text) {
  const std::size_t slash = text.find('/');
  try {
    if (slash == std::string::npos) throw InputError("");
    const std::uint64_t count = ParseInteger(option, text.substr(slash + 1), 1, kMaxShards);
    const std::uint64_t index = ParseInteger(option, text.substr(0, slash), 0, count - 1);
    return {static_cast<int>(index), static_cast<int>(count)};
  } catch (const InputError&) {
    throw InputError(fmt::format(
        "{}: '{}' is not valid, expected k/n, the part k of n, from 0/n to n-1/n, n at most {}",
        option, text, kMaxShards));
  }
}

Shard ShardOfSlurmTask(const Environment& environment) {
  if (environment("SLURM_ARRAY_TASK_ID") == nullptr ||
      environment("SLURM_ARRAY_TASK_COUNT") == nullptr) {
    return {};
  }
  const std::uint64_t id = Integer(environment, "SLURM_ARRAY_TASK_ID", 0, 0);
  const std::uint64_t count = Integer(environment, "SLURM_ARRAY_TASK_COUNT", 1, 1);
  const std::uint64_t first = Integer(environment, "SLURM_ARRAY_TASK_MIN", 0, 0);
  const std::uint64_t last = Integer(environment, "SLURM_ARRAY_TASK_MAX", first + count - 1, 0);
  if (count > kMaxShards || id < first || id > last || last - first + 1 != count) {
    throw InputError(fmt::format(
        "SLURM_ARRAY_TASK_ID: {} of {} tasks from {} to {} is no part of an array without holes "
        "of at most {}, expected such an array or --shard k/n",
        id, count, first, last, kMaxShards));
  }
  return {static_cast<int>(id - first), static_cast<int>(count)};
}

}  // namespace possibility::experiments
