#include "experiments/support/file_name.h"

#include <cctype>

namespace possibility::experiments {

std::string SafeFileName(std::string text) {
  for (char& c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-') c = '_';
  }
  return text;
}

}  // namespace possibility::experiments
