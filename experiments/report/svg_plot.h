#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace possibility::experiments {

/// Plots omit values that are not finite, or not above zero on a logarithmic axis. Such values
/// break lines, have no marker, are no corner of a region and do not affect an axis' range.

struct PlotAxis {
  std::string label;
  std::string unit;  ///< empty: none
  bool logarithmic = false;
  std::optional<std::pair<double, double>> range;  ///< none: that of the data
};

enum class CurveStyle { kLine, kDashed, kScatter };

struct PlotCurve {
  std::string label;  ///< empty: not in the legend
  std::vector<double> x, y;
  CurveStyle style = CurveStyle::kLine;
  int color = -1;  ///< of the palette, modulo its size; -1: the next
  /// Dots on the curve.
  std::vector<double> marker_x, marker_y;
};

/// A filled area: a success region, a band between percentiles.
struct PlotRegion {
  std::string label;
  std::vector<double> x, y;  ///< corners
  int color = -1;
};

/// The region between two curves over the same x.
PlotRegion Band(const std::string& label, const std::vector<double>& x,
                const std::vector<double>& lower, const std::vector<double>& upper, int color = -1);

/// A vertical line with a label at its top.
struct PlotLine {
  double x = 0;
  std::string label;
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotRegion> regions;  ///< below everything else
  std::vector<PlotCurve> curves;
  std::vector<PlotLine> lines;
  std::vector<double> rug;  ///< short ticks on the x axis
  double width = 860;       ///< pixels, legend included
  double height = 240;      ///< of the panel with its axes; more if the legend needs it
};

/// About `count` round numbers (1, 2 or 5 times a power of ten apart) within [low, high],
/// ascending. Empty unless low < high and both are finite.
std::vector<double> LinearTicks(double low, double high, int count);
/// Powers of ten within [low, high], 0 < low < high; with 2 and 5 times them if there are few,
/// every n-th if there are many.
std::vector<double> LogarithmicTicks(double low, double high);
/// The range of an axis: padded by `padding` of its extent, and never empty.
std::pair<double, double> AxisRange(const std::vector<double>& values, bool logarithmic,
                                    double padding);
/// The number at a tick, with as many digits as the distance to the next tick needs.
std::string TickLabel(double value, double distance);
/// An SVG document of plots one above the other.
std::string SvgDocument(const std::vector<Plot>& plots);

}  // namespace possibility::experiments
