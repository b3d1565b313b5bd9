#include "experiments/trials/scenario_template.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include "experiments/trials/expression.h"
#include "experiments/trials/post_field.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;
using Names = std::map<std::string, double>;

std::string Trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// "3 of a, b, c, d" is "a, b, c".
std::string FirstOf(const std::string& count_text, const std::string& words, const Names& names) {
  const double count = EvaluateExpression(count_text, names);
  std::vector<std::string> list;
  std::istringstream stream(words);
  for (std::string word; std::getline(stream, word, ',');) list.push_back(Trimmed(word));
  if (count != std::round(count) || count < 1 || count > static_cast<double>(list.size())) {
    throw InputError(fmt::format("'{}' is {:g}, expected a whole number from 1 to {}", count_text,
                                 count, list.size()));
  }
  list.resize(static_cast<std::size_t>(count));
  return fmt::format("{}", fmt::join(list, ", "));
}

std::string ValueOf(const std::string& placeholder, const Names& names) {
  const std::size_t of = placeholder.find(" of ");
  if (of != std::string::npos) {
    return FirstOf(placeholder.substr(0, of), placeholder.substr(of + 4), names);
  }
  // Twelve digits, so that 0.1 + 0.2 is 0.3.
  return fmt::format("{:.12g}", EvaluateExpression(placeholder, names));
}

/// @throws InputError without a place.
std::string Replaced(const std::string& line, const Names& names) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t begin = line.find("${"); begin != std::string::npos;
       begin = line.find("${", at)) {
    const std::size_t end = line.find('}', begin);
    if (end == std::string::npos) throw InputError("'${' has no '}', expected one on the line");
    result += line.substr(at, begin - at) +
              ValueOf(Trimmed(line.substr(begin + 2, end - begin - 2)), names);
    at = end + 1;
  }
  return result + line.substr(at);
}

/// The line without a comment, which begins with " #" or with # at the start of the line:
/// placeholders in comments are ignored.
std::string WithoutComment(const std::string& line) {
  for (std::size_t at = line.find('#'); at != std::string::npos; at = line.find('#', at + 1)) {
    if (at == 0 || line[at - 1] == ' ' || line[at - 1] == '\t') return line.substr(0, at);
  }
  return line;
}

std::string PostLines(const std::string& indent, const std::string& map, std::uint64_t seed,
                      const fs::path& file, int number) {
  // As many empty lines above it as in the file, so that messages have the right line number.
  const std::string text = std::string(static_cast<std::size_t>(number - 1), '\n') + map + '\n';
  const PostField field = ReadPostField(models::YamlNode::Parse(text, file));
  std::string lines;
  for (const std::string& post : PostsOf(field, seed)) lines += indent + "- " + post + '\n';
  return lines;
}

/// A path relative to the template, as seen from the scenario's folder.
std::string SeenFrom(const fs::path& folder, const std::string& path, const fs::path& file) {
  const fs::path there = fs::absolute(file.parent_path() / path).lexically_normal();
  return there.lexically_proximate(fs::absolute(folder).lexically_normal()).generic_string();
}

}  // namespace

ScenarioTemplate::ScenarioTemplate(fs::path file)
    : file_(std::move(file)),
      text_(models::ReadFileContents(file_)),
      content_hash_(models::ContentHash(text_)) {}

bool ScenarioTemplate::Mentions(const std::string& name) const {
  static const std::regex placeholder("\\$\\{([^}]*)\\}");
  const std::regex word("(^|[^A-Za-z0-9_])" + name + "($|[^A-Za-z0-9_])");
  std::istringstream stream(text_);
  for (std::string line; std::getline(stream, line);) {
    line = WithoutComment(line);
    for (std::sregex_iterator match(line.begin(), line.end(), placeholder), end; match != end;
         ++match) {
      if (std::regex_search((*match)[1].str(), word)) return true;
    }
  }
  return false;
}

std::string ScenarioTemplate::Instantiate(const Names& names, std::uint64_t seed,
                                          const fs::path& folder) const {
  static const std::regex posts("^(\\s*)- posts:\\s*(\\{.*\\})\\s*$");
  static const std::regex robot("^robot:\\s*(\\S+)\\s*$");
  static const std::regex terrain("^(.*\\bfile:\\s*)([^\\s,}]+)(.*)$");  // mesh or height map
  std::string text;
  std::istringstream stream(text_);
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    try {
      line = Replaced(WithoutComment(line), names);
      std::smatch match;
      if (std::regex_match(line, match, robot)) {
        text += "robot: " + SeenFrom(folder, match[1], file_) + '\n';
      } else if (std::regex_match(line, match, terrain)) {
        text += match[1].str() + SeenFrom(folder, match[2], file_) + match[3].str() + '\n';
      } else if (std::regex_match(line, match, posts)) {
        text += PostLines(match[1], match[2], seed, file_, number);
      } else {
        text += line + '\n';
      }
    } catch (const InputError& error) {
      const std::string message = error.what();
      if (message.rfind(file_.string(), 0) == 0) throw;  // the message already has its place
      throw InputError(fmt::format("{}:{}: {}", file_.string(), number, message));
    }
  }
  return text;
}

}  // namespace possibility::experiments
