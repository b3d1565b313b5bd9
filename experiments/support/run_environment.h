#pragma once

#include <string>

#include "models/input/json_text.h"

namespace possibility::experiments {

/// Environment on which a measurement depends besides the input.
struct RunEnvironment {
  std::string compiler;    ///< "GCC 12.2.0"
  std::string build_type;  ///< "Release"
  std::string cpu;         ///< model name reported by the system
  std::string possibility;
  std::string ipopt;
  int hardware_threads = 1;

  nlohmann::ordered_json Json() const;
};

RunEnvironment ThisEnvironment();

}  // namespace possibility::experiments
