#include "tests/house/docs_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace possibility::house {
namespace {

constexpr const char* kAnyLines = "...";

std::vector<std::string> LinesOf(std::istream& stream) {
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> ReadLines(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  return LinesOf(stream);
}

/// Adds a line of a block ```sh to the commands.
class CommandReader {
 public:
  CommandReader(std::string document, std::vector<DocsCommand>* commands)
      : document_(std::move(document)), commands_(commands) {}

  void Add(const std::string& line, int number) {
    const bool goes_on = line.ends_with('\\');
    if (continued_) {
      commands_->back().text += line.substr(0, line.size() - goes_on);
    } else if (!line.empty() && line[0] != '#') {
      commands_->push_back({document_, number, line.substr(0, line.size() - goes_on), {}});
    }
    continued_ = goes_on;
  }

 private:
  std::string document_;
  std::vector<DocsCommand>* commands_;
  bool continued_ = false;
};

/// Without a measured number, if the line begins with a measured name.
std::string Comparable(const std::string& line, const std::vector<std::string>& measured) {
  static const std::regex number(" *[0-9]+(\\.[0-9]+)?");
  const auto begins = [&](const std::string& name) { return line.starts_with(name + " "); };
  if (std::none_of(measured.begin(), measured.end(), begins)) return line;
  return std::regex_replace(line, number, " NUMBER");
}

}  // namespace

std::vector<DocsCommand> CommandsOf(const std::filesystem::path& root,
                                    const std::string& document) {
  std::vector<DocsCommand> commands;
  CommandReader reader(document, &commands);
  std::string block;  // what follows the ``` of the block around the line
  bool inside = false;
  int number = 0;
  for (const std::string& line : ReadLines(root / document)) {
    ++number;
    if (line.starts_with("```")) {
      inside = !inside;
      block = inside ? line.substr(3) : "";
      if (block != "output") continue;
      if (commands.empty() || commands.back().output) {
        throw std::runtime_error(
            fmt::format("{}:{}: output without a command above it", document, number));
      }
      commands.back().output.emplace();
    } else if (block == "sh") {
      reader.Add(line, number);
    } else if (block == "output") {
      commands.back().output->push_back(line);
    }
  }
  return commands;
}

std::vector<std::string> CommandsOutsideBlocks(const std::filesystem::path& root,
                                               const std::string& document) {
  static const std::regex command(
      "    (\\./|possibility |build/|cmake |ctest |cp |mkdir |sbatch |/usr/bin/|chromium ).*");
  std::vector<std::string> found;
  bool before_is_empty = true;
  int number = 0;
  for (const std::string& line : ReadLines(root / document)) {
    ++number;
    if (before_is_empty && std::regex_match(line, command)) {
      found.push_back(fmt::format("{}:{}:{}", document, number, line));
    }
    before_is_empty = line.empty();
  }
  return found;
}

std::string OutputDifference(const std::vector<std::string>& shown, const std::string& printed,
                             const std::vector<std::string>& measured) {
  std::istringstream stream(printed);
  const std::vector<std::string> lines = LinesOf(stream);
  const auto same = [&](const std::string& a, const std::string& b) {
    return Comparable(a, measured) == Comparable(b, measured);
  };
  std::string text;
  std::size_t next = 0;  // of lines
  bool differs = false, skips = false;
  for (const std::string& line : shown) {
    if (line == kAnyLines) {
      skips = true;
      text += fmt::format("  {}\n", line);
      continue;
    }
    std::size_t found = next;
    while (found < lines.size() && !same(lines[found], line)) ++found;
    const bool is_printed = found < lines.size();
    if (is_printed) {
      for (; next < found && !skips; ++next) {
        text += fmt::format("+ {}\n", lines[next]);
        differs = true;
      }
      next = found + 1;
      skips = false;
    } else {
      differs = true;
    }
    text += fmt::format("{} {}\n", is_printed ? ' ' : '-', line);
  }
  for (; next < lines.size() && !skips; ++next) {
    text += fmt::format("+ {}\n", lines[next]);
    differs = true;
  }
  return differs ? text : "";
}

}  // namespace possibility::house
