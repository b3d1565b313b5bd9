#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "experiments/trials/trial_record.h"

namespace possibility::experiments {

/// Reads the records of a results file, one JSON object per line. Omits an incomplete last line
/// (its writer was killed); `whole_bytes`, if given, is set to its beginning.
/// @throws InputError naming file and line for any other damage, and for two records of one trial.
std::vector<TrialRecord> ReadResults(const std::filesystem::path& file,
                                     std::uintmax_t* whole_bytes = nullptr);

/// All records as the lines of a file.
std::string FormatResults(const std::vector<TrialRecord>& records);

/// A results file to which trials are appended as they end. Locked against other writers.
class ResultsFile {
 public:
  /// Opens or creates the file; removes an incomplete last line.
  /// @throws InputError if it cannot be written, is damaged, or another program writes it.
  explicit ResultsFile(std::filesystem::path file);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  const std::filesystem::path& file() const { return file_; }
  /// Records in the file.
  const std::vector<TrialRecord>& records() const { return records_; }
  bool Contains(const TrialKey& key) const { return keys_.count(key) > 0; }

  /// Refuses a file of another experiment: all records must have the experiment and settings of
  /// `rows`; records of a row in `rows` also its scenario and robot.
  /// @throws InputError naming the line and what differs.
  void RequireSame(const std::map<std::string, TrialIdentity>& rows) const;

  /// Appends a line; it is on the disk when this returns. Safe to call from any thread.
  /// @throws InputError if it cannot be written.
  void Append(const TrialRecord& record);

  /// Replaces the file by the same records in order (SortRecords).
  void Sort(const std::vector<std::string>& row_order);

 private:
  void OpenLocked();
  [[noreturn]] void FailToWrite() const;

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::vector<TrialRecord> records_;
  std::set<TrialKey> keys_;
  std::mutex mutex_;  ///< for appending
  bool has_failed_ = false;
};

}  // namespace possibility::experiments
