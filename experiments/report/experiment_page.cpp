#include "experiments/report/experiment_page.h"

#include <fmt/format.h>

#include "experiments/report/svg_plot.h"
#include "experiments/support/base64.h"
#include "experiments/support/xml_text.h"

namespace possibility::experiments {
namespace {

constexpr const char* kPageStyle =
    "body{font:15px/1.45 system-ui,\"DejaVu Sans\",Arial,sans-serif;color:#212529;margin:32px auto;"
    "max-width:1180px;padding:0 20px}\n"
    "h1{font-size:26px;margin:0 0 8px}h2{font-size:19px;margin:0 0 4px}\n"
    "p{margin:4px 0;color:#495057}section{border-top:1px solid #dee2e6;padding:18px 0}\n"
    "table{border-collapse:collapse;margin:12px 0 "
    "20px;font-size:13px;display:block;overflow-x:auto}\n"
    "th{text-align:left;border-bottom:2px solid #adb5bd;padding:5px 8px}\n"
    "td{border-bottom:1px solid #e9ecef;padding:4px 8px;white-space:nowrap}\n"
    "th.n,td.n{text-align:right;font-variant-numeric:tabular-nums}\n"
    "figure{margin:14px 0}figcaption{font-size:13px;color:#495057}img{max-width:100%}\n"
    ".gallery{display:flex;flex-wrap:wrap;gap:18px}.gallery figure{margin:0}\n";

/// Embeds a figure as an image rather than as elements, so that styles and ids of figures do not
/// interfere.
std::string Html(const Figure& figure) {
  return fmt::format(
      "<figure><img alt=\"{0}\" src=\"data:image/svg+xml;base64,{1}\"/>"
      "<figcaption>{0}</figcaption></figure>\n",
      XmlText(figure.caption), Base64(figure.svg));
}

std::string Html(const PageSection& section) {
  std::string html = "<section><h2>" + XmlText(section.title) + "</h2>\n";
  for (const std::string& paragraph : section.paragraphs) {
    html += "<p>" + XmlText(paragraph) + "</p>\n";
  }
  html += section.html;
  if (section.is_gallery) html += "<div class=\"gallery\">\n";
  for (const Figure& figure : section.figures) html += Html(figure);
  return html + (section.is_gallery ? "</div>\n</section>\n" : "</section>\n");
}

}  // namespace

std::string ExperimentPage(const std::string& title, const std::vector<PageSection>& sections) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n<title>{0}</title>\n"
      "<style>\n{1}</style></head>\n<body>\n<h1>{0}</h1>\n",
      XmlText(title), kPageStyle);
  for (const PageSection& section : sections) html += Html(section);
  return html + "</body></html>\n";
}

}  // namespace possibility::experiments
