#include "experiments/support/command_options.h"

#include <CLI/CLI.hpp>

namespace possibility::experiments {
namespace {

std::string RefuseEmpty(const std::string& value) {
  return value.empty() ? "the value is empty" : "";
}

}  // namespace

CommandOptions::CommandOptions(CLI::App& program, const std::string& command,
                               const std::string& description)
    : command_(program.add_subcommand(command, description)) {}

void CommandOptions::AddRequired(const std::string& name, std::string* value,
                                 const std::string& help) {
  command_->add_option(name, *value, help)->required()->check(&RefuseEmpty);
}

void CommandOptions::AddRequired(const std::string& name, std::vector<std::string>* values,
                                 const std::string& help) {
  command_->add_option(name, *values, help)->required()->check(&RefuseEmpty);
}

void CommandOptions::AddOptional(const std::string& name, std::string* value,
                                 const std::string& help) {
  CLI::Option* option = command_->add_option(name, *value, help)->check(&RefuseEmpty);
  if (!value->empty()) option->capture_default_str();
}

void CommandOptions::AddOptional(const std::string& name, std::vector<std::string>* values,
                                 const std::string& help) {
  command_->add_option(name, *values, help)->check(&RefuseEmpty)->expected(1)->take_all();
}

void CommandOptions::AddFlag(const std::string& name, bool* value, const std::string& help) {
  command_->add_flag(name, *value, help);
}

bool CommandOptions::IsChosen() const { return command_->parsed(); }

}  // namespace possibility::experiments
