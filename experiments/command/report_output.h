#pragma once

#include <fmt/format.h>

#include <filesystem>

#include "experiments/support/standard_streams.h"

namespace possibility::experiments {

/// Writes the files of an experiment's report, and prints its summary as one JSON object or its
/// tables to standard output.
/// @throws InputError if a file cannot be written.
template <typename Report>
void PutOutReport(const Report& report, const std::filesystem::path& folder, bool json) {
  report.Write(folder);
  if (json) {
    PrintOut("{}\n", report.Summary().dump());
  } else {
    PrintOut("{}\nreport: {}\n", report.Markdown(), (folder / "report.html").string());
  }
}

}  // namespace possibility::experiments
