#include "experiments/program/empty_values.h"

#include <CLI/CLI.hpp>
#include <string>

namespace possibility::experiments {

void RefuseEmptyValues(CLI::App* program) {
  const auto refuse = [](const std::string& value) {
    return value.empty() ? std::string("the value is empty") : std::string();
  };
  for (CLI::App* command : program->get_subcommands(nullptr)) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) option->check(refuse);
    }
  }
}

}  // namespace possibility::experiments
