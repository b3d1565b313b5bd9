#include "experiments/service/watched_file.h"

#include <sys/stat.h>

#include <chrono>
#include <thread>
#include <utility>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr double kLookEvery = 0.02;  // s

}  // namespace

WatchedFile::WatchedFile(std::filesystem::path file) : file_(std::move(file)) { Accept(); }

std::optional<WatchedFile::Stamp> WatchedFile::StampOf(const std::filesystem::path& file) {
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
  return Stamp{status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
               status.st_mtim.tv_nsec};
}

/// Empty if the file cannot be read: whoever reads it says why.
std::string WatchedFile::HashOf(const std::filesystem::path& file) {
  try {
    return models::ContentHash(models::ReadFileContents(file));
  } catch (const InputError&) {
    return {};
  }
}

void WatchedFile::Accept() {
  const std::lock_guard lock(mutex_);
  known_ = settled_ = StampOf(file_);
  known_hash_ = HashOf(file_);
  has_changed_ = false;
}

bool WatchedFile::HasChanged() {
  const std::lock_guard lock(mutex_);
  if (has_changed_ || clock_.Seconds() - last_look_ < kLookEvery) return has_changed_;
  last_look_ = clock_.Seconds();
  has_changed_ = Look();
  return has_changed_;
}

bool WatchedFile::Look() {
  const std::optional<Stamp> now = StampOf(file_);
  const bool is_settled = now == std::exchange(settled_, now);
  if (!now || !is_settled || now == known_) return false;
  known_ = now;
  return HashOf(file_) != known_hash_;
}

void WatchedFile::AwaitChange() {
  while (!HasChanged()) std::this_thread::sleep_for(std::chrono::duration<double>(kLookEvery));
}

}  // namespace possibility::experiments
