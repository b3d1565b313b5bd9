#include "models/input/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBuffer = 1u << 20;
constexpr std::string_view kPrefix = ".possibility-";
constexpr std::string_view kSuffix = ".unfinished";

/// Whether `path` still names the file that `descriptor` was opened from.
bool Names(const fs::path& path, int descriptor) {
  struct stat opened = {}, named = {};
  return ::fstat(descriptor, &opened) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         opened.st_dev == named.st_dev && opened.st_ino == named.st_ino;
}

/// Removes an unfinished file unless a writer holds its lock.
void RemoveIfLeft(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 && Names(path, descriptor)) {
    ::unlink(path.c_str());
  }
  ::close(descriptor);
}

void RemoveLeft(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with(kPrefix) && name.ends_with(kSuffix)) RemoveIfLeft(it->path());
  }
}

fs::path FolderOf(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

}  // namespace

AtomicFile::AtomicFile(fs::path file) : file_(std::move(file)) {
  std::error_code error;
  if (fs::is_symlink(file_, error)) {
    if (const fs::path target = fs::weakly_canonical(file_, error); !error) file_ = target;
  }
  const fs::file_status status = fs::status(file_, error);
  if (fs::is_directory(status)) {
    throw InputError(fmt::format("{}: is a folder, expected a file to write", file_.string()));
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) Fail();
    return;
  }
  RemoveLeft(FolderOf(file_));
  OpenUnfinished();
}

AtomicFile::~AtomicFile() {
  if (!unfinished_.empty()) ::unlink(unfinished_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
}

void AtomicFile::OpenUnfinished() {
  for (int i = 0;; ++i) {
    fs::path path = FolderOf(file_) / fmt::format("{}{}-{}{}", kPrefix, ::getpid(), i, kSuffix);
    descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno == EEXIST) continue;
    if (descriptor_ < 0) Fail();
    // Another writer may lock and remove the file first. Without file locks, no writer removes it.
    ::flock(descriptor_, LOCK_EX);
    if (Names(path, descriptor_)) {
      unfinished_ = std::move(path);
      return;
    }
    ::close(descriptor_);
  }
}

void AtomicFile::Fail() const {
  const std::string reason = std::generic_category().message(errno);
  throw InputError(fmt::format(
      "{}: cannot be written ({}), expected a folder that exists, is writable and has space",
      file_.string(), reason));
}

void AtomicFile::Write(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBuffer) Flush();
}

void AtomicFile::Flush() {
  std::size_t written = 0;
  while (written < buffer_.size()) {
    const ssize_t count = ::write(descriptor_, buffer_.data() + written, buffer_.size() - written);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Fail();
    written += static_cast<std::size_t>(count);
  }
  buffer_.clear();
}

void AtomicFile::Commit() {
  Flush();
  // Network file systems report a full disk when a descriptor is closed. The other descriptor holds
  // the lock until the file has its name, so that no writer takes it for a leftover.
  const int copy = ::dup(descriptor_);
  if (copy < 0 || ::close(copy) != 0) Fail();
  if (!unfinished_.empty() && ::rename(unfinished_.c_str(), file_.c_str()) != 0) Fail();
  unfinished_.clear();
}

void WriteAtomically(const fs::path& file, std::string_view text) {
  AtomicFile output(file);
  output.Write(text);
  output.Commit();
}

}  // namespace possibility::models
