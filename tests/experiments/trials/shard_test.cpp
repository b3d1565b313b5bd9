#include "experiments/trials/shard.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

Shard Slurm(const std::map<std::string, std::string>& variables) {
  return ShardOfSlurmTask([&](const char* name) -> const char* {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

TEST(Shard, EachTrialIsInExactlyOneShard) {
  for (int count = 1; count < 12; ++count) {
    for (std::size_t trial = 0; trial < 100; ++trial) {
      int holders = 0;
      for (int k = 0; k < count; ++k) holders += Shard{k, count}.Has(trial) ? 1 : 0;
      EXPECT_EQ(holders, 1);
    }
  }
}

TEST(Shard, ParsesPartsFromZero) {
  const Shard shard = ParseShard("--shard", "2/3");
  EXPECT_EQ(shard.index, 2);
  EXPECT_EQ(shard.count, 3);
  for (const char* bad :
       {"", "1", "/", "3/3", "-1/3", "1/0", "0/0", "1/3/4", "a/b", "1/ 3", "0/100001"}) {
    EXPECT_THROW(ParseShard("--shard", bad), InputError) << bad;
  }
}

TEST(Shard, IsReadFromASlurmArrayOfAnyFirstIndex) {
  EXPECT_EQ(Slurm({}).count, 1);
  EXPECT_EQ(Slurm({{"SLURM_ARRAY_TASK_ID", "4"}}).count, 1);
  for (const int first : {0, 1, 10}) {
    for (int k = 0; k < 4; ++k) {
      const Shard shard = Slurm({{"SLURM_ARRAY_TASK_ID", std::to_string(first + k)},
                                 {"SLURM_ARRAY_TASK_COUNT", "4"},
                                 {"SLURM_ARRAY_TASK_MIN", std::to_string(first)},
                                 {"SLURM_ARRAY_TASK_MAX", std::to_string(first + 3)}});
      EXPECT_EQ(shard.index, k);
      EXPECT_EQ(shard.count, 4);
    }
  }
  EXPECT_EQ(Slurm({{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_COUNT", "3"}}).index, 2);
}

TEST(Shard, AnArrayWithHolesIsRefused) {
  EXPECT_THROW(Slurm({{"SLURM_ARRAY_TASK_ID", "7"},
                      {"SLURM_ARRAY_TASK_COUNT", "2"},
                      {"SLURM_ARRAY_TASK_MIN", "3"},
                      {"SLURM_ARRAY_TASK_MAX", "7"}}),
               InputError);
  EXPECT_THROW(Slurm({{"SLURM_ARRAY_TASK_ID", "7"}, {"SLURM_ARRAY_TASK_COUNT", "2"}}), InputError);
  EXPECT_THROW(Slurm({{"SLURM_ARRAY_TASK_ID", "x"}, {"SLURM_ARRAY_TASK_COUNT", "2"}}), InputError);
}

}  // namespace
}  // namespace possibility::experiments
