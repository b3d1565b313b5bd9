#include "actions/flood/stance_cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "actions/conditions/blockers.h"
#include "actions/flood/checker_error.h"
#include "actions/flood/flood_volumes.h"
#include "actions/flood/launch_box.h"

namespace possibility::actions {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Blocks of up to 2, 4 and 8 cells along an axis can be judged closed as a whole.
constexpr int kSharedSizes[] = {2, 4, 8};

/// `boxes` swept by displacements of their stance along the world's axes, either way.
std::vector<models::Prism> Swept(const std::vector<AlignedBox3d>& boxes, const PlanarPose& middle,
                                 double z, const Vector2d& half) {
  const Eigen::Isometry3d X_WS = middle.At(z);
  const double cosine = std::abs(X_WS(0, 0)), sine = std::abs(X_WS(1, 0));
  const Vector3d growth(cosine * half.x() + sine * half.y(), sine * half.x() + cosine * half.y(),
                        0);
  std::vector<models::Prism> swept;
  swept.reserve(boxes.size());
  for (const AlignedBox3d& box : boxes) {
    swept.emplace_back(AlignedBox3d(box.min() - growth, box.max() + growth), X_WS);
  }
  return swept;
}

}  // namespace

StanceCells::StanceCells(const LocomotionModel& model, const World& world,
                         std::vector<double> heights, double margin,
                         const StanceCellSettings& settings)
    : model_(model),
      world_(world),
      heights_(std::move(heights)),
      settings_(settings),
      origin_(world.environment->bounds.min() - Vector2d::Constant(margin)),
      margin_(margin),
      checker_(*world.environment),
      free_parts_(static_cast<size_t>(num_planes() * settings.halvings), 0) {
  for (int gait = 0; gait < static_cast<int>(model.gaits.size()); ++gait) {
    volumes_.emplace_back();
    for (const std::vector<AlignedBox3d>& boxes : FloodVolumes(model, gait)) {
      volumes_.back().push_back(MakeVolume(boxes));
    }
  }
}

double StanceCells::HalfDiagonal() const { return settings_.resolution * std::numbers::sqrt2 / 2; }

double StanceCells::half_heading() const { return std::numbers::pi / settings_.headings; }

/// `boxes` narrower on every side and lower by the leniency.
std::vector<AlignedBox3d> StanceCells::Lenient(std::vector<AlignedBox3d> boxes) const {
  if (settings_.leniency == 0) return boxes;
  double top = 0;
  for (const AlignedBox3d& box : boxes) top = std::max(top, box.max().z());
  const Vector3d inward(settings_.leniency, settings_.leniency, 0);
  std::vector<AlignedBox3d> lenient;
  for (const AlignedBox3d& box : boxes) {
    AlignedBox3d left(box.min() + inward, box.max() - inward);
    left.max().z() = std::min(left.max().z(), top - settings_.leniency);
    if (left.sizes().minCoeff() > 0) lenient.push_back(left);
  }
  return lenient;
}

/// Moves every vertical side inward by `inward`, plus `inward_per_metre` for every metre that the
/// box reaches from the stance's axis.
std::vector<AlignedBox3d> StanceCells::Shrunk(const std::vector<AlignedBox3d>& boxes, double inward,
                                              double inward_per_metre) const {
  std::vector<AlignedBox3d> shrunk;
  for (const AlignedBox3d& box : boxes) {
    const Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
    const double all = inward + far.norm() * inward_per_metre + kCheckerError;
    const Vector3d margin(all, all, kCheckerError);
    if ((box.sizes() - 2 * margin).minCoeff() <= 0) continue;
    shrunk.emplace_back(box.min() + margin, box.max() - margin);
  }
  return shrunk;
}

StanceCells::Volume StanceCells::MakeVolume(const std::vector<AlignedBox3d>& boxes) const {
  Volume volume;
  volume.boxes = Lenient(boxes);
  volume.whole = models::UprightBoxes(volume.boxes);
  for (int i = 0; i <= settings_.halvings; ++i) {
    const double part = 1.0 / (1 << i);
    volume.shrunk.emplace_back(Shrunk(volume.boxes, HalfDiagonal() * part, half_heading() * part));
  }
  // Shrunk boxes may be empty. With halvings, a cell is open if the whole boxes are free at its
  // middle.
  volume.certainly_free = settings_.halvings == 0 ? volume.shrunk[0].boxes() : volume.boxes;
  for (const int size : kSharedSizes) {
    volume.shared.emplace_back(
        Shrunk(volume.boxes, HalfDiagonal() * size + kCheckerError, half_heading()));
  }
  return volume;
}

Vector2d StanceCells::NumCells() const {
  const Vector2d size = world_.environment->bounds.max() - origin_ + Vector2d::Constant(margin_);
  return (size / settings_.resolution).array().ceil() + 1;
}

int StanceCells::Layer(int gait, size_t height) const {
  return static_cast<int>(height * model_.gaits.size()) + gait;
}

int StanceCells::GaitOf(const CellBlock& block) const {
  return LayerOf(block) % static_cast<int>(model_.gaits.size());
}

double StanceCells::HeightOf(const CellBlock& block) const {
  return heights_[LayerOf(block) / model_.gaits.size()];
}

int StanceCells::Plane(int layer, int heading) const {
  const int round = heading % settings_.headings;
  return layer * settings_.headings + (round < 0 ? round + settings_.headings : round);
}

int StanceCells::PlaneOfGait(const CellBlock& block, int gait) const {
  return Plane(LayerOf(block) - GaitOf(block) + gait, HeadingOf(block));
}

int StanceCells::PlaneTurned(const CellBlock& block, int turn) const {
  return Plane(LayerOf(block), HeadingOf(block) + turn);
}

std::optional<CellBlock> StanceCells::CellOf(const GroundedStance& stance) const {
  for (size_t i = 0; i < heights_.size(); ++i) {
    if (std::abs(heights_[i] - stance.z) < 1e-6) return CellOf(Layer(stance.gait, i), stance.pose);
  }
  return std::nullopt;
}

CellBlock StanceCells::CellOf(int layer, const PlanarPose& pose) const {
  const Vector2d p = (pose.position() - origin_) / settings_.resolution;
  const double turn = std::floor((pose.yaw + half_heading()) / (2 * half_heading()));
  const double round = turn - settings_.headings * std::floor(turn / settings_.headings);
  return CellBlock::Of(Plane(layer, static_cast<int>(round)), static_cast<int>(std::floor(p.x())),
                       static_cast<int>(std::floor(p.y())));
}

bool StanceCells::Contains(const CellBlock& block) const {
  const Vector2d size = NumCells();
  return block.plane >= 0 && block.plane < num_planes() && block.x0 >= 0 && block.y0 >= 0 &&
         block.x1 <= size.x() && block.y1 <= size.y();
}

PlanarPose StanceCells::Centre(const CellBlock& block) const {
  return {origin_.x() + (block.x0 + block.x1) * 0.5 * settings_.resolution,
          origin_.y() + (block.y0 + block.y1) * 0.5 * settings_.resolution,
          HeadingOf(block) * 2 * half_heading()};
}

BlockState StanceCells::Judge(const CellBlock& block) const {
  if (block.IsCell()) {
    return MayStand(block, Centre(block), 0, OneFaceHolds(block)) ? BlockState::kOpen
                                                                  : BlockState::kClosed;
  }
  if (IsAllOpen(block)) return BlockState::kOpen;
  return IsAllClosed(block) ? BlockState::kClosed : BlockState::kMixed;
}

bool StanceCells::IsAllOpen(const CellBlock& block) const {
  const int gait = GaitOf(block);
  const PlanarPose middle = Centre(block);
  const Vector2d half =
      Vector2d(block.x1 - block.x0 - 1, block.y1 - block.y0 - 1) / 2 * settings_.resolution;
  const bool is_whole = settings_.halvings == 0;
  return std::any_of(volumes_[gait].begin(), volumes_[gait].end(),
                     [&](const Volume& volume) {
                       return checker_.AreCertainlyFree(
                           Swept(volume.certainly_free, middle, HeightOf(block), half));
                     }) &&
         GroundMayHoldAllAround(model_, *world_.ground, gait, middle, HeightOf(block),
                                settings_.leniency + (is_whole ? HalfDiagonal() : 0),
                                is_whole ? half_heading() : 0, half.norm());
}

bool StanceCells::IsAllClosed(const CellBlock& block) const {
  const int gait = GaitOf(block);
  const PlanarPose middle = Centre(block);
  const int size = std::max(block.x1 - block.x0, block.y1 - block.y0);
  if (!GroundMayHold(model_, *world_.ground, gait, middle, HeightOf(block),
                     settings_.leniency + HalfDiagonal() * (size + 1), half_heading())) {
    return true;
  }
  const auto shared = std::find_if(std::begin(kSharedSizes), std::end(kSharedSizes),
                                   [size](int shared_size) { return shared_size >= size; });
  if (shared == std::end(kSharedSizes)) return false;
  const auto index = static_cast<size_t>(shared - std::begin(kSharedSizes));
  return std::all_of(volumes_[gait].begin(), volumes_[gait].end(), [&](const Volume& volume) {
    return !volume.shared[index].boxes().empty() &&
           !checker_.AreFree(volume.shared[index], middle.At(HeightOf(block)));
  });
}

bool StanceCells::CentreStands(const CellBlock& cell) const {
  return CentreStands(GaitOf(cell), Centre(cell), HeightOf(cell), false);
}

bool StanceCells::CentreStands(int gait, const PlanarPose& centre, double z,
                               bool is_over_ground) const {
  return (is_over_ground ||
          GroundMayHold(model_, *world_.ground, gait, centre, z, settings_.leniency, 0)) &&
         std::any_of(volumes_[gait].begin(), volumes_[gait].end(), [&](const Volume& volume) {
           return checker_.AreFree(volume.whole, centre.At(z));
         });
}

/// Sufficient: true only if every stance of a cell has ground under all its bearing points.
bool StanceCells::OneFaceHolds(const CellBlock& cell) const {
  double radius = 0;
  for (const auto& points : model_.gaits[GaitOf(cell)]->stance.bearing_points) {
    for (const Vector2d& p_S : points) radius = std::max(radius, p_S.norm());
  }
  const Vector2d middle = Centre(cell).position();
  const std::vector<double>& levels = world_.ground->levels();
  for (size_t i = 0; i < levels.size(); ++i) {
    if (std::abs(levels[i] - HeightOf(cell)) > 1e-6) continue;
    const int level = static_cast<int>(i);
    if (world_.ground->OneFaceHolds(level, middle, middle, radius + HalfDiagonal())) return true;
  }
  return false;
}

/// Whether some stance may be possible in the part of a cell about `centre`, the result of
/// `halvings` halvings along every axis.
bool StanceCells::MayStand(const CellBlock& cell, const PlanarPose& centre, int halvings,
                           bool is_over_ground) const {
  const int gait = GaitOf(cell);
  const double z = HeightOf(cell);
  const int parts = 1 << halvings;
  const double place = settings_.leniency + HalfDiagonal() / parts;
  if ((!is_over_ground &&
       !GroundMayHold(model_, *world_.ground, gait, centre, z, place, half_heading() / parts)) ||
      std::none_of(volumes_[gait].begin(), volumes_[gait].end(), [&](const Volume& volume) {
        return checker_.AreFree(volume.shrunk[halvings], centre.At(z));
      })) {
    return false;
  }
  if (halvings == settings_.halvings || CentreStands(gait, centre, z, is_over_ground)) return true;
  const double shift = settings_.resolution / 4 / parts, turn = half_heading() / 2 / parts;
  // Along a wall, the part that was free in the last cell is free again.
  int& first = free_parts_[static_cast<size_t>(cell.plane * settings_.halvings + halvings)];
  for (int i = 0; i < 8; ++i) {
    const int part = (first + i) % 8;
    const PlanarPose middle{centre.x + (part & 1 ? shift : -shift),
                            centre.y + (part & 2 ? shift : -shift),
                            centre.yaw + (part & 4 ? turn : -turn)};
    if (MayStand(cell, middle, halvings + 1, is_over_ground)) {
      first = part;
      return true;
    }
  }
  return false;
}

std::vector<std::string> StanceCells::Blockers(const CellBlock& cell) const {
  const int gait = GaitOf(cell);
  const PlanarPose centre = Centre(cell);
  std::set<std::string> names;
  if (!GroundMayHold(model_, *world_.ground, gait, centre, HeightOf(cell), HalfDiagonal(),
                     half_heading())) {
    names.insert("no ground");
  }
  std::vector<models::PosedShape> posed;
  for (const Volume& volume : volumes_[gait]) {
    const models::UprightBoxes& boxes = volume.shrunk.back();
    for (size_t i = 0; i < boxes.boxes().size(); ++i) {
      posed.push_back({models::Shape::Box(boxes.boxes()[i].sizes()),
                       centre.At(HeightOf(cell)) * boxes.X_SB()[i]});
    }
  }
  for (std::string& name : actions::Blockers(*world_.environment, posed)) {
    names.insert(std::move(name));
  }
  return {names.begin(), names.end()};
}

}  // namespace possibility::actions
