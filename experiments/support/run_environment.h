#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace possibility::experiments {

/// What a measurement depends on besides the input.
struct RunEnvironment {
  std::string compiler;    ///< "GCC 12.2.0"
  std::string build_type;  ///< "Release"
  std::string cpu;         ///< the model's name, as the system gives it
  std::string possibility;
  std::string ipopt;
  int hardware_threads = 1;

  nlohmann::ordered_json Json() const;
};

RunEnvironment ThisEnvironment();

}  // namespace possibility::experiments
