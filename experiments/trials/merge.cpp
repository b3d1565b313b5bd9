#include "experiments/trials/merge.h"

#include <fmt/format.h>

#include <map>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using Part = std::pair<std::filesystem::path, std::vector<TrialRecord>>;

[[noreturn]] void Fail(const std::filesystem::path& file, const TrialRecord& record,
                       const std::string& what, const std::filesystem::path& other) {
  throw InputError(fmt::format("{}: row '{}', preset '{}', seed {}: {} than in {}", file.string(),
                               record.key.row, record.key.preset, record.key.seed, what,
                               other.string()));
}

/// A record and its file.
using Origin = std::pair<const TrialRecord*, const std::filesystem::path*>;

void RequireSame(const TrialRecord& record, const std::filesystem::path& file, const Origin& first,
                 const Origin& first_of_row) {
  const TrialIdentity& any = first.first->identity;
  const TrialIdentity& of_row = first_of_row.first->identity;
  if (record.identity.experiment != any.experiment ||
      record.identity.settings_hash != any.settings_hash) {
    Fail(file, record, "another experiment or other settings", *first.second);
  }
  if (record.identity.scenario_hash != of_row.scenario_hash ||
      record.identity.robot_hash != of_row.robot_hash) {
    Fail(file, record, "another scenario or robot", *first_of_row.second);
  }
}

}  // namespace

std::vector<TrialRecord> MergeRecords(const std::vector<Part>& parts) {
  std::map<TrialKey, Origin> trials;
  std::map<std::string, Origin> rows;
  Origin first{};
  std::vector<TrialRecord> merged;
  for (const auto& [file, records] : parts) {
    for (const TrialRecord& record : records) {
      const Origin here{&record, &file};
      if (first.first == nullptr) first = here;
      RequireSame(record, file, first, rows.emplace(record.key.row, here).first->second);
      const auto [known, is_new] = trials.emplace(record.key, here);
      if (is_new) {
        merged.push_back(record);
      } else if (!SameButTimings(record, *known->second.first)) {
        Fail(file, record, "another outcome", *known->second.second);
      }
    }
  }
  return merged;
}

}  // namespace possibility::experiments
