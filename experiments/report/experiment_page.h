#pragma once

#include <string>
#include <vector>

namespace possibility::experiments {

/// A picture with a caption.
struct Figure {
  std::string caption;
  std::string svg;  ///< a whole document
};

struct PageSection {
  std::string title;
  std::vector<std::string> paragraphs;
  std::string html;  ///< below the paragraphs, verbatim
  std::vector<Figure> figures;
  bool is_gallery = false;  ///< figures side by side
};

/// One self-contained HTML document with embedded pictures.
std::string ExperimentPage(const std::string& title, const std::vector<PageSection>& sections);

}  // namespace possibility::experiments
