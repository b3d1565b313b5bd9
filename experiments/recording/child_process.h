#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace possibility::experiments {

/// The first of these programs that is in a folder of PATH.
std::optional<std::filesystem::path> FindProgram(const std::vector<std::string>& names);

/// Another program, connected by a socket. Its standard streams lead nowhere, unless they are that
/// socket. The destructor ends it.
class ChildProcess {
 public:
  /// `descriptors`: the file descriptors at which the program finds the socket.
  /// @throws InputError naming the program if it cannot be started.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::vector<int>& descriptors);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// @throws InputError naming the program if it has ended.
  void Write(std::string_view bytes);
  /// What has come, at least one byte. @throws InputError naming the program if it has ended or
  /// says nothing for `seconds`.
  std::string Read(double seconds);
  /// Lets it see the end of what was written, and waits. Returns its exit code, -1 if it was
  /// killed.
  int Finish();

 private:
  [[noreturn]] void Fail(const std::string& what) const;

  std::string name_;
  int socket_ = -1;
  pid_t process_ = -1;
};

}  // namespace possibility::experiments
