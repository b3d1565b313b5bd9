#include "experiments/trials/results_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <utility>

#include "experiments/support/output_file.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

std::string Line(const TrialRecord& record) { return models::JsonText(record.Json()) + '\n'; }

/// Whether `path` still is the file that `descriptor` was opened from.
bool IsFile(const std::filesystem::path& path, int descriptor) {
  struct stat opened = {}, named = {};
  return ::fstat(descriptor, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

}  // namespace

std::vector<TrialRecord> ReadResults(const std::filesystem::path& file,
                                     std::uintmax_t* whole_bytes) {
  const std::string text = models::ReadFileContents(file);
  std::vector<TrialRecord> records;
  std::set<TrialKey> keys;
  std::size_t begin = 0;
  for (int line = 1; begin < text.size(); ++line) {
    const std::size_t end = text.find('\n', begin);
    if (end == std::string::npos) break;
    try {
      records.push_back(TrialRecord::FromJson(
          nlohmann::ordered_json::parse(std::string_view(text).substr(begin, end - begin))));
    } catch (const nlohmann::json::exception& error) {
      if (end + 1 == text.size()) break;
      throw InputError(fmt::format("{}:{}: is not the record of a trial: {}", file.string(), line,
                                   error.what()));
    }
    const TrialKey& key = records.back().key;
    if (!keys.insert(key).second) {
      throw InputError(fmt::format("{}:{}: a second record of row '{}', preset '{}', seed {}",
                                   file.string(), line, key.row, key.preset, key.seed));
    }
    begin = end + 1;
  }
  if (whole_bytes != nullptr) *whole_bytes = begin;
  return records;
}

std::string FormatResults(const std::vector<TrialRecord>& records) {
  std::string text;
  for (const TrialRecord& record : records) text += Line(record);
  return text;
}

ResultsFile::ResultsFile(std::filesystem::path file) : file_(std::move(file)) {
  OpenLocked();
  try {
    std::uintmax_t whole = 0;
    records_ = ReadResults(file_, &whole);
    if (::ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) FailToWrite();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
  for (const TrialRecord& record : records_) keys_.insert(record.key);
}

ResultsFile::~ResultsFile() { ::close(descriptor_); }

void ResultsFile::FailToWrite() const {
  throw InputError(
      fmt::format("{}: cannot be written, expected a folder that exists, is writable and has space",
                  file_.string()));
}

void ResultsFile::OpenLocked() {
  // Repeats if another program replaced the file (Sort) between opening and locking.
  do {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    if (descriptor_ < 0) FailToWrite();
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      const bool is_taken = errno == EWOULDBLOCK;
      ::close(descriptor_);
      if (!is_taken) FailToWrite();
      throw InputError(
          fmt::format("{}: another program writes it, expected a folder for each", file_.string()));
    }
  } while (!IsFile(file_, descriptor_));
}

void ResultsFile::RequireSame(const std::map<std::string, TrialIdentity>& rows) const {
  if (rows.empty()) return;
  const TrialIdentity& any = rows.begin()->second;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const auto& [key, identity] = std::tie(records_[i].key, records_[i].identity);
    const auto row = rows.find(key.row);
    std::string what;
    if (identity.experiment != any.experiment) {
      what =
          fmt::format("another experiment ('{}', not '{}')", identity.experiment, any.experiment);
    } else if (identity.settings_hash != any.settings_hash) {
      what = "other settings (options, motion library or version of the program)";
    } else if (row != rows.end() && identity.scenario_hash != row->second.scenario_hash) {
      what = "another scenario";
    } else if (row != rows.end() && identity.robot_hash != row->second.robot_hash) {
      what = "another robot";
    }
    if (what.empty()) continue;
    throw InputError(fmt::format(
        "{}:{}: row '{}' comes from {}, expected results of this run, or another folder",
        file_.string(), i + 1, key.row, what));
  }
}

void ResultsFile::Append(const TrialRecord& record) {
  const std::string line = Line(record);
  const std::lock_guard lock(mutex_);
  if (has_failed_) FailToWrite();
  has_failed_ = true;  // nothing may follow an incomplete line
  std::size_t written = 0;
  while (written < line.size()) {
    const ssize_t count = ::write(descriptor_, line.data() + written, line.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) FailToWrite();
    written += static_cast<std::size_t>(count);
  }
  if (::fdatasync(descriptor_) != 0) FailToWrite();
  has_failed_ = false;
  records_.push_back(record);
  keys_.insert(record.key);
}

void ResultsFile::Sort(const std::vector<std::string>& row_order) {
  SortRecords(row_order, &records_);
  WriteOutput(file_, FormatResults(records_));
}

}  // namespace possibility::experiments
