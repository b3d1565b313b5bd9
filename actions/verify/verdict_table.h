#pragma once

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "models/world/local_world.h"

namespace possibility::actions {

/// Results of judgements, each kept under everything it depends on: the bytes of its subject, and
/// those of the world within its reach. Equal keys are compared byte for byte, so a result that is
/// found is the one that the judgement would give again. Any thread may use it.
template <typename Result>
class VerdictTable {
 public:
  /// Beyond `most_bytes` of keys it forgets what has not been asked for longest.
  explicit VerdictTable(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// The result for this subject in a world that is the same within the reach it was judged by.
  std::optional<Result> Find(const std::string& subject, const models::LocalWorld& world) {
    const std::lock_guard lock(mutex_);
    const auto is_same = [&](const Entry& entry) {
      return world.Within(entry.reach) == entry.world;
    };
    for (Generation* generation : {&young_, &old_}) {
      const auto place = generation->entries.find(subject);
      if (place == generation->entries.end()) continue;
      const std::vector<Entry>& entries = place->second;
      const auto entry = std::find_if(entries.rbegin(), entries.rend(), is_same);
      if (entry == entries.rend()) continue;
      Result result = entry->result;  // kept: Insert may drop the old generation
      if (generation == &old_) Insert(subject, *entry);
      return result;
    }
    return std::nullopt;
  }

  /// Keeps a result of a judgement that read nothing of `world` beyond `reach`.
  void Add(const std::string& subject, const models::WorldReach& reach,
           const models::LocalWorld& world, const Result& result) {
    Entry entry{reach, world.Within(reach), result};
    const std::lock_guard lock(mutex_);
    Insert(subject, std::move(entry));
  }

 private:
  struct Entry {
    models::WorldReach reach;
    std::string world;
    Result result;
  };

  struct Generation {
    std::unordered_map<std::string, std::vector<Entry>> entries;
    std::size_t bytes = 0;
  };

  void Insert(const std::string& subject, Entry entry) {
    if (young_.bytes > most_bytes_ / 2) old_ = std::exchange(young_, {});
    young_.bytes += subject.size() + entry.world.size() + sizeof(Entry);
    young_.entries[subject].push_back(std::move(entry));
  }

  std::mutex mutex_;
  std::size_t most_bytes_;
  Generation young_;
  Generation old_;
};

}  // namespace possibility::actions
