#include "experiments/support/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "models/input/atomic_file.h"
#include "models/input/input_error.h"

namespace possibility::experiments {

void WriteOutput(const std::filesystem::path& file, std::string_view content) {
  models::WriteAtomically(file, content);
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
