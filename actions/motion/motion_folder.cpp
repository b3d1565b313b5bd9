#include "actions/motion/motion_folder.h"

namespace possibility::actions {

std::filesystem::path MotionFolder(const std::filesystem::path& library,
                                   const std::string& identity) {
  return library.empty() ? library : library / identity.substr(0, 16);
}

}  // namespace possibility::actions
