#include "experiments/report/text_table.h"

#include "experiments/report/svg_plot.h"
#include "experiments/support/xml_text.h"

namespace possibility::experiments {
namespace {

std::string MarkdownRow(const std::vector<std::string>& cells) {
  std::string line = "|";
  for (const std::string& cell : cells) {
    line += ' ';
    for (const char c : cell) line += c == '|' ? std::string("\\|") : std::string(1, c);
    line += " |";
  }
  return line + '\n';
}

std::string HtmlRow(const std::vector<std::string>& cells, std::size_t text_columns,
                    const std::string& tag) {
  std::string line = "<tr>";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    line += '<' + tag + (i < text_columns ? ">" : " class=\"n\">") + XmlText(cells[i]) + "</" +
            tag + '>';
  }
  return line + "</tr>\n";
}

}  // namespace

std::string TextTable::Markdown() const {
  std::string text = MarkdownRow(header) + '|';
  for (std::size_t i = 0; i < header.size(); ++i) text += i < text_columns ? "---|" : "--:|";
  text += '\n';
  for (const std::vector<std::string>& row : rows) text += MarkdownRow(row);
  return text;
}

std::string TextTable::Html() const {
  std::string text = "<table>\n" + HtmlRow(header, text_columns, "th");
  for (const std::vector<std::string>& row : rows) text += HtmlRow(row, text_columns, "td");
  return text + "</table>\n";
}

}  // namespace possibility::experiments
