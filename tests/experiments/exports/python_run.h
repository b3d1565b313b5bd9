#pragma once

#include <sys/wait.h>

#include <cstdio>
#include <string>

namespace possibility::experiments::testing {

struct PythonRun {
  int code = -1;
  std::string out;  ///< both streams
};

/// Runs Debian's Python with a script that holds no single quotes.
inline PythonRun RunPython(const std::string& script) {
  PythonRun run;
  FILE* pipe = ::popen(("/usr/bin/python3 -B -c '" + script + "' 2>&1").c_str(), "r");
  if (pipe == nullptr) return run;
  char buffer[4096];
  for (std::size_t n; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;) {
    run.out.append(buffer, n);
  }
  const int status = ::pclose(pipe);
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return run;
}

/// Whether that Python has NumPy (python3-numpy).
inline bool HasNumpy() { return RunPython("import numpy").code == 0; }

}  // namespace possibility::experiments::testing
