#include "experiments/support/temporary_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <system_error>

#include "models/input/input_error.h"

namespace possibility::experiments {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  std::string name = (parent / "possibility-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) {
    throw InputError(fmt::format("{}: no folder can be made there for temporary files", name));
  }
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace possibility::experiments
