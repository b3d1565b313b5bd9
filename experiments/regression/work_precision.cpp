#include "experiments/regression/work_precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "common/stopwatch.h"

namespace possibility::experiments {
namespace {

constexpr std::array<double, 5> kShares = {0.25, 0.5, 1, 2, 4};  // of a problem's own intervals
constexpr int kFewestIntervals = 2;
constexpr int kMostRepeats = 3;
constexpr double kLongEnough = 1;  // s: nothing is repeated beyond

std::vector<collocation::TranscriptionScheme> SchemesOf(const RegressionOptions& options) {
  if (options.scheme) return {*options.scheme};
  return {collocation::HermiteSimpson(), collocation::CompressedHermiteSimpson(),
          collocation::Trapezoidal()};
}

std::vector<int> MeshesOf(const RegressionProblem& problem, const RegressionOptions& options) {
  const int own = options.intervals.value_or(problem.intervals);
  std::vector<int> meshes;
  meshes.reserve(kShares.size());
  for (const double share : kShares) {
    meshes.push_back(std::max(kFewestIntervals, static_cast<int>(std::lround(share * own))));
  }
  meshes.erase(std::unique(meshes.begin(), meshes.end()), meshes.end());
  return meshes;
}

WorkPrecisionPoint Measure(const RegressionProblem& problem, const RegressionOptions& options) {
  WorkPrecisionPoint point{
      options.scheme->name, *options.intervals, {}, 0, 0, std::numeric_limits<double>::infinity()};
  const Stopwatch stopwatch;
  for (int repeat = 0; repeat < kMostRepeats; ++repeat) {
    if (repeat > 0 && stopwatch.Seconds() > kLongEnough) break;
    const RegressionRecord record = RunProblem(problem, options);
    point.status = record.status;
    point.relative_error = record.relative_error;
    point.iterations = record.iterations;
    point.seconds = std::min(point.seconds, record.seconds.total);
  }
  return point;
}

}  // namespace

std::vector<WorkPrecisionPoint> MeasureWorkPrecision(
    const RegressionProblem& problem, const RegressionOptions& options,
    const std::function<void(int, int)>& progress) {
  RegressionProblem fixed = problem;
  fixed.mesh_tolerance = 0;
  RegressionOptions run = options;
  run.second_order_check = false;
  const auto schemes = SchemesOf(options);
  const std::vector<int> meshes = MeshesOf(problem, options);
  std::vector<WorkPrecisionPoint> points;
  for (const auto& scheme : schemes) {
    for (const int intervals : meshes) {
      progress(static_cast<int>(points.size()), static_cast<int>(schemes.size() * meshes.size()));
      run.scheme = scheme;
      run.intervals = intervals;
      points.push_back(Measure(fixed, run));
    }
  }
  return points;
}

Plot WorkPrecisionPlot(const RegressionRecord& record) {
  Plot plot;
  plot.title = "Work and precision";
  plot.x = {"time", "s", true, {}};
  plot.y = {"relative error", "", true, {}};
  std::vector<double> seconds;
  std::map<std::string, PlotCurve> curves;
  for (const WorkPrecisionPoint& point : record.work_precision) {
    PlotCurve& curve = curves[point.scheme];
    curve.label = point.scheme;
    seconds.push_back(point.seconds);
    // An answer without any error would have no place on the axis.
    const double error = std::max(point.relative_error, std::numeric_limits<double>::epsilon());
    const bool solved = point.status == "solved" || point.status == "acceptable";
    curve.x.push_back(point.seconds);
    curve.y.push_back(solved ? error : std::numeric_limits<double>::quiet_NaN());
  }
  for (auto& [scheme, curve] : curves) {
    curve.marker_x = curve.x;
    curve.marker_y = curve.y;
    plot.curves.push_back(std::move(curve));
  }
  if (!seconds.empty()) {
    const auto [least, most] = std::minmax_element(seconds.begin(), seconds.end());
    PlotCurve digits;
    digits.label = "digits of the source";
    digits.style = CurveStyle::kDashed;
    digits.x = {*least, *most};
    digits.y.assign(2, record.nearest.tolerance);
    plot.curves.push_back(std::move(digits));
  }
  return plot;
}

}  // namespace possibility::experiments
