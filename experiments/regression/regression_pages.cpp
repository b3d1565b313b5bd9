#include "experiments/regression/regression_pages.h"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "experiments/regression/work_precision.h"
#include "experiments/report/svg_plot.h"
#include "experiments/report/trajectory_plot.h"
#include "experiments/support/file_name.h"
#include "experiments/support/output_file.h"
#include "experiments/support/xml_text.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

std::string FileName(const std::string& problem, const char* suffix = "") {
  return SafeFileName(problem) + suffix + ".svg";
}

std::string Number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "none";
}

std::string Row(const RegressionRecord& record) {
  const char* verdict = record.within_tolerance ? "good" : "bad";
  const std::string met = record.within_tolerance ? XmlText(record.nearest.name)
                                                  : "misses " + XmlText(record.nearest.name);
  return fmt::format(
      "<tr><td><a href=\"#{0}\">{0}</a></td><td class=\"{1}\">{2}</td><td class=\"n\">{3}</td>"
      "<td class=\"n\">{4}</td><td class=\"n\">{5}</td><td class=\"{1}\">{6}</td>"
      "<td class=\"n\">{7}</td><td class=\"n\">{8}</td><td class=\"n\">{9}</td>"
      "<td class=\"n\">{10:.3f}</td></tr>\n",
      XmlText(record.name), verdict, XmlText(record.status), Number(record.objective, "{:.10g}"),
      Number(record.nearest.objective, "{:.10g}"), Number(record.relative_error, "{:.1e}"), met,
      record.iterations, std::accumulate(record.intervals.begin(), record.intervals.end(), 0),
      record.variables, record.seconds.total);
}

std::string Section(const RegressionRecord& record, bool has_picture) {
  std::string html = fmt::format("<section id=\"{0}\"><h2>{0}</h2>\n<p>{1}</p>\n",
                                 XmlText(record.name), XmlText(record.source));
  html += fmt::format(
      "<p class=\"facts\">{}; objective {}, known optimum \u201c{}\u201d {}, error {}; {}, mesh "
      "refined {} times, error between the knots {}</p>\n",
      XmlText(record.message), Number(record.objective, "{:.10g}"), XmlText(record.nearest.name),
      Number(record.nearest.objective, "{:.10g}"), Number(record.relative_error, "{:.1e}"),
      XmlText(record.scheme), record.refinements, Number(record.mesh_error, "{:.1e}"));
  html += has_picture ? fmt::format("<img src=\"{}\" alt=\"{}\">\n", FileName(record.name),
                                    XmlText(record.name + ": coordinates, rates, controls"))
                      : "<p>There is no motion to show.</p>\n";
  if (!record.work_precision.empty()) {
    html += fmt::format("<img src=\"{}\" alt=\"{}\">\n", FileName(record.name, "_precision"),
                        XmlText(record.name + ": error over time, one curve for each scheme"));
  }
  return html + "</section>\n";
}

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
    "<title>Regression suite</title>\n<style>\n"
    "body{font:15px/1.45 system-ui,\"DejaVu Sans\",Arial,sans-serif;color:#212529;margin:32px auto;"
    "max-width:1060px;padding:0 20px}\n"
    "h1{font-size:26px;margin:0 0 4px}h2{font-size:19px;margin:0 0 2px}\n"
    "p{margin:2px 0;color:#495057}.facts{font-size:13px}\n"
    "table{border-collapse:collapse;margin:18px 0 30px;width:100%;font-size:13px}\n"
    "th{text-align:left;border-bottom:2px solid #adb5bd;padding:5px 8px}\n"
    "td{border-bottom:1px solid #e9ecef;padding:4px 8px}\n"
    "th.n,td.n{text-align:right;font-variant-numeric:tabular-nums}\n"
    ".good{color:#2b8a3e}.bad{color:#c92a2a;font-weight:600}\n"
    "a{color:#0b6fb8;text-decoration:none}\n"
    "section{border-top:1px solid #dee2e6;padding:20px 0}img{max-width:100%;margin-top:8px}\n"
    "</style></head>\n<body>\n";

std::string Summary(const RegressionReport& report) {
  const std::size_t failures = report.Failures().size();
  double seconds = 0;
  for (const RegressionRecord& record : report.problems) seconds += record.seconds.total;
  return fmt::format(
      "<h1>Regression suite</h1>\n<p>{} of {} problems within the tolerance of a known optimum; "
      "{:.2f} s. Options: {}</p>\n",
      report.problems.size() - failures, report.problems.size(), seconds,
      XmlText(models::JsonText(report.options.Json())));
}

}  // namespace

void WriteRegressionPages(const RegressionReport& report, const std::filesystem::path& folder) {
  std::string table =
      "<table><tr><th>problem</th><th>status</th><th class=\"n\">objective</th>"
      "<th class=\"n\">known</th><th class=\"n\">error</th><th>optimum</th>"
      "<th class=\"n\">iterations</th><th class=\"n\">intervals</th><th class=\"n\">variables</th>"
      "<th class=\"n\">seconds</th></tr>\n";
  std::string sections;
  for (const RegressionRecord& record : report.problems) {
    const std::vector<Plot> plots = TrajectoryPlots(record.solution);
    if (!plots.empty()) WriteOutput(folder / FileName(record.name), SvgDocument(plots));
    if (!record.work_precision.empty()) {
      WriteOutput(folder / FileName(record.name, "_precision"),
                  SvgDocument({WorkPrecisionPlot(record)}));
    }
    table += Row(record);
    sections += Section(record, !plots.empty());
  }
  WriteOutput(folder / "index.html",
              kHead + Summary(report) + table + "</table>\n" + sections + "</body></html>\n");
}

}  // namespace possibility::experiments
