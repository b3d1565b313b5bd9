#pragma once

#include <string>
#include <vector>

namespace possibility::experiments {

/// A table of text that can be printed in several formats. Every row has as many cells as the
/// header; the first `text_columns` are words, the others numbers.
struct TextTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::size_t text_columns = 1;

  std::string Markdown() const;
  std::string Html() const;
};

}  // namespace possibility::experiments
