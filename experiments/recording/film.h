#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

namespace possibility::experiments {

/// Where the pictures of a recording go, in their order.
class Film {
 public:
  virtual ~Film() = default;

  /// `png`: one picture; all have the same size.
  virtual void Add(std::string_view png) = 0;
  /// Call once, as the last step.
  virtual void Finish() = 0;
};

/// frame_000001.png, frame_000002.png and so on in a folder, which is made if necessary; or, if the
/// name ends in .webm, a VP9 film made by ffmpeg with `rate` pictures a second.
/// @throws InputError naming --record if the folder has such files already or cannot be written, if
/// the name has another ending, or if ffmpeg is not found on PATH.
std::unique_ptr<Film> MakeFilm(const std::filesystem::path& path, int rate);

}  // namespace possibility::experiments
