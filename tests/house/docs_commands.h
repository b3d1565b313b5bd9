#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace possibility::house {

/// A command that a document tells its reader to type, and what it says the command prints.
struct DocsCommand {
  std::string document;  ///< path from the root
  int line = 0;          ///< of the document, from 1
  std::string text;      ///< for a shell; lines that end in a backslash are joined
  std::optional<std::vector<std::string>> output;
};

/// The commands in the document's blocks, in order. A block ```sh holds a command a line, comments
/// apart; a block ```output holds what the last command above it prints.
/// @throws std::runtime_error if the document cannot be read or an output has no command above it.
std::vector<DocsCommand> CommandsOf(const std::filesystem::path& root, const std::string& document);

/// Lines of indented blocks that begin like a command, each with its place: they belong into a
/// block
/// ```sh.
std::vector<std::string> CommandsOutsideBlocks(const std::filesystem::path& root,
                                               const std::string& document);

/// Compares what a document shows with what was printed. A line "..." stands for any lines. On
/// lines that begin with a name of `measured` one number is as good as another. All else must be
/// equal.
/// Returns nothing, or the lines shown, each after "  " if it was printed and "- " if not, and with
/// "+ " the lines that were printed instead.
std::string OutputDifference(const std::vector<std::string>& shown, const std::string& printed,
                             const std::vector<std::string>& measured);

}  // namespace possibility::house
