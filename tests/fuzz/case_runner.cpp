#include "tests/fuzz/case_runner.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <new>
#include <stdexcept>

#include "models/input/input_error.h"

namespace possibility::fuzz {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kSlowdown = 8;
constexpr bool kLimitsMemory = false;  // the sanitizers' shadow takes terabytes of address space
#else
constexpr double kSlowdown = 1;
constexpr bool kLimitsMemory = true;
#endif
constexpr rlim_t kMemory = rlim_t{4} << 30;
constexpr std::size_t kMostFailures = 20;

/// Memory that the processes share.
struct Progress {
  std::atomic<std::uint64_t> seed;
  std::atomic<int> refused;
  std::atomic<int> used;
  char failure[2000];  ///< of the case at `seed`
};

class SharedProgress {
 public:
  SharedProgress() {
    void* memory = ::mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE,
                          MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    progress_ = new (memory) Progress();
  }
  ~SharedProgress() { ::munmap(progress_, sizeof(Progress)); }
  SharedProgress(const SharedProgress&) = delete;
  SharedProgress& operator=(const SharedProgress&) = delete;
  Progress* operator->() const { return progress_; }

 private:
  Progress* progress_ = nullptr;
};

/// SIGPROF ends the process when its time is up.
void LimitProcessorTime(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  const itimerval timer = {{0, 0}, {whole, static_cast<suseconds_t>(1e6 * (seconds - whole))}};
  ::setitimer(ITIMER_PROF, &timer, nullptr);
}

void LimitMemory() {
  const rlimit memory = {kMemory, kMemory};
  if (kLimitsMemory) ::setrlimit(RLIMIT_AS, &memory);
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

bool IsOneLine(std::string_view message) {
  return !message.empty() && message.find_first_of(std::string_view("\n\0", 2)) == message.npos;
}

[[noreturn]] void ExitWith(const SharedProgress& progress, const std::string& failure) {
  failure.copy(progress->failure, sizeof progress->failure - 1);
  ::_exit(1);
}

/// Runs in the child process.
[[noreturn]] void UseAll(const Subject& subject, std::uint64_t end,
                         const SharedProgress& progress) {
  LimitMemory();
  for (; progress->seed < end; ++progress->seed) {
    const std::string text = SpoiltText(subject, progress->seed);
    LimitProcessorTime(kSlowdown * subject.limit_s);
    try {
      subject.use(progress->seed, text);
      ++progress->used;
    } catch (const InputError& error) {
      if (!IsOneLine(error.what())) {
        ExitWith(progress, fmt::format("a message that is not one line: {}", error.what()));
      }
      ++progress->refused;
    } catch (const std::exception& error) {
      ExitWith(progress, fmt::format("another exception: {}", error.what()));
    }
  }
  ::_exit(0);
}

std::string HowItEnded(int status, const Progress& progress) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) return "too much processor time";
  if (WIFSIGNALED(status)) return fmt::format("signal {}", WTERMSIG(status));
  if (progress.failure[0] != '\0') return progress.failure;
  return fmt::format("exit code {}: a sanitizer's finding?", WEXITSTATUS(status));
}

}  // namespace

std::string SpoiltText(const Subject& subject, std::uint64_t seed) {
  return Mutator(subject.syntax, seed)(subject.text(seed));
}

std::filesystem::path KeepFailure(const std::string& name, std::uint64_t seed,
                                  const std::string& extension, const std::string& text) {
  const std::filesystem::path folder =
      std::filesystem::path(POSSIBILITY_BINARY_DIR) / "fuzz_failures";
  std::filesystem::create_directories(folder);
  const std::filesystem::path file = folder / fmt::format("{}_{}{}", name, seed, extension);
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

Findings FindFailures(const Subject& subject, std::uint64_t first_seed, int count) {
  const SharedProgress progress;
  const std::uint64_t end = first_seed + count;
  progress->seed = first_seed;
  Findings findings;
  while (progress->seed < end && findings.failures.size() < kMostFailures) {
    progress->failure[0] = '\0';
    const pid_t child = ::fork();
    if (child < 0) throw std::runtime_error("no process can be started");
    if (child == 0) UseAll(subject, end, progress);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) break;
    const std::uint64_t seed = progress->seed++;
    findings.failures.push_back({seed, HowItEnded(status, *progress.operator->())});
  }
  findings.used = progress->used;
  findings.refused = progress->refused;
  return findings;
}

void RunCases(const Subject& subject, std::uint64_t first_seed, int count) {
  const Findings findings = FindFailures(subject, first_seed, count);
  for (const Finding& failure : findings.failures) {
    ADD_FAILURE() << subject.name << ", seed " << failure.seed << ": " << failure.what << "\n"
                  << KeepFailure(subject.name, failure.seed, subject.extension,
                                 SpoiltText(subject, failure.seed));
  }
  // If all texts were refused, or most of them stayed whole, the test would show nothing.
  EXPECT_GT(findings.used, 0) << subject.name;
  EXPECT_GT(findings.refused, count / 4) << subject.name;
  fmt::print("{}: {} used, {} refused\n", subject.name, findings.used, findings.refused);
}

}  // namespace possibility::fuzz
