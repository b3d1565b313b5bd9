#include "collocation/study/control_jumps.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace possibility::collocation {

namespace {

/// One control of a phase at its knots.
class ControlAtKnots {
 public:
  ControlAtKnots(const PhaseTrajectory& motion, int control) : motion_(motion), control_(control) {
    const int inside = motion.scheme.num_nodes() - 1;
    for (std::size_t k = 0; k < motion.mesh.size(); ++k) {
      values_.push_back(motion.controls(control, static_cast<Eigen::Index>(k) * inside));
    }
    const auto [least, greatest] = std::minmax_element(values_.begin(), values_.end());
    range_ = *greatest - *least;
    size_ = std::max(std::abs(*least), std::abs(*greatest));
  }

  /// The jump that begins at a knot, over as few intervals as possible.
  std::optional<ControlJump> JumpAt(int knot) const {
    constexpr int kMostIntervals = 3;
    constexpr double kRounding = 1e-6;  // a constant control differs by that much
    if (range_ <= kRounding * size_) return std::nullopt;
    for (int intervals = 1; intervals <= kMostIntervals; ++intervals) {
      if (IsJump(knot, knot + intervals)) return Jump(knot, knot + intervals);
    }
    return std::nullopt;
  }

 private:
  int last() const { return static_cast<int>(values_.size()) - 1; }
  double Change(int from, int to) const { return values_[to] - values_[from]; }
  double Rate(int from, int to) const {
    return Change(from, to) / (motion_.mesh[to] - motion_.mesh[from]);
  }

  bool IsJump(int from, int to) const {
    constexpr double kShareOfRange = 0.25;
    constexpr double kSteeper = 10;
    constexpr double kLevel = 0.05;
    if (from < 1 || to + 1 > last()) return false;
    const double change = Change(from, to);
    if (std::abs(change) < kShareOfRange * range_) return false;
    for (int k = from; k < to; ++k) {
      if (Change(k, k + 1) * change < 0) return false;
    }
    const auto is_level = [&](int k) {
      return std::abs(Change(k, k + 1)) <= kLevel * std::abs(change);
    };
    const auto is_slow = [&](int k) {
      return kSteeper * std::abs(Rate(k, k + 1)) <= std::abs(Rate(from, to));
    };
    // As short as possible: the first and the last interval belong to the change.
    return is_level(from - 1) && is_slow(from - 1) && is_level(to) && is_slow(to) &&
           !is_level(from) && !is_level(to - 1);
  }

  ControlJump Jump(int from, int to) const {
    const Eigen::VectorXd weights = motion_.scheme.weights();
    const Eigen::Index nodes = weights.size();
    double integral = 0;  // over shares
    for (int k = from; k < to; ++k) {
      integral += (motion_.mesh[k + 1] - motion_.mesh[k]) *
                  motion_.controls.row(control_).segment(k * (nodes - 1), nodes).dot(weights);
    }
    ControlJump jump;
    jump.control = control_;
    jump.begin = motion_.mesh[from];
    jump.end = motion_.mesh[to];
    jump.before = values_[from];
    jump.after = values_[to];
    const double share =
        (integral - jump.after * jump.end + jump.before * jump.begin) / (jump.before - jump.after);
    jump.share = std::clamp(share, jump.begin, jump.end);
    return jump;
  }

  const PhaseTrajectory& motion_;
  int control_;
  std::vector<double> values_;  // by knot
  double range_ = 0, size_ = 0;
};

}  // namespace

std::vector<std::vector<ControlJump>> FindJumps(const Trajectory& trajectory) {
  std::vector<std::vector<ControlJump>> jumps;
  for (const PhaseTrajectory& motion : trajectory.phases) {
    auto& of_phase = jumps.emplace_back();
    for (int c = 0; c < static_cast<int>(motion.controls.rows()); ++c) {
      const ControlAtKnots control(motion, c);
      double end = 0;
      for (int knot = 0; knot < static_cast<int>(motion.mesh.size()); ++knot) {
        if (motion.mesh[knot] < end) continue;
        std::optional<ControlJump> jump = control.JumpAt(knot);
        if (!jump) continue;
        jump->phase = static_cast<int>(jumps.size()) - 1;
        end = jump->end;
        of_phase.push_back(*jump);
      }
    }
  }
  return jumps;
}

}  // namespace possibility::collocation
