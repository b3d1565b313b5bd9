#include "tests/fuzz/mutator.h"

#include <cctype>

namespace possibility::fuzz {
namespace {

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// From an opening bracket to just behind the one that closes it.
std::size_t BracketedLength(std::string_view text, std::size_t begin) {
  int depth = 0;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (text[i] == '[' || text[i] == '{') ++depth;
    if ((text[i] == ']' || text[i] == '}') && --depth == 0) return i + 1 - begin;
  }
  return 0;
}

/// From "<name" to just behind "/>" or "</name>".
std::size_t ElementLength(std::string_view text, std::size_t begin) {
  std::size_t name_end = begin + 1;
  while (name_end < text.size() && IsWordCharacter(text[name_end])) ++name_end;
  const std::string_view name = text.substr(begin + 1, name_end - begin - 1);
  const std::size_t head_end = text.find('>', begin);
  if (name.empty() || head_end == std::string_view::npos) return 0;
  if (text[head_end - 1] == '/') return head_end + 1 - begin;
  const std::string tail = "</" + std::string(name) + ">";
  const std::size_t end = text.find(tail, head_end);
  return end == std::string_view::npos ? 0 : end + tail.size() - begin;
}

/// A line and the lines after it that are indented deeper.
std::size_t IndentedLength(std::string_view text, std::size_t begin) {
  const auto indent = [&](std::size_t at) {
    const std::size_t first = text.find_first_not_of(' ', at);
    return (first == std::string_view::npos ? text.size() : first) - at;
  };
  const std::size_t own = indent(begin);
  std::size_t end = begin;
  do {
    end = text.find('\n', end);
    if (end == std::string_view::npos) return text.size() - begin;
    ++end;
  } while (end < text.size() && indent(end) > own);
  return end - begin;
}

std::string Repeated(std::string_view text, std::size_t count) {
  std::string repeated;
  repeated.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) repeated += text;
  return repeated;
}

}  // namespace

std::string Mutator::operator()(std::string text) {
  for (std::size_t i = 1 + Below(3); i > 0; --i) {
    if (!text.empty()) MutateOnce(&text);
  }
  return text;
}

void Mutator::MutateOnce(std::string* text) {
  const std::size_t kind = Below(20);
  if (kind < 6) return MutateNumber(text);
  if (kind < 10) return MutateWord(text);
  if (kind < 14) return MutateGroup(text);
  if (kind < 16) return MutateLine(text);
  if (kind < 19) return MutateBytes(text);
  PlantBomb(text);
}

std::string Mutator::SpecialNumber() {
  static constexpr std::string_view kNumbers[] = {"nan",
                                                  ".nan",
                                                  "NaN",
                                                  "inf",
                                                  "-inf",
                                                  ".inf",
                                                  "Infinity",
                                                  "1e308",
                                                  "-1e308",
                                                  "1e309",
                                                  "1e6",
                                                  "-1e6",
                                                  "1e-320",
                                                  "-0",
                                                  "-0.0",
                                                  "0",
                                                  "-1",
                                                  "1",
                                                  "2",
                                                  "1e-9",
                                                  "1e-300",
                                                  "0x10",
                                                  "1e",
                                                  "1.5.2",
                                                  "2147483647",
                                                  "2147483648",
                                                  "-2147483649",
                                                  "4294967296",
                                                  "9223372036854775807",
                                                  "9223372036854775808",
                                                  "18446744073709551615",
                                                  "18446744073709551616",
                                                  "1e99999",
                                                  "-9223372036854775809",
                                                  "99999999999999999999999999999999",
                                                  "1000",
                                                  "1e5",
                                                  "\"1\"",
                                                  "null",
                                                  "true",
                                                  "[]",
                                                  "{}",
                                                  "[1]",
                                                  "'%n'"};
  return OneOf(kNumbers);
}

std::string Mutator::SpecialText() {
  using namespace std::string_view_literals;
  static constexpr std::string_view kTexts[] = {""sv,
                                                "\0"sv,
                                                "\x01\x02\x1b[2J\x7f"sv,
                                                "\x1a"sv,
                                                "%n"sv,
                                                "%s%s%s%s%n%n"sv,
                                                "%p %x %1000000d"sv,
                                                "{}"sv,
                                                "{0:{1}}"sv,
                                                "\xff\xfe"sv,
                                                "\xc3"sv,
                                                "\xed\xa0\x80"sv,
                                                "\\u0000"sv,
                                                "\\ud800"sv,
                                                "&#0;"sv,
                                                "&#37;n"sv,
                                                "&lt;b&gt;"sv,
                                                "</script><b>"sv,
                                                "../../../../etc/passwd"sv,
                                                "/dev/zero"sv,
                                                "/dev/stdin"sv,
                                                "."sv,
                                                "a\nb"sv,
                                                "\r\n"sv,
                                                "\t"sv,
                                                "~"sv,
                                                "null"sv,
                                                "yes"sv,
                                                "*"sv,
                                                "&"sv,
                                                "!"sv,
                                                "!!binary x"sv,
                                                "---\n"sv,
                                                "%YAML 1.2\n"sv,
                                                "# "sv,
                                                ": "sv,
                                                "- "sv,
                                                "<!--"sv,
                                                "]]>"sv,
                                                "<![CDATA["sv,
                                                "\xef\xbb\xbf"sv,
                                                "\xe2\x80\xae"sv};
  if (Below(8) == 0) return std::string(std::size_t{1} << (8 + Below(10)), 'a');
  return OneOf(kTexts);
}

std::string Mutator::Nested(const std::string& inside) {
  static constexpr std::size_t kDepths[] = {3, 50, 1000, 20000};
  const std::size_t depth = kDepths[Below(std::size(kDepths))];
  if (syntax_ == Syntax::kXml) {
    const bool is_closed = Below(4) != 0;
    return Repeated("<link name=\"a\">", depth) + inside +
           (is_closed ? Repeated("</link>", depth) : "");
  }
  const bool is_map = Below(2) == 0;
  const std::string_view open = is_map ? "{\"a\": " : "[";
  return Repeated(open, depth) + inside + Repeated(is_map ? "}" : "]", depth - Below(2));
}

Mutator::Stretch Mutator::Number(std::string_view text) {
  std::size_t begin = Below(text.size());
  while (begin < text.size() && IsDigit(text[begin])) ++begin;
  while (begin < text.size() && !IsDigit(text[begin])) ++begin;
  if (begin > 0 && text[begin - 1] == '-') --begin;
  const std::size_t end = text.find_first_not_of("0123456789.eE+-", begin);
  return {begin, (end == std::string_view::npos ? text.size() : end) - begin};
}

Mutator::Stretch Mutator::Word(std::string_view text) {
  const auto is_letter = [](char c) { return IsWordCharacter(c) && !IsDigit(c); };
  std::size_t begin = Below(text.size());
  while (begin < text.size() && IsWordCharacter(text[begin])) ++begin;
  while (begin < text.size() && !is_letter(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && IsWordCharacter(text[end])) ++end;
  return {begin, end - begin};
}

Mutator::Stretch Mutator::Group(std::string_view text) {
  const std::size_t from = Below(text.size());
  if (syntax_ == Syntax::kXml) {
    const std::size_t begin = text.find('<', from);
    if (begin == std::string_view::npos) return {0, 0};
    return {begin, ElementLength(text, begin)};
  }
  if (syntax_ == Syntax::kYaml && Below(2) == 0) {
    const std::size_t begin = Line(text).first;
    return {begin, IndentedLength(text, begin)};
  }
  const std::size_t begin = text.find_first_of("[{", from);
  if (begin == std::string_view::npos) return {0, 0};
  return {begin, BracketedLength(text, begin)};
}

Mutator::Stretch Mutator::Line(std::string_view text) {
  const std::size_t before = text.rfind('\n', Below(text.size()));
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const std::size_t end = text.find('\n', begin);
  return {begin, (end == std::string_view::npos ? text.size() : end + 1) - begin};
}

void Mutator::MutateNumber(std::string* text) {
  const auto [begin, length] = Number(*text);
  if (length == 0) return;
  const auto [other, other_length] = Number(*text);
  const bool is_special = Below(3) != 0;
  text->replace(begin, length, is_special ? SpecialNumber() : text->substr(other, other_length));
}

void Mutator::MutateWord(std::string* text) {
  const auto [begin, length] = Word(*text);
  if (length == 0) return;
  const auto [other, other_length] = Word(*text);
  switch (Below(4)) {
    case 0:
      (*text)[begin + Below(length)] = static_cast<char>('a' + Below(26));
      return;
    case 1:
      text->insert(begin + Below(length + 1), SpecialText());
      return;
    case 2:
      text->replace(begin, length, SpecialText());
      return;
    default:
      text->replace(begin, length, text->substr(other, other_length));
  }
}

void Mutator::MutateGroup(std::string* text) {
  const auto [begin, length] = Group(*text);
  if (length == 0) return;
  const std::string group = text->substr(begin, length);
  const auto [other, other_length] = Group(*text);
  static constexpr std::string_view kScalars[] = {"[]",   "{}",   "0",     "\"\"",
                                                  "null", "[[]]", "[null]"};
  switch (Below(6)) {
    case 0:
      text->replace(begin, length, syntax_ == Syntax::kXml ? "<a/>" : OneOf(kScalars));
      return;
    case 1:
      text->erase(begin, length);
      return;
    case 2:
      text->insert(begin, syntax_ == Syntax::kJson ? group + "," : group);
      return;
    case 3:
      text->replace(begin, length, text->substr(other, other_length));
      return;
    case 4:
      text->insert(begin, Repeated(syntax_ == Syntax::kJson ? group + "," : group, 1 + Below(30)));
      return;
    default:
      text->replace(begin, length, Nested(Below(2) == 0 ? group : ""));
  }
}

void Mutator::MutateLine(std::string* text) {
  const auto [begin, length] = Line(*text);
  const std::string line = text->substr(begin, length);
  const std::size_t kind = Below(3);
  if (kind != 0) text->erase(begin, length);
  if (kind != 1) text->insert(Line(*text).first, line);
}

void Mutator::MutateBytes(std::string* text) {
  const std::size_t at = Below(text->size());
  switch (Below(5)) {
    case 0:
      text->resize(at);
      return;
    case 1:
      (*text)[at] = static_cast<char>(Below(256));
      return;
    case 2:
      (*text)[at] = static_cast<char>((*text)[at] ^ (1 << Below(8)));
      return;
    case 3:
      text->insert(at, SpecialText());
      return;
    default:
      text->insert(at, text->substr(Below(text->size()), 1 + Below(400)));
  }
}

void Mutator::PlantBomb(std::string* text) {
  const auto [begin, length] = Number(*text);
  if (syntax_ == Syntax::kXml) {
    std::string entities = "<!DOCTYPE robot [<!ENTITY e0 \"1\">";
    for (int i = 1; i < 20; ++i) {
      const std::string last = "&e" + std::to_string(i - 1) + ";";
      entities += "<!ENTITY e" + std::to_string(i) + " \"" + Repeated(last, 10) + "\">";
    }
    text->replace(begin, length, "&e19;");
    text->insert(0, entities + "]>\n");
    return;
  }
  if (syntax_ == Syntax::kJson) {
    text->replace(begin, length, Nested("1"));
    return;
  }
  if (Below(3) == 0) {
    static constexpr std::string_view kAliases[] = {"&a [*a]", "&a {a: *a}",     "*a",
                                                    "&a 1",    "{<<: *a, x: 1}", "!!set {a, b}"};
    text->replace(begin, length, OneOf(kAliases));
    return;
  }
  std::string bomb = "[&a0 [1,1,1,1,1,1,1,1,1]";
  for (int i = 1; i < 15; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    bomb += ",&a" + std::to_string(i) + " [" + last + Repeated("," + last, 8) + "]";
  }
  text->replace(begin, length, bomb + (Below(2) == 0 ? "]" : ",*a14]"));
}

}  // namespace possibility::fuzz
