#include "experiments/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>
#include <system_error>

#include "models/input_error.h"

namespace possibility::experiments {

void WriteOutput(const std::filesystem::path& file, std::string_view content) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) {
    throw InputError(fmt::format("{}: is a folder, expected a file to write", file.string()));
  }
  // A name of its own: two programs that write the same file must not mix their halves.
  std::filesystem::path unfinished = file;
  unfinished += fmt::format(".{}.unfinished", ::getpid());
  std::ofstream stream(unfinished, std::ios::binary | std::ios::trunc);
  stream.write(content.data(), static_cast<std::streamsize>(content.size()));
  stream.close();
  if (stream) std::filesystem::rename(unfinished, file, error);
  if (!stream || error) {
    std::error_code ignored;
    std::filesystem::remove(unfinished, ignored);
    throw InputError(fmt::format(
        "{}: cannot be written, expected a folder that exists, is writable and has space",
        file.string()));
  }
}

void PrepareOutputFolder(std::string_view option, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const bool is_folder = std::filesystem::is_directory(folder, error);
  if (!is_folder || ::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw InputError(
        fmt::format("{}: '{}' is not a folder that can be written to", option, folder.string()));
  }
}

}  // namespace possibility::experiments
