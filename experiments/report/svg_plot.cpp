#include "experiments/report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/support/xml_text.h"

namespace possibility::experiments {
namespace {

// Distinguishable for colour-blind readers, and dark enough for thin lines on white.
constexpr std::array<const char*, 10> kPalette = {"#0b6fb8", "#d9480f", "#2b8a3e", "#9c36b5",
                                                  "#b8860b", "#0c8599", "#c2255c", "#5c5f66",
                                                  "#6741d9", "#74480f"};
constexpr double kLeft = 78, kTop = 32, kBottom = 46, kGap = 18, kLegend = 170, kLegendLine = 17;

const char* Color(int index) { return kPalette[index % kPalette.size()]; }

bool IsDrawable(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

/// Maps a quantity to pixels.
class Scale {
 public:
  Scale(std::pair<double, double> range, bool logarithmic, double from, double to)
      : logarithmic_(logarithmic),
        low_(Mapped(range.first)),
        high_(Mapped(range.second)),
        from_(from),
        to_(to) {}

  bool Shows(double value) const { return IsDrawable(value, logarithmic_); }
  bool Contains(double value) const {
    const double slack = 1e-9 * (high_ - low_);
    return Shows(value) && Mapped(value) >= low_ - slack && Mapped(value) <= high_ + slack;
  }
  double operator()(double value) const {
    const double share = (Mapped(value) - low_) / (high_ - low_);
    // Clamps points far outside, to stay within the number range of renderers.
    return from_ + std::clamp(share, -100.0, 100.0) * (to_ - from_);
  }

 private:
  double Mapped(double value) const { return logarithmic_ ? std::log10(value) : value; }

  bool logarithmic_;
  double low_, high_, from_, to_;
};

struct Panel {
  const Plot* plot;
  double left, top, right, bottom;
  Scale x, y;
};

void Append(std::vector<double>* to, const std::vector<double>& from) {
  to->insert(to->end(), from.begin(), from.end());
}

std::pair<double, double> RangeOf(const Plot& plot, bool is_x) {
  const PlotAxis& axis = is_x ? plot.x : plot.y;
  if (axis.range) return *axis.range;
  std::vector<double> values;
  for (const PlotCurve& curve : plot.curves) {
    Append(&values, is_x ? curve.x : curve.y);
    Append(&values, is_x ? curve.marker_x : curve.marker_y);
  }
  for (const PlotRegion& region : plot.regions) Append(&values, is_x ? region.x : region.y);
  if (is_x) {
    for (const PlotLine& line : plot.lines) values.push_back(line.x);
    Append(&values, plot.rug);
  }
  return AxisRange(values, axis.logarithmic, is_x ? 0 : 0.06);
}

std::vector<std::string> LegendLabels(const Plot& plot) {
  std::vector<std::string> labels;
  for (const PlotCurve& curve : plot.curves) labels.push_back(curve.label);
  for (const PlotRegion& region : plot.regions) labels.push_back(region.label);
  std::erase(labels, "");
  return labels;
}

/// Wide enough for the longest label. Without a legend: a margin.
double LegendWidth(const Plot& plot) {
  constexpr double kCharacter = 6.5, kSign = 45, kMargin = 20;
  const std::vector<std::string> labels = LegendLabels(plot);
  if (labels.empty()) return kMargin;
  double width = kLegend;
  for (const std::string& label : labels) {
    width = std::max(width, kSign + kCharacter * static_cast<double>(label.size()));
  }
  return width;
}

double HeightOf(const Plot& plot) {
  return std::max(plot.height,
                  kTop + kBottom + kLegendLine * static_cast<double>(LegendLabels(plot).size()));
}

Panel PanelOf(const Plot& plot, double top) {
  const double right = plot.width - LegendWidth(plot);
  const double bottom = top + HeightOf(plot) - kBottom;
  return {&plot,
          kLeft,
          top + kTop,
          right,
          bottom,
          Scale(RangeOf(plot, true), plot.x.logarithmic, kLeft, right),
          Scale(RangeOf(plot, false), plot.y.logarithmic, bottom, top + kTop)};
}

std::string Text(double x, double y, const char* style, const std::string& text) {
  return fmt::format("<text x=\"{:.2f}\" y=\"{:.2f}\" {}>{}</text>\n", x, y, style, XmlText(text));
}

std::string Stroke(double x1, double y1, double x2, double y2, const char* style) {
  return fmt::format("<path d=\"M{:.2f} {:.2f}L{:.2f} {:.2f}\" {}/>\n", x1, y1, x2, y2, style);
}

std::string AxisTitle(const PlotAxis& axis) {
  if (axis.unit.empty()) return axis.label;
  return axis.label.empty() ? axis.unit : axis.label + " (" + axis.unit + ")";
}

std::vector<double> TicksOf(const PlotAxis& axis, std::pair<double, double> range, double pixels,
                            double distance) {
  if (axis.logarithmic) return LogarithmicTicks(range.first, range.second);
  return LinearTicks(range.first, range.second, std::max(3, static_cast<int>(pixels / distance)));
}

std::string LabelOf(const PlotAxis& axis, const std::vector<double>& ticks, double tick) {
  const double distance = ticks.size() > 1 && !axis.logarithmic ? ticks[1] - ticks[0] : tick;
  return TickLabel(tick, distance);
}

std::string Axes(const Panel& panel) {
  const Plot& plot = *panel.plot;
  std::string svg = fmt::format(
      "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#fcfcfd\"/>\n",
      panel.left, panel.top, panel.right - panel.left, panel.bottom - panel.top);
  const auto xs = TicksOf(plot.x, RangeOf(plot, true), panel.right - panel.left, 95);
  const auto ys = TicksOf(plot.y, RangeOf(plot, false), panel.bottom - panel.top, 28);
  for (const double tick : xs) {
    const double x = panel.x(tick);
    svg += Stroke(x, panel.top, x, panel.bottom, "class=\"grid\"");
    svg += Text(x, panel.bottom + 16, "class=\"tick\" text-anchor=\"middle\"",
                LabelOf(plot.x, xs, tick));
  }
  for (const double tick : ys) {
    const double y = panel.y(tick);
    svg += Stroke(panel.left, y, panel.right, y, "class=\"grid\"");
    svg += Text(panel.left - 7, y + 4, "class=\"tick\" text-anchor=\"end\"",
                LabelOf(plot.y, ys, tick));
  }
  svg += fmt::format("<path d=\"M{:.2f} {:.2f}V{:.2f}H{:.2f}\" class=\"axis\"/>\n", panel.left,
                     panel.top, panel.bottom, panel.right);
  svg += Text((panel.left + panel.right) / 2, panel.bottom + 35,
              "class=\"label\" text-anchor=\"middle\"", AxisTitle(plot.x));
  const double middle = (panel.top + panel.bottom) / 2;
  svg += fmt::format(
      "<text transform=\"translate({:.2f} {:.2f}) rotate(-90)\" class=\"label\" "
      "text-anchor=\"middle\">{}</text>\n",
      18.0, middle, XmlText(AxisTitle(plot.y)));
  return svg + Text(panel.left, panel.top - 11, "class=\"title\"", plot.title);
}

/// The path through all drawable points, broken where a point is not drawable.
std::string Path(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y) {
  std::string path;
  bool is_broken = true;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!panel.x.Shows(x[i]) || !panel.y.Shows(y[i])) {
      is_broken = true;
      continue;
    }
    path += fmt::format("{}{:.2f} {:.2f}", is_broken ? 'M' : 'L', panel.x(x[i]), panel.y(y[i]));
    is_broken = false;
  }
  return path;
}

std::string Dots(const Panel& panel, const std::vector<double>& x, const std::vector<double>& y,
                 const char* color, double radius) {
  std::string svg;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!panel.x.Contains(x[i]) || !panel.y.Contains(y[i])) continue;
    svg += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{}\" fill=\"{}\"/>\n",
                       panel.x(x[i]), panel.y(y[i]), radius, color);
  }
  return svg;
}

std::string CurveSvg(const Panel& panel, const PlotCurve& curve, const char* color) {
  if (curve.style == CurveStyle::kScatter) {
    return Dots(panel, curve.x, curve.y, color, 3);
  }
  const std::string path = Path(panel, curve.x, curve.y);
  std::string svg;
  if (!path.empty()) {
    svg = fmt::format("<path d=\"{}\" class=\"curve\" stroke=\"{}\"{}/>\n", path, color,
                      curve.style == CurveStyle::kDashed ? " stroke-dasharray=\"6 4\"" : "");
  }
  return svg + Dots(panel, curve.marker_x, curve.marker_y, color, 2.1);
}

std::string RegionSvg(const Panel& panel, const PlotRegion& region, const char* color) {
  std::string points;
  for (std::size_t i = 0; i < std::min(region.x.size(), region.y.size()); ++i) {
    if (!panel.x.Shows(region.x[i]) || !panel.y.Shows(region.y[i])) continue;
    points += fmt::format("{:.2f},{:.2f} ", panel.x(region.x[i]), panel.y(region.y[i]));
  }
  return fmt::format("<polygon points=\"{}\" fill=\"{}\" fill-opacity=\"0.18\"/>\n", points, color);
}

std::string Marks(const Panel& panel) {
  std::string svg;
  for (const double x : panel.plot->rug) {
    if (!panel.x.Contains(x)) continue;
    svg += Stroke(panel.x(x), panel.bottom, panel.x(x), panel.bottom - 5, "class=\"rug\"");
  }
  for (const PlotLine& line : panel.plot->lines) {
    if (!panel.x.Contains(line.x)) continue;
    const double x = panel.x(line.x);
    svg += Stroke(x, panel.top, x, panel.bottom, "class=\"boundary\"");
    svg += Text(x + 4, panel.top + 11, "class=\"tick\"", line.label);
  }
  return svg;
}

/// The contents of the axes, and the legend beside them.
std::string Content(const Panel& panel, int number) {
  const std::string clip = fmt::format("panel{}", number);
  std::string inside, legend;
  int next = 0;
  double y = panel.top + 9;
  const double x = panel.right + 16;
  const auto enter = [&](const std::string& label, const std::string& sign) {
    if (label.empty()) return;
    legend += sign + Text(x + 27, y + 4, "class=\"tick\"", label);
    y += kLegendLine;
  };
  for (const PlotRegion& region : panel.plot->regions) {
    const char* color = Color(region.color < 0 ? next++ : region.color);
    inside += RegionSvg(panel, region, color);
    enter(region.label, fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"20\" height=\"10\" "
                                    "fill=\"{}\" fill-opacity=\"0.3\"/>\n",
                                    x, y - 5, color));
  }
  inside += Marks(panel);
  for (const PlotCurve& curve : panel.plot->curves) {
    const char* color = Color(curve.color < 0 ? next++ : curve.color);
    inside += CurveSvg(panel, curve, color);
    enter(curve.label,
          curve.style == CurveStyle::kScatter
              ? fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"3\" fill=\"{}\"/>\n", x + 10,
                            y, color)
              : fmt::format("<path d=\"M{:.2f} {:.2f}h20\" class=\"curve\" stroke=\"{}\"{}/>\n", x,
                            y, color,
                            curve.style == CurveStyle::kDashed ? " stroke-dasharray=\"6 4\"" : ""));
  }
  return fmt::format(
      "<clipPath id=\"{}\"><rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>"
      "</clipPath>\n<g clip-path=\"url(#{})\">\n{}</g>\n{}",
      clip, panel.left - 3, panel.top - 3, panel.right - panel.left + 6,
      panel.bottom - panel.top + 6, clip, inside, legend);
}

constexpr const char* kPlotStyle =
    "<style>text{font-family:system-ui,\"DejaVu Sans\",Arial,sans-serif;fill:#343a40}"
    ".title{font-size:14px;font-weight:600;fill:#212529}.label{font-size:12px}"
    ".tick{font-size:11px;fill:#495057}.grid{stroke:#e4e7eb;stroke-width:1;fill:none}"
    ".axis{stroke:#868e96;stroke-width:1.2;fill:none}"
    ".curve{stroke-width:1.7;fill:none;stroke-linejoin:round}"
    ".rug{stroke:#adb5bd;stroke-width:1}"
    ".boundary{stroke:#868e96;stroke-width:1;stroke-dasharray:3 3;fill:none}</style>\n";

}  // namespace

PlotRegion Band(const std::string& label, const std::vector<double>& x,
                const std::vector<double>& lower, const std::vector<double>& upper, int color) {
  PlotRegion region{label, x, lower, color};
  region.x.insert(region.x.end(), x.rbegin(), x.rend());
  region.y.insert(region.y.end(), upper.rbegin(), upper.rend());
  return region;
}

std::vector<double> LinearTicks(double low, double high, int count) {
  const double extent = high - low;
  if (!(extent > 0) || !std::isfinite(extent) || count < 1) return {};
  const double power = std::pow(10, std::floor(std::log10(extent / count)));
  double step = 10 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (extent / (factor * power) <= count * 1.0001) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  const double slack = 1e-9 * step;
  for (double n = std::ceil((low - slack) / step); n * step <= high + slack; ++n) {
    ticks.push_back(n == 0 ? 0 : n * step);
    if (ticks.size() > 2 * static_cast<std::size_t>(count) + 2)
      break;  // steps below the precision of doubles
  }
  return ticks;
}

std::vector<double> LogarithmicTicks(double low, double high) {
  if (!(low > 0 && low < high) || !std::isfinite(high)) return {};
  constexpr int kMostTicks = 9;
  const int first = static_cast<int>(std::floor(std::log10(low)));
  const int last = static_cast<int>(std::ceil(std::log10(high)));
  const int every = std::max(1, (last - first + kMostTicks - 1) / kMostTicks);
  std::vector<double> ticks;
  for (int exponent = first; exponent <= last; exponent += every) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor > 1 && last - first > 3) break;
      const double tick = factor * std::pow(10, exponent);
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::pair<double, double> AxisRange(const std::vector<double>& values, bool logarithmic,
                                    double padding) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const double value : values) {
    if (!IsDrawable(value, logarithmic)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return logarithmic ? std::pair{1.0, 10.0} : std::pair{0.0, 1.0};
  if (logarithmic) {
    const double factor = low == high ? 2 : std::pow(high / low, padding);
    return {low / factor, high * factor};
  }
  // Variation due to rounding counts as constant.
  const double least = std::max(1e-9 * std::max(std::abs(low), std::abs(high)), 1e-300);
  const bool is_constant = high - low <= least;
  const double margin = !is_constant         ? padding * (high - low)
                        : std::abs(high) > 0 ? 0.1 * std::abs(high)
                                             : 1;
  return {low - margin, high + margin};
}

std::string TickLabel(double value, double distance) {
  const double size = std::max(std::abs(value), std::abs(distance));
  std::string text;
  if (value == 0) {
    text = "0";
  } else if (size >= 1e6 || std::abs(distance) < 1e-4) {
    text = fmt::format("{:.6g}", value);
  } else {
    const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(distance) + 1e-9)));
    text = fmt::format("{:.{}f}", value, digits);
  }
  if (text.front() == '-') text.replace(0, 1, "\u2212");
  return text;
}

std::string SvgDocument(const std::vector<Plot>& plots) {
  double width = 0, height = 0;
  std::string content;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const Panel panel = PanelOf(plots[i], height);
    content += Axes(panel) + Content(panel, static_cast<int>(i));
    width = std::max(width, plots[i].width);
    height += HeightOf(plots[i]) + kGap;
  }
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n{2}<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n{3}</svg>\n",
      width, height, kPlotStyle, content);
}

}  // namespace possibility::experiments
