#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace possibility::experiments {

/// Reads the records of a CSV text (RFC 4180), one after the other. Lines may end in LF or CR LF;
/// empty lines are left out.
class CsvRecords {
 public:
  /// `text` must outlive it. `file`: for messages.
  CsvRecords(std::string_view text, const std::filesystem::path& file);

  /// The next record's fields. False at the end. @throws InputError for a quote that is not closed
  /// or stands inside a field.
  bool Next(std::vector<std::string>* fields);

  /// "file:12", where the last record begins.
  std::string place() const;

 private:
  std::string Quoted();
  std::string Plain();
  void SkipEmptyLines();
  [[noreturn]] void Fail(const std::string& what) const;

  std::string_view rest_;
  std::string file_;
  std::size_t line_ = 1;         ///< of the rest
  std::size_t record_line_ = 1;  ///< of the last record
};

/// A field as a number. @throws InputError naming `where` unless all of it is a finite number.
double CsvNumber(std::string_view field, const std::string& where);

}  // namespace possibility::experiments
