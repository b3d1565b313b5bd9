#include "experiments/recording/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <sstream>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

constexpr int kAbove = 32;  // descriptors of the new program are below

/// In the new process: gives it its descriptors and starts the program. Never returns.
[[noreturn]] void Become(const char* program, char* const* arguments, int socket,
                         const std::vector<int>& descriptors) {
  const int high = ::fcntl(socket, F_DUPFD, kAbove);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int stream = 0; stream < 3; ++stream) ::dup2(nothing, stream);
  for (const int descriptor : descriptors) ::dup2(high, descriptor);
  ::close(high);
  ::execv(program, arguments);
  ::_exit(127);
}

}  // namespace

std::optional<fs::path> FindProgram(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');) {
      const fs::path candidate = fs::path(folder) / name;
      std::error_code error;
      if (fs::is_regular_file(candidate, error) && ::access(candidate.c_str(), X_OK) == 0) {
        return candidate;
      }
    }
  }
  return std::nullopt;
}

ChildProcess::ChildProcess(const fs::path& program, const std::vector<std::string>& arguments,
                           const std::vector<int>& descriptors)
    : name_(program.filename().string()) {
  std::vector<std::string> words = {program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::array<int, 2> ends = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    Fail("cannot be started");
  }
  socket_ = ends[0];
  process_ = ::fork();
  if (process_ == 0) Become(program.c_str(), pointers.data(), ends[1], descriptors);
  ::close(ends[1]);
  if (process_ < 0) {
    ::close(socket_);
    Fail("cannot be started");
  }
}

ChildProcess::~ChildProcess() {
  ::close(socket_);
  if (process_ < 0) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void ChildProcess::Fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", name_, what));
}

void ChildProcess::Write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) Fail("ended before its work was done");
    bytes.remove_prefix(written);
  }
}

std::string ChildProcess::Read(double seconds) {
  pollfd waited = {socket_, POLLIN, 0};
  if (::poll(&waited, 1, static_cast<int>(1000 * seconds)) == 0) {
    Fail(fmt::format("no answer within {:.0f} s", seconds));
  }
  std::string bytes(1u << 16, '\0');
  const ssize_t count = ::read(socket_, bytes.data(), bytes.size());
  if (count <= 0) Fail("ended before its work was done");
  bytes.resize(count);
  return bytes;
}

int ChildProcess::Finish() {
  ::shutdown(socket_, SHUT_WR);
  int status = 0;
  ::waitpid(process_, &status, 0);
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace possibility::experiments
