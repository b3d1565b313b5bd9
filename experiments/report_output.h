#pragma once

#include <fmt/format.h>

#include <filesystem>

namespace possibility::experiments {

/// What commands do with the report of an experiment: its files, and its summary as one JSON object
/// or its tables on standard output.
/// @throws InputError if a file cannot be written.
template <typename Report>
void PutOutReport(const Report& report, const std::filesystem::path& folder, bool json) {
  report.Write(folder);
  if (json) {
    fmt::print("{}\n", report.Summary().dump());
  } else {
    fmt::print("{}\nreport: {}\n", report.Markdown(), (folder / "report.html").string());
  }
}

}  // namespace possibility::experiments
