// A file is complete or absent. The next writer removes what killed writers left.

#include "models/input/atomic_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <thread>
#include <vector>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "tests/models/temporary_folder.h"

namespace possibility::models {
namespace {

namespace fs = std::filesystem;

std::ptrdiff_t FilesIn(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

/// A process that has begun to write `file` when this returns.
pid_t StartWriter(const fs::path& file) {
  int ready[2];
  if (::pipe(ready) != 0) return -1;
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile output(file);
    output.Write("half of it");
    if (::write(ready[1], "r", 1) == 1) ::pause();
    ::_exit(1);
  }
  char byte = 0;
  EXPECT_EQ(::read(ready[0], &byte, 1), 1);
  ::close(ready[0]);
  ::close(ready[1]);
  return child;
}

void Kill(pid_t child) {
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

TEST(AtomicFile, ReplacesTheFileOnlyOnCommit) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("a.txt", "old");
  {
    AtomicFile output(file);
    output.Write("new ");
    output.Write("content");
    EXPECT_EQ(ReadFileContents(file), "old");
    output.Commit();
  }
  EXPECT_EQ(ReadFileContents(file), "new content");
  EXPECT_EQ(FilesIn(folder.path()), 1);
}

TEST(AtomicFile, WithoutCommitNothingChanges) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("a.txt", "old");
  AtomicFile(file).Write(std::string(3 << 20, 'x'));
  EXPECT_EQ(ReadFileContents(file), "old");
  EXPECT_EQ(FilesIn(folder.path()), 1);
}

TEST(AtomicFile, RemovesTemporaryFilesOfKilledWriters) {
  const TemporaryFolder folder;
  std::vector<pid_t> writers;
  for (const char* name : {"a.txt", "b.txt", "c.txt"}) {
    writers.push_back(StartWriter(folder.path() / name));
  }
  for (const pid_t writer : writers) Kill(writer);
  EXPECT_EQ(FilesIn(folder.path()), 3);
  WriteAtomically(folder.path() / "d.txt", "whole");
  EXPECT_EQ(FilesIn(folder.path()), 1);
  EXPECT_EQ(ReadFileContents(folder.path() / "d.txt"), "whole");
}

TEST(AtomicFile, KeepsTemporaryFilesOfRunningWriters) {
  const TemporaryFolder folder;
  const pid_t other = StartWriter(folder.path() / "a.txt");
  WriteAtomically(folder.path() / "a.txt", "whole");
  EXPECT_EQ(FilesIn(folder.path()), 2);
  EXPECT_EQ(ReadFileContents(folder.path() / "a.txt"), "whole");
  Kill(other);
}

TEST(AtomicFile, WritersOfOneFileDoNotDisturbEachOther) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.txt";
  std::vector<std::jthread> writers;
  for (char c = 'a'; c < 'e'; ++c) {
    writers.emplace_back([&, c] {
      for (int i = 0; i < 100; ++i) WriteAtomically(file, std::string(10000, c));
    });
  }
  writers.clear();
  const std::string content = ReadFileContents(file);
  EXPECT_EQ(content, std::string(10000, content.at(0)));
  EXPECT_EQ(FilesIn(folder.path()), 1);
}

TEST(AtomicFile, RefusesAFolderAndAMissingFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(AtomicFile(folder.path()), InputError);
  EXPECT_THROW(AtomicFile(folder.path() / "missing" / "a.txt"), InputError);
  EXPECT_EQ(FilesIn(folder.path()), 0);
}

TEST(AtomicFile, AFullDeviceIsAnError) {
  AtomicFile output("/dev/full");
  output.Write("text");
  EXPECT_THROW(output.Commit(), InputError);
  AtomicFile large("/dev/full");
  EXPECT_THROW(large.Write(std::string(3 << 20, 'x')), InputError);
}

TEST(AtomicFile, DevicesStayDevices) {
  WriteAtomically("/dev/null", "text");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, LinksStayLinks) {
  const TemporaryFolder folder;
  const fs::path file = folder.Write("a.txt", "old");
  fs::create_symlink("a.txt", folder.path() / "link");
  WriteAtomically(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(ReadFileContents(file), "new");
}

TEST(AtomicFile, PermissionsAreThoseOfTheProcess) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.txt";
  const mode_t mask = ::umask(027);
  WriteAtomically(file, "text");
  ::umask(mask);
  EXPECT_EQ(fs::status(file).permissions(), fs::perms(0640));
}

}  // namespace
}  // namespace possibility::models
