#include "experiments/recording/film.h"

#include <fmt/format.h>

#include <string>
#include <system_error>

#include "experiments/recording/child_process.h"
#include "experiments/support/output_file.h"
#include "experiments/support/temporary_folder.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

class FolderFilm : public Film {
 public:
  explicit FolderFilm(fs::path folder) : folder_(std::move(folder)) {
    PrepareOutputFolder("--record", folder_);
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("frame_") && entry.path().extension() == ".png") {
        throw InputError(fmt::format("--record: '{}' has {}, expected a folder without frames",
                                     folder_.string(), name));
      }
    }
  }

  void Add(std::string_view png) override {
    WriteOutput(folder_ / fmt::format("frame_{:06}.png", ++count_), png);
  }
  void Finish() override {}

 private:
  fs::path folder_;
  int count_ = 0;
};

/// ffmpeg writes beside nothing that matters: a film that is not complete is no film.
class WebmFilm : public Film {
 public:
  WebmFilm(fs::path file, const fs::path& ffmpeg, int rate)
      : file_(std::move(file)),
        encoder_(
            ffmpeg,
            {"-loglevel", "error", "-f",           "image2pipe", "-framerate", std::to_string(rate),
             "-c:v",      "png",   "-i",           "-",          "-c:v",       "libvpx-vp9",
             "-b:v",      "0",     "-crf",         "30",         "-pix_fmt",   "yuv420p",
             "-f",        "webm",  Made().string()},
            {0}) {}

  void Add(std::string_view png) override { encoder_.Write(png); }

  void Finish() override {
    if (const int code = encoder_.Finish(); code != 0) {
      throw InputError(fmt::format("ffmpeg: exit code {}, expected a film with VP9", code));
    }
    WriteOutput(file_, models::ReadFileContents(Made()));
  }

 private:
  fs::path Made() const { return folder_.path() / "film.webm"; }

  fs::path file_;
  TemporaryFolder folder_;
  ChildProcess encoder_;
};

}  // namespace

std::unique_ptr<Film> MakeFilm(const fs::path& path, int rate) {
  if (path.extension() == ".webm") {
    const auto ffmpeg = FindProgram({"ffmpeg"});
    if (!ffmpeg) {
      throw InputError(
          "ffmpeg: not found on PATH, expected it for .webm (Debian package ffmpeg); a folder "
          "takes "
          "the frames as PNG without it");
    }
    return std::make_unique<WebmFilm>(path, *ffmpeg, rate);
  }
  if (path.has_extension()) {
    throw InputError(fmt::format("--record: '{}', expected a name that ends in .webm, or a folder",
                                 path.string()));
  }
  return std::make_unique<FolderFilm>(path);
}

}  // namespace possibility::experiments
