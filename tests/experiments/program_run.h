#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/experiments/read_text.h"

namespace possibility::experiments::testing {

/// A test that runs the built program in a folder of its own, outside of Slurm.
class ProgramRun : public ::testing::Test {
 protected:
  struct Outcome {
    int code = -1;  ///< -1: killed
    std::string out;
    std::string err;
  };

  void SetUp() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// `arguments` are words for the shell. The program replaces the shell, so killing the process
  /// kills the program. `before` are commands for the shell.
  pid_t Start(const std::string& arguments, const std::string& before = "",
              const std::string& streams = ">stdout.txt 2>stderr.txt") const {
    const std::string command =
        before + " exec '" POSSIBILITY_PROGRAM "' " + arguments + " " + streams;
    const pid_t child = ::fork();
    if (child != 0) return child;
    for (const char* name : {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT"}) ::unsetenv(name);
    if (::chdir(folder_.c_str()) == 0) {
      ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    }
    ::_exit(99);
  }

  /// Exit code, or -1 if it was killed.
  static int Wait(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  Outcome Run(const std::string& arguments) const {
    const int code = Wait(Start(arguments));
    return {code, Output(), Errors()};
  }

  /// Runs with invalid input. Expects exit code 1, nothing on stdout and one line on stderr, which
  /// is returned.
  std::string ExpectRefused(const std::string& arguments) const {
    const Outcome outcome = Run(arguments);
    EXPECT_EQ(outcome.code, 1) << arguments << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_GT(outcome.err.size(), 10u) << arguments;
    return outcome.err;
  }

  /// Of the last run.
  std::string Output() const { return ReadText(folder_ / "stdout.txt"); }
  std::string Errors() const { return ReadText(folder_ / "stderr.txt"); }

  const std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                        ("possibility_program_" + std::to_string(::getpid()));
};

}  // namespace possibility::experiments::testing
