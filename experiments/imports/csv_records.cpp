#include "experiments/imports/csv_records.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "models/input/input_error.h"

namespace possibility::experiments {

CsvRecords::CsvRecords(std::string_view text, const std::filesystem::path& file)
    : rest_(text), file_(file.string()) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

bool CsvRecords::Next(std::vector<std::string>* fields) {
  fields->clear();
  SkipEmptyLines();
  record_line_ = line_;
  if (rest_.empty()) return false;
  while (true) {
    fields->push_back(rest_.starts_with('"') ? Quoted() : Plain());
    if (rest_.starts_with(',')) {
      rest_.remove_prefix(1);
      continue;
    }
    if (rest_.starts_with("\r\n")) rest_.remove_prefix(1);
    if (!rest_.empty() && rest_[0] != '\n') Fail("expected a comma or the end of the line");
    return true;
  }
}

void CsvRecords::SkipEmptyLines() {
  while (rest_.starts_with('\n') || rest_.starts_with("\r\n")) {
    rest_.remove_prefix(rest_[0] == '\n' ? 1 : 2);
    ++line_;
  }
}

std::string CsvRecords::Quoted() {
  std::string field;
  rest_.remove_prefix(1);
  while (true) {
    const std::size_t quote = rest_.find('"');
    if (quote == std::string_view::npos) Fail("a quote is not closed");
    field += rest_.substr(0, quote);
    rest_.remove_prefix(quote + 1);
    if (!rest_.starts_with('"')) break;
    field += '"';
    rest_.remove_prefix(1);
  }
  for (const char c : field) line_ += c == '\n';
  return field;
}

std::string CsvRecords::Plain() {
  std::size_t end = rest_.find_first_of(",\n\"");
  if (end == std::string_view::npos) end = rest_.size();
  if (end < rest_.size() && rest_[end] == '"') Fail("a quote inside a field");
  if (end > 0 && rest_[end - 1] == '\r') --end;
  std::string field(rest_.substr(0, end));
  rest_.remove_prefix(end);
  return field;
}

std::string CsvRecords::place() const { return fmt::format("{}:{}", file_, record_line_); }

void CsvRecords::Fail(const std::string& what) const {
  throw InputError(fmt::format("{}: {}", place(), what));
}

double CsvNumber(std::string_view field, const std::string& where) {
  std::string_view text = field;
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(number)) {
    return number;
  }
  throw InputError(fmt::format("{}: expected a number, got '{}'", where, field.substr(0, 40)));
}

}  // namespace possibility::experiments
