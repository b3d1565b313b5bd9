#include "experiments/support/run_environment.h"

#include <coin/IpoptConfig.h>
#include <fmt/format.h>

#include <fstream>

#include "experiments/support/hardware_threads.h"

// Defined by the build system; unknown in other builds.
#ifndef POSSIBILITY_VERSION
#define POSSIBILITY_VERSION "unknown"
#endif
#ifndef POSSIBILITY_BUILD_TYPE
#define POSSIBILITY_BUILD_TYPE "unknown"
#endif

namespace possibility::experiments {
namespace {

std::string Compiler() {
#if defined(__clang__)
  return fmt::format("Clang {}.{}.{}", __clang_major__, __clang_minor__, __clang_patchlevel__);
#else
  return fmt::format("GCC {}.{}.{}", __GNUC__, __GNUC_MINOR__, __GNUC_PATCHLEVEL__);
#endif
}

/// Name of the first processor that the kernel lists with one.
std::string Cpu() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t begin = line.find_first_not_of(" \t:", line.find(':'));
    if (begin != std::string::npos) return line.substr(begin);
  }
  return "unknown";
}

}  // namespace

RunEnvironment ThisEnvironment() {
  return {Compiler(),          POSSIBILITY_BUILD_TYPE, Cpu(),
          POSSIBILITY_VERSION, IPOPT_VERSION,          HardwareThreads()};
}

nlohmann::ordered_json RunEnvironment::Json() const {
  return {{"compiler", compiler}, {"build_type", build_type},
          {"cpu", cpu},           {"possibility", possibility},
          {"ipopt", ipopt},       {"hardware_threads", hardware_threads},
          {"threads", 1}};  // problems are solved one after another
}

}  // namespace possibility::experiments
