#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <queue>
#include <vector>

#include "actions/footholds/foothold_cells.h"
#include "actions/footholds/footstep.h"
#include "actions/wholebody/nominal_stance.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

/// How long steps take from a foothold to some goals, at least roughly: Dijkstra's algorithm over
/// the cells of a grid on every plane of the ground. It knows which ground a step leads to from
/// which, and at what cost, but neither headings nor which foot is whose. It runs as far as the
/// questions need. One thread at a time.
class FootholdField {
 public:
  /// Of a step from one foothold to the next, the other limb's: by their distance, seen from above,
  /// and by how much higher or lower it leads; infinite if it is none.
  struct StepTimes {
    double spacing = 0.02;  ///< m, of distances and heights
    std::vector<std::vector<double>>
        times;        ///< s, by height and distance from 0 on; longer steps take no less
    double pace = 1;  ///< s/m, where all around is ground

    /// By distance; none if that is too high.
    const std::vector<double>* Over(double rise) const;
  };

  /// `goal_times`: what each goal's times begin with, s; empty: 0. References must outlive this.
  FootholdField(const FootholdCells& cells, const NominalStance& stance, const World& world,
                const FootstepLimits& limits, const std::vector<GroundedStance>& goals,
                const std::vector<double>& goal_times, StepTimes steps);

  // A layer is a plane, as an index into FootholdCells::planes().
  /// From the layer's ground nearest to a place of the limb, s. Infinite if there is none near it,
  /// or no steps lead from there. @throws Cancelled.
  double At(int limb, const PlanarPose& stance, int layer,
            const CancellationToken& cancellation = {});
  /// From the layer's ground nearest to the middle of a stance, s. Infinite if it is so far away
  /// that one cannot stand on it about that middle.
  double Near(int layer, const Eigen::Vector2d& p, const CancellationToken& cancellation = {});
  /// The longest that one step takes, s.
  double LongestStep() const;

 private:
  using Place = FootholdCells::Place;

  /// A cell that a way leads to, with its time.
  struct Entry {
    double time = 0;
    std::size_t index = 0;
    bool operator>(const Entry& other) const {
      return time != other.time ? time > other.time : index > other.index;
    }
  };
  /// A cell about another one.
  struct Offset {
    int column = 0, row = 0;
    double distance = 0;  ///< m
    std::size_t bin = 0;  ///< of StepTimes: the least distance of two places in the cells
  };

  void Begin(const std::vector<GroundedStance>& goals, const std::vector<double>& goal_times);
  void Offer(const Place& place, double time);
  void Visit(const Entry& at);
  void VisitPlane(const Place& from, double time, int plane);
  double Nearest(int layer, const Eigen::Vector2d& p, double most,
                 const CancellationToken& cancellation);
  double TimeOf(const Place& place, const CancellationToken& cancellation);

  const FootholdCells& cells_;
  const NominalStance& stance_;
  const World& world_;
  FootstepLimits limits_;
  StepTimes steps_;
  std::vector<Offset> disc_;   ///< of a step, the nearest first
  std::vector<double> times_;  ///< final up to the time of the queue's first entry
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::size_t visited_ = 0;
};

}  // namespace possibility::actions
