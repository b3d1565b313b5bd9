#include "experiments/service/watched_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

class WatchedFileTest : public ::testing::Test {
 protected:
  void SetUp() override { Write(file_, "one"); }
  void TearDown() override {
    fs::remove(file_);
    fs::remove(other_);
  }

  static void Write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

  /// Whether a change is seen within the time of several looks.
  static bool Sees(WatchedFile* watched) {
    for (int i = 0; i < 10; ++i) {
      if (watched->HasChanged()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(15));
    }
    return false;
  }

  const fs::path file_ =
      fs::temp_directory_path() / ("possibility_watched_" + std::to_string(::getpid()));
  const fs::path other_ = file_.string() + ".new";
};

TEST_F(WatchedFileTest, SeesOtherBytes) {
  WatchedFile watched(file_);
  EXPECT_FALSE(Sees(&watched));
  Write(file_, "two");
  EXPECT_TRUE(Sees(&watched));
  EXPECT_TRUE(watched.HasChanged()) << "until they are accepted";
  watched.Accept();
  EXPECT_FALSE(Sees(&watched));
}

TEST_F(WatchedFileTest, SeesAFileRenamedOverIt) {
  WatchedFile watched(file_);
  Write(other_, "two");
  fs::rename(other_, file_);
  EXPECT_TRUE(Sees(&watched));
}

TEST_F(WatchedFileTest, TheSameBytesAreNoChange) {
  WatchedFile watched(file_);
  Write(other_, "one");
  fs::rename(other_, file_);
  EXPECT_FALSE(Sees(&watched));
}

TEST_F(WatchedFileTest, AFileThatIsGoneHasNotChangedUntilItIsBack) {
  WatchedFile watched(file_);
  fs::remove(file_);
  EXPECT_FALSE(Sees(&watched));
  Write(file_, "two");
  EXPECT_TRUE(Sees(&watched));
}

}  // namespace
}  // namespace possibility::experiments
