#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace possibility::experiments {

/// The options of one command. An empty value of any of them is a usage error: it would otherwise
/// act as if the option were absent.
///
/// Commands use CLI11 through this class only, because each file that includes CLI11 takes seconds
/// to compile. Values are text (CLI11 would wrap a negative seed around and truncate "1.5").
class CommandOptions {
 public:
  /// Adds a command to `program`, which owns it.
  CommandOptions(CLI::App& program, const std::string& command, const std::string& description);

  /// An option ("--out") or an argument ("PLAN") that must be given.
  void AddRequired(const std::string& name, std::string* value, const std::string& help);
  /// The same with one value or more.
  void AddRequired(const std::string& name, std::vector<std::string>* values,
                   const std::string& help);
  /// An option whose default is the content of `value`. Help shows the default unless it is empty.
  void AddOptional(const std::string& name, std::string* value, const std::string& help);
  /// An option that may be given several times.
  void AddOptional(const std::string& name, std::vector<std::string>* values,
                   const std::string& help);
  /// An option without a value.
  void AddFlag(const std::string& name, bool* value, const std::string& help);

  /// Whether the parsed command line names this command.
  bool IsChosen() const;

 private:
  CLI::App* command_;
};

}  // namespace possibility::experiments
