#include "actions/motion/motion_folder.h"

#include <gtest/gtest.h>

#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

namespace fs = std::filesystem;

TEST(MotionFolder, IsNamedAfterTheIdentity) {
  EXPECT_EQ(MotionFolder("library", "0123456789abcdef0123"), fs::path("library/0123456789abcdef"));
  EXPECT_TRUE(MotionFolder("", "0123456789abcdef0123").empty());
}

TEST(MotionFolder, FilesOfAllIdentitiesAreFoundInOrder) {
  const models::TemporaryFolder library;
  for (const char* identity : {"b", "a", "c", "d"})
    fs::create_directories(library.path() / identity);
  for (const char* file : {"b/step.json", "a/step.json", "c/jump.json", "step.json"}) {
    library.Write(file, "{}");
  }
  fs::create_directories(library.path() / "d" / "step.json");
  const std::vector<fs::path> files = FilesOfIdentities(library.path(), "step.json");
  EXPECT_EQ(files, (std::vector<fs::path>{library.path() / "a/step.json",
                                          library.path() / "b/step.json"}));
}

TEST(MotionFolder, NoLibraryHasNoFiles) {
  EXPECT_TRUE(FilesOfIdentities("", "step.json").empty());
  EXPECT_TRUE(FilesOfIdentities("/nowhere/at/all", "step.json").empty());
}

}  // namespace
}  // namespace possibility::actions
