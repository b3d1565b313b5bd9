#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <vector>

#include "actions/footsteps/footstep.h"
#include "actions/footsteps/ground_cover.h"
#include "actions/motion/nominal_stance.h"
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

  /// `planes`: of the ground, those that a foot may bear on. `goal_times`: what each goal's times
  /// begin with, s; empty: 0. References must outlive this.
  FootholdField(const NominalStance& stance, const World& world, const std::vector<int>& planes,
                const FootstepLimits& limits, const std::vector<GroundedStance>& goals,
                const std::vector<double>& goal_times, StepTimes steps);

  // A layer is a plane, as an index into `planes`.
  /// From the layer's ground nearest to a place of the limb, s. Infinite if there is none near it,
  /// or no steps lead from there. @throws Cancelled.
  double At(int limb, const PlanarPose& stance, int layer,
            const CancellationToken& cancellation = {});
  /// From the layer's ground nearest to the middle of a stance, s. Infinite if it is so far away
  /// that one cannot stand on it about that middle.
  double Near(int layer, const Eigen::Vector2d& p, const CancellationToken& cancellation = {});
  /// Whether both limbs find ground about the middle of a stance, in its heading, so that one can
  /// pass the other: their patches are beside each other, `gap` (m) apart. Knows ground as finely
  /// as the cells are.
  bool Stands(int layer, const PlanarPose& middle, double gap);
  /// The longest that one step takes, s.
  double LongestStep() const;

 private:
  enum class Cell : signed char { kUnknown, kNoGround, kGround };

  /// A cell that a way leads to, with its time.
  struct Entry {
    double time = 0;
    std::size_t index = 0;
    bool operator>(const Entry& other) const {
      return time != other.time ? time > other.time : index > other.index;
    }
  };
  struct Place {
    int plane = 0, column = 0, row = 0;  ///< the plane as an index into planes_
  };
  /// A cell about another one.
  struct Offset {
    int column = 0, row = 0;
    double distance = 0;  ///< m
    std::size_t bin = 0;  ///< of StepTimes: the least distance of two places in the cells
  };

  void SizeGrid();
  void Begin(const std::vector<GroundedStance>& goals, const std::vector<double>& goal_times);
  bool IsInGrid(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns_ && row < rows_;
  }
  std::size_t IndexOf(const Place& place) const {
    return (static_cast<std::size_t>(place.plane) * rows_ + place.row) * columns_ + place.column;
  }
  Place PlaceOf(std::size_t index) const;
  Place PlaceAt(int plane, const Eigen::Vector2d& p) const;
  Eigen::Vector2d CentreOf(const Place& place) const {
    return bounds_.min() + cell_ * Eigen::Vector2d(place.column + 0.5, place.row + 0.5);
  }
  double HeightOf(const Place& place) const;
  bool IsHorizontal(int plane) const;
  bool MayBear(const Place& place) const;
  bool IsGround(const Place& place);
  /// Layers with ground on which one could stand about a place, and -1.
  const std::vector<int>& LayersAbout(const Place& place);
  /// A sole, turned so, with its centre at the cell's.
  bool Fits(const Place& place, int turn);
  bool IsInside(const Place& place);
  void Offer(const Place& place, double time);
  void Visit(const Entry& at);
  void VisitPlane(const Place& from, double time, int plane);
  double Nearest(int layer, const Eigen::Vector2d& p, double most,
                 const CancellationToken& cancellation);
  double TimeOf(const Place& place, const CancellationToken& cancellation);

  const NominalStance& stance_;
  const World& world_;
  const std::vector<int>& planes_;
  FootstepLimits limits_;
  StepTimes steps_;
  std::vector<std::vector<Eigen::Vector2d>> soles_;  ///< from their centres, turned
  double radius_ = 0;                                ///< m, of the soles
  double width_ = 0;                                 ///< m, of the widest sole
  double reach_;                                     ///< m, of a step
  GroundCover cover_;
  Eigen::AlignedBox2d bounds_;
  double cell_ = 0;  ///< m
  int columns_ = 0, rows_ = 0;
  std::vector<Offset> disc_;  ///< of a step, the nearest first
  std::vector<Cell> cells_;
  std::vector<std::vector<int>> layers_about_;  ///< by place; empty: not asked yet
  std::vector<std::uint32_t> fits_;  ///< by cell: a bit for each turn that fits, and that is known
  std::vector<double> times_;        ///< final up to the time of the queue's first entry
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
  std::size_t visited_ = 0;
};

}  // namespace possibility::actions
