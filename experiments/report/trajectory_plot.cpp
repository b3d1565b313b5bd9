#include "experiments/report/trajectory_plot.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace possibility::experiments {
namespace {

using collocation::PhaseTrajectory;
using collocation::StoredSolution;

constexpr std::size_t kMostDottedKnots = 130;  // more dots hide the curve

/// Content of one panel: names of a phase's quantities and their values at a fraction of the phase.
struct Group {
  std::string title;
  std::function<std::vector<std::string>(std::size_t phase)> names;
  std::function<Eigen::VectorXd(const PhaseTrajectory&, double share)> values;
};

PlotCurve& CurveOf(const std::string& name, Plot* plot) {
  for (PlotCurve& curve : plot->curves) {
    if (curve.label == name) return curve;
  }
  plot->curves.push_back({name, {}, {}, CurveStyle::kLine, -1, {}, {}});
  return plot->curves.back();
}

/// Every interval has its own samples from knot to knot, so that jumps at knots are visible.
void AddPhase(const Group& group, std::size_t phase, const PhaseTrajectory& motion, bool dots,
              Plot* plot) {
  const std::size_t intervals = motion.mesh.size() - 1;
  const int samples = static_cast<int>(std::clamp<std::size_t>(600 / intervals, 2, 24));
  const std::vector<std::string> names = group.names(phase);
  const auto time = [&](double share) { return motion.begin + share * motion.duration; };
  for (std::size_t i = 0; i < intervals; ++i) {
    for (int k = 0; k <= samples; ++k) {
      const bool is_last = i + 1 == intervals;
      if (k == samples && !is_last) continue;  // the next interval's first
      const double share = motion.mesh[i] + (motion.mesh[i + 1] - motion.mesh[i]) * k / samples;
      const Eigen::VectorXd values = group.values(motion, share);
      for (std::size_t n = 0; n < names.size(); ++n) {
        PlotCurve& curve = CurveOf(names[n], plot);
        const double value = values[static_cast<Eigen::Index>(n)];
        curve.x.push_back(time(share));
        curve.y.push_back(value);
        const bool is_knot = k == 0 || k == samples;
        if (!dots || !is_knot) continue;
        curve.marker_x.push_back(time(share));
        curve.marker_y.push_back(value);
      }
    }
  }
  for (const std::string& name : names) {  // the next phase begins anew
    PlotCurve& curve = CurveOf(name, plot);
    curve.x.push_back(std::numeric_limits<double>::quiet_NaN());
    curve.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }
}

std::vector<std::string> Primed(std::vector<std::string> names) {
  for (std::string& name : names) name += "'";
  return names;
}

}  // namespace

std::vector<Plot> TrajectoryPlots(const StoredSolution& solution) {
  const std::vector<Group> groups = {
      {"Coordinates", [&](std::size_t p) { return solution.phases[p].coordinates; },
       [](const PhaseTrajectory& motion, double s) { return motion.Coordinates(s); }},
      {"Rates", [&](std::size_t p) { return Primed(solution.phases[p].coordinates); },
       [](const PhaseTrajectory& motion, double s) { return motion.Coordinates(s, 1); }},
      {"Controls", [&](std::size_t p) { return solution.phases[p].controls; },
       [](const PhaseTrajectory& motion, double s) { return motion.Controls(s); }}};
  std::size_t knots = 0;
  for (const PhaseTrajectory& motion : solution.trajectory.phases) knots += motion.mesh.size();
  std::vector<Plot> plots;
  for (const Group& group : groups) {
    Plot plot;
    plot.title = group.title;
    plot.x = {"time", "s", false, {}};
    for (std::size_t p = 0; p < solution.phases.size(); ++p) {
      const PhaseTrajectory& motion = solution.trajectory.phases[p];
      AddPhase(group, p, motion, knots <= kMostDottedKnots, &plot);
      for (const double share : motion.mesh) {
        plot.rug.push_back(motion.begin + share * motion.duration);
      }
      if (solution.phases.size() > 1)
        plot.lines.push_back({motion.begin, solution.phases[p].phase});
    }
    if (!plot.curves.empty()) plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace possibility::experiments
