#pragma once

#include <string>
#include <vector>

namespace possibility::experiments {

/// A picture with a line below it.
struct Figure {
  std::string caption;
  std::string svg;  ///< a whole document
};

struct PageSection {
  std::string title;
  std::vector<std::string> paragraphs;
  std::string html;  ///< below the paragraphs, as it is
  std::vector<Figure> figures;
  bool is_gallery = false;  ///< figures side by side
};

/// One self-contained HTML document: pictures are part of it.
std::string ExperimentPage(const std::string& title, const std::vector<PageSection>& sections);

}  // namespace possibility::experiments
