#include "experiments/report/svg_plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <regex>

namespace possibility::experiments {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Whether elements nest and close, attributes are quoted, and & begins entities only.
bool IsXml(const std::string& text) {
  static const std::regex tag("<(/?)([A-Za-z]+)((?:\\s+[A-Za-z0-9:-]+=\"[^\"<]*\")*)\\s*(/?)>");
  static const std::regex bad_entity("&(?!amp;|lt;|gt;|quot;)");
  if (std::regex_search(text, bad_entity)) return false;
  std::vector<std::string> open;
  std::size_t at = 0, roots = 0;
  for (std::sregex_iterator match(text.begin(), text.end(), tag), end; match != end; ++match) {
    const std::string between = text.substr(at, match->position() - at);
    if (between.find_first_of("<>") != std::string::npos) return false;
    at = match->position() + match->length();
    const std::string name = (*match)[2];
    if ((*match)[1].length() > 0) {
      if (open.empty() || open.back() != name) return false;
      open.pop_back();
    } else {
      if (open.empty()) ++roots;
      if ((*match)[4].length() == 0) open.push_back(name);
    }
  }
  return open.empty() && roots == 1 && text.find_first_of("<>", at) == std::string::npos;
}

TEST(SvgPlot, TheXmlCheckRefusesMalformedXml) {
  EXPECT_TRUE(IsXml("<a x=\"1\"><b/>text &amp; more</a>"));
  for (const char* bad :
       {"<a><b></a>", "<a>x & y</a>", "<a>1 < 2</a>", "<a x=1/>", "", "<a/><a/>", "<a y=\"<\"/>"}) {
    EXPECT_FALSE(IsXml(bad)) << bad;
  }
}

int Occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(SvgPlot, TicksAreRoundAndFillTheRange) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-12, 12), unit(-1, 1);
  for (int round = 0; round < 2000; ++round) {
    const double low = unit(random) * std::pow(10, exponent(random));
    const double high = low + std::pow(10, exponent(random)) + 1e-6 * std::abs(low);
    const int count = 3 + round % 9;
    const std::vector<double> ticks = LinearTicks(low, high, count);
    ASSERT_GE(ticks.size(), 1U) << low << ' ' << high;
    ASSERT_LE(static_cast<int>(ticks.size()), count + 1);
    for (const double tick : ticks) {
      EXPECT_GE(tick, low - 1e-6 * (high - low));
      EXPECT_LE(tick, high + 1e-6 * (high - low));
    }
    if (ticks.size() < 2) continue;
    const double step = ticks[1] - ticks[0];
    const double mantissa = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-5 || std::abs(mantissa - 2) < 1e-5 ||
                std::abs(mantissa - 5) < 1e-5)
        << step;
  }
}

TEST(SvgPlot, TicksOfKnownRangesAreExact) {
  EXPECT_EQ(LinearTicks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(LinearTicks(-1, 1, 4), (std::vector<double>{-1, -0.5, 0, 0.5, 1}));
  EXPECT_EQ(LinearTicks(3.2, 17, 3), (std::vector<double>{5, 10, 15}));
  EXPECT_TRUE(LinearTicks(1, 1, 5).empty());
  EXPECT_TRUE(LinearTicks(kNaN, 1, 5).empty());
  EXPECT_TRUE(LinearTicks(0, HUGE_VAL, 5).empty());
}

TEST(SvgPlot, LogarithmicTicksOfKnownRangesAreExact) {
  const auto expect = [](std::vector<double> ticks, const std::vector<double>& expected) {
    ASSERT_EQ(ticks.size(), expected.size());
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      EXPECT_NEAR(ticks[i] / expected[i], 1, 1e-12);
    }
  };
  expect(LogarithmicTicks(1, 100), {1, 2, 5, 10, 20, 50, 100});
  expect(LogarithmicTicks(1e-8, 1e-3), {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3});
  EXPECT_LE(LogarithmicTicks(1e-100, 1e100).size(), 11U);
  EXPECT_TRUE(LogarithmicTicks(0, 1).empty());
  EXPECT_TRUE(LogarithmicTicks(-1, 1).empty());
}

TEST(SvgPlot, RangesExcludeNumbersThatAreNotDrawn) {
  EXPECT_EQ(AxisRange({3, kNaN, 1, HUGE_VAL, -HUGE_VAL}, false, 0), std::pair(1.0, 3.0));
  EXPECT_EQ(AxisRange({0, 10}, false, 0.1), std::pair(-1.0, 11.0));
  EXPECT_EQ(AxisRange({0, -5, 1, 100}, true, 0), std::pair(1.0, 100.0));
  EXPECT_EQ(AxisRange({}, false, 0.1), std::pair(0.0, 1.0));
  EXPECT_EQ(AxisRange({kNaN}, true, 0.1), std::pair(1.0, 10.0));
  // A constant has a range around it, and so do numbers that differ by rounding only.
  for (const double constant : {0.0, 5.0, -5.0, 1e-30}) {
    const auto [low, high] = AxisRange({constant, constant * (1 + 1e-15)}, false, 0.1);
    EXPECT_LT(low, constant);
    EXPECT_GT(high, constant);
  }
}

TEST(SvgPlot, LabelsHaveTheDigitsTheyNeed) {
  EXPECT_EQ(TickLabel(0, 0.5), "0");
  EXPECT_EQ(TickLabel(1, 0.5), "1.0");
  EXPECT_EQ(TickLabel(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(TickLabel(20, 10), "20");
  EXPECT_EQ(TickLabel(-0.05, 0.05), "\u22120.05");
  EXPECT_EQ(TickLabel(2e6, 1e6), "2e+06");
  EXPECT_EQ(TickLabel(1e-7, 1e-7), "1e-07");
}

Plot Example() {
  Plot plot;
  plot.title = "a < b & \"c\"\n";
  plot.x = {"time", "s", false, {}};
  plot.y = {"height", "m", false, {}};
  plot.curves.push_back({"up", {0, 1, 2, 3}, {0, 1, 4, 9}, CurveStyle::kLine, -1, {0, 3}, {0, 9}});
  return plot;
}

TEST(SvgPlot, IsXmlForAnyNames) {
  const std::string svg = SvgDocument({Example(), Example()});
  EXPECT_TRUE(IsXml(svg));
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot; "), std::string::npos);
  EXPECT_NE(svg.find("time (s)"), std::string::npos);
  EXPECT_NE(svg.find("height (m)"), std::string::npos);
  EXPECT_EQ(Occurrences(svg, "<circle"), 4);
  EXPECT_TRUE(IsXml(SvgDocument({})));
  EXPECT_TRUE(IsXml(SvgDocument({Plot{}})));
}

TEST(SvgPlot, NonFiniteNumbersBreakTheLine) {
  Plot plot = Example();
  const auto moves = [](const Plot& p) {
    const std::string svg = SvgDocument({p});
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf"), std::string::npos);
    const auto begin = svg.find("<g clip-path");
    const auto path = svg.find("<path d=\"", begin);
    return Occurrences(svg.substr(path, svg.find("\" class", path) - path), "M");
  };
  EXPECT_EQ(moves(plot), 1);
  plot.curves[0].y[1] = kNaN;
  EXPECT_EQ(moves(plot), 2);
  plot.curves[0].y = {0, 1, HUGE_VAL, 3};
  plot.curves[0].marker_y = {kNaN, HUGE_VAL};
  EXPECT_EQ(moves(plot), 2);
  plot.y.logarithmic = true;  // 0 is not on it
  EXPECT_EQ(moves(plot), 2);
  plot.curves[0].y = {-1, 1, -1, 1};
  EXPECT_EQ(moves(plot), 2);
}

TEST(SvgPlot, AnEmptyPlotIsStillAPicture) {
  Plot plot = Example();
  plot.curves[0].y = {kNaN, kNaN, kNaN, kNaN};
  plot.curves[0].marker_y = {kNaN, kNaN};
  const std::string svg = SvgDocument({plot});
  EXPECT_TRUE(IsXml(svg));
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

TEST(SvgPlot, RegionsScatterAndLinesAreDrawn) {
  Plot plot;
  plot.regions.push_back(Band("5 to 95 %", {1, 2, 3}, {1, 1, 1}, {2, 3, 2}));
  ASSERT_EQ(plot.regions[0].x, (std::vector<double>{1, 2, 3, 3, 2, 1}));
  EXPECT_EQ(plot.regions[0].y, (std::vector<double>{1, 1, 1, 2, 3, 2}));
  plot.curves.push_back({"runs", {1, 2, kNaN}, {1, 2, 3}, CurveStyle::kScatter, 2, {}, {}});
  plot.curves.push_back({"mean", {1, 3}, {1.5, 1.6}, CurveStyle::kDashed, -1, {}, {}});
  plot.lines.push_back({2, "landing"});
  const std::string svg = SvgDocument({plot});
  EXPECT_TRUE(IsXml(svg));
  EXPECT_EQ(Occurrences(svg, "<polygon"), 1);
  EXPECT_EQ(Occurrences(svg, "<circle"), 3);  // two runs and the legend's
  EXPECT_EQ(Occurrences(svg, ">landing<"), 1);
  EXPECT_EQ(Occurrences(svg, "stroke-dasharray=\"6 4\""), 2);
}

}  // namespace
}  // namespace possibility::experiments
