#include "actions/conditions/quasi_static_action.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>
#include <utility>

#include "actions/conditions/blockers.h"
#include "actions/conditions/exploration_pose.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Headings agree when closer than this, rad.
constexpr double kSameHeading = 1e-7;

/// Sample spacing of C_N along an edge, m.
constexpr double kNecessarySpacing = 0.05;

/// Upper bound of the error of two distances to the edge of the ground together, m.
constexpr double kGroundError = 3e-6;

/// Motion of a stance S about its middle pose: up to `half_way` (m, along the middle pose's axes)
/// either way, and up to an angle (at most 90 degrees) either way.
struct Excursion {
  Vector2d half_way;
  double sine;     ///< of the angle
  double versine;  ///< 1 - its cosine
};

/// Bound of the space that a box fixed to S covers meanwhile.
Eigen::AlignedBox3d Swept(const Eigen::AlignedBox3d& box, const Excursion& excursion) {
  const Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
  const Vector2d growth = excursion.half_way.cwiseAbs() +
                          Vector2d(excursion.sine * far.y() + excursion.versine * far.x(),
                                   excursion.sine * far.x() + excursion.versine * far.y());
  const Vector3d grown(growth.x(), growth.y(), 0);
  return {box.min() - grown, box.max() + grown};
}

double RadiusOf(const std::vector<Eigen::AlignedBox3d>& boxes) {
  double radius = 0;
  for (const Eigen::AlignedBox3d& box : boxes) {
    const Vector2d far = box.min().head<2>().cwiseAbs().cwiseMax(box.max().head<2>().cwiseAbs());
    radius = std::max(radius, far.norm());
  }
  return radius;
}

/// Largest displacement of a volume along its axes between two samples, for strides of a class, if
/// no point moves farther than `inflation`, m.
Vector2d BetweenSamples(StrideClass strides, double inflation) {
  if (strides == StrideClass::kStraight) return {inflation, 0};
  if (strides == StrideClass::kSideways) return {0, inflation};
  return {inflation, inflation};
}

Isometry3d WithHeading(const Isometry3d& X_WR, double heading) {
  Isometry3d turned = X_WR;
  const double turn = heading - Heading(X_WR.linear());
  turned.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()) * X_WR.linear();
  return turned;
}

/// The heading closest to `heading` in which the direction `way` points ahead, back or to a side.
double HeadingOnTheWay(const Vector2d& way, double heading) {
  constexpr double kQuarter = std::numbers::pi / 2;
  const double direction = std::atan2(way.y(), way.x());
  return direction + kQuarter * std::round(WrapAngle(heading - direction) / kQuarter);
}

/// A gait needs least room along one of its axes, so a way to a pose has three parts: a turn on the
/// spot, the way along an axis, and a turn into the final heading. Returns the end of the first
/// part; none if only the last part is left. `offset`: heading of the root in the stance frame,
/// rad.
std::optional<Isometry3d> EndOfFirstPart(const Isometry3d& from, const Isometry3d& to,
                                         double offset) {
  const Vector2d way = (to.translation() - from.translation()).head<2>();
  if (way.norm() < kSamePose) return std::nullopt;
  const double heading = offset + HeadingOnTheWay(way, Heading(to.linear()) - offset);
  if (std::abs(WrapAngle(heading - Heading(from.linear()))) > kSameHeading) {
    return WithHeading(from, heading);
  }
  return WithHeading(to, heading);
}

}  // namespace

QuasiStaticAction::QuasiStaticAction(const LocomotionModel& model, int gait, const World& world,
                                     std::shared_ptr<const graph::ExplorationSpace> space,
                                     double step)
    : model_(&model),
      gait_(gait),
      world_(world),
      space_(std::move(space)),
      step_(step),
      checker_(*world.environment),
      pelvis_(*model.robot, checker_),
      standing_(model.gaits[gait]->volumes.standing) {
  for (size_t i = 0; i < kStrideClasses.size(); ++i) {
    sweeps_[i] = SweepOf(model.gaits[gait]->volumes, kStrideClasses[i]);
  }
  for (const LocomotionModel::TransitionEntry& transition : model.transitions) {
    transition_sweeps_.emplace_back(transition.sweep);
  }
  for (const auto& entry : model.gaits) {
    double radius = 0;
    for (const std::vector<Vector2d>& points : entry->stance.bearing_points) {
      for (const Vector2d& p_S : points) radius = std::max(radius, p_S.norm());
    }
    bearing_radii_.push_back(radius);
  }
}

QuasiStaticAction::Sweep QuasiStaticAction::SweepOf(const GaitVolumes& volumes,
                                                    StrideClass strides) {
  Sweep sweep;
  sweep.radius = RadiusOf(volumes.sweep(strides));
  const Vector2d growth = BetweenSamples(strides, kEdgeInflation);
  std::vector<Eigen::AlignedBox3d> inflated;
  for (const Eigen::AlignedBox3d& box : volumes.sweep(strides)) {
    const Vector3d margin(growth.x(), growth.y(), 0);
    inflated.emplace_back(box.min() - margin, box.max() + margin);
  }
  sweep.boxes = models::UprightBoxes(std::move(inflated));
  return sweep;
}

std::string QuasiStaticAction::name() const { return model_->gaits[gait_]->stance.gait->name; }

graph::Point QuasiStaticAction::ExtendTowards(const graph::Point& v0,
                                              const graph::Point& v1) const {
  const Isometry3d from = ToPose(v0);
  const Isometry3d to = ToPose(v1);
  const std::optional<Isometry3d> part =
      EndOfFirstPart(from, to, Heading(model_->gaits[gait_]->stance.X_SR.linear()));
  graph::Point end = part ? ToPoint(*part) : v1;
  const double distance = space_->Distance(v0, end);
  if (distance <= step_) return end;
  return ToPoint(Interpolate(from, part.value_or(to), step_ / distance));
}

graph::Point QuasiStaticAction::Project(const graph::Point& v) const {
  const Isometry3d X_WR = ToPose(v);
  const NominalStance& nominal = model_->gaits[gait_]->stance;
  const double heading = Heading(X_WR.linear()) - Heading(nominal.X_SR.linear());
  const PlanarPose stance{X_WR.translation().x(), X_WR.translation().y(), heading};
  const std::optional<int> level =
      world_.ground->LevelBelow(stance.position(), X_WR.translation().z());
  if (!level) return v;
  return ToPoint(nominal.RootPose(stance, world_.ground->levels()[*level]));
}

bool QuasiStaticAction::CN(const graph::Point& vertex) const {
  const Isometry3d X_WR = ToPose(vertex);
  return pelvis_.IsFree(X_WR) && EveryLimbReachesGround(X_WR);
}

/// On the way limbs may swing, and a transition ends where other limbs bear; but one always bears.
bool QuasiStaticAction::CN(const graph::Edge& edge) const {
  const Isometry3d from = ToPose(edge.from);
  const Isometry3d to = ToPose(edge.to);
  const double length = (to.translation() - from.translation()).norm();
  const int samples = 1 + static_cast<int>(length / kNecessarySpacing);
  for (int i = 0; i <= samples; ++i) {
    const Isometry3d X_WR = Interpolate(from, to, static_cast<double>(i) / samples);
    if (!pelvis_.IsFree(X_WR) || !SomeLimbReachesGround(X_WR)) return false;
  }
  return true;
}

bool QuasiStaticAction::SomeLimbReachesGround(const Isometry3d& X_WR) const {
  const auto& regions = model_->gaits[gait_]->regions;
  return std::any_of(regions.begin(), regions.end(), [&](const ReachableRegion& region) {
    return region.MeetsGround(*world_.ground, X_WR);
  });
}

bool QuasiStaticAction::EveryLimbReachesGround(const Isometry3d& X_WR) const {
  const auto& regions = model_->gaits[gait_]->regions;
  return std::all_of(regions.begin(), regions.end(), [&](const ReachableRegion& region) {
    return region.MeetsGround(*world_.ground, X_WR);
  });
}

std::optional<int> QuasiStaticAction::OnlyLevelAt(double z) const {
  const std::vector<double>& levels = world_.ground->levels();
  std::optional<int> only;
  for (size_t level = 0; level < levels.size(); ++level) {
    if (!(std::abs(levels[level] - z) <= 2 * kSamePose)) continue;
    if (only) return std::nullopt;
    if (std::abs(levels[level] - z) <= kSamePose / 2) only = static_cast<int>(level);
  }
  return only;
}

/// Whether one face of a level holds every bearing point; none if this test cannot decide.
std::optional<bool> QuasiStaticAction::FacesHold(int level, const GroundedStance& stance,
                                                 double clearance) const {
  bool all_hold = true;
  const Eigen::Isometry2d X_WS = stance.pose.Transform();
  for (const std::vector<Vector2d>& points : model_->gaits[stance.gait]->stance.bearing_points) {
    for (const Vector2d& p_S : points) {
      const Vector2d p = X_WS * p_S;
      if (world_.ground->OneFaceHolds(level, p, p, clearance + kGroundError)) continue;
      if (!world_.ground->LevelAt(p, stance.z, kSamePose)) return false;
      all_hold = false;
    }
  }
  return all_hold ? std::optional(true) : std::nullopt;
}

bool QuasiStaticAction::GroundHolds(const GroundedStance& stance, double clearance) const {
  const Vector2d centre = stance.pose.position();
  const double all_round = bearing_radii_[stance.gait] + clearance + kSamePose;
  std::optional<int> level = OnlyLevelAt(stance.z);
  if (level) {
    if (world_.ground->OneFaceHolds(*level, centre, centre, all_round + kGroundError)) return true;
    if (const std::optional<bool> hold = FacesHold(*level, stance, clearance)) return *hold;
  } else {
    level = world_.ground->LevelAt(centre, stance.z, kSamePose);
  }
  if (level && world_.ground->Clearance(*level, centre) >= all_round) return true;
  const NominalStance& nominal = model_->gaits[stance.gait]->stance;
  const Eigen::Isometry2d X_WS = stance.pose.Transform();
  for (const std::vector<Vector2d>& points : nominal.bearing_points) {
    for (const Vector2d& p_S : points) {
      const Vector2d p = X_WS * p_S;
      const std::optional<int> below = world_.ground->LevelAt(p, stance.z, kSamePose);
      if (!below || world_.ground->Clearance(*below, p) < clearance) return false;
    }
  }
  return true;
}

bool QuasiStaticAction::IsWithinBounds(const Vector2d& root) const {
  const Eigen::AlignedBox2d& bounds = world_.environment->bounds;
  return bounds.isEmpty() || bounds.squaredExteriorDistance(root) <= kSamePose * kSamePose;
}

bool QuasiStaticAction::IsWithinBounds(const GroundedStance& stance) const {
  return IsWithinBounds(stance.pose *
                        Vector2d(model_->gaits[stance.gait]->stance.X_SR.translation().head<2>()));
}

StanceFault QuasiStaticAction::Examine(const GroundedStance& stance) const {
  if (!IsWithinBounds(stance)) return StanceFault::kOutOfBounds;
  if (!GroundHolds(stance, 0)) return StanceFault::kOffGround;
  if (!BoxesFree(standing_, stance)) return StanceFault::kCollision;
  return StanceFault::kNone;
}

std::string QuasiStaticAction::FirstBlocker(const GroundedStance& stance) const {
  std::vector<models::PosedShape> boxes;
  for (const Eigen::AlignedBox3d& box : standing_.boxes()) {
    Isometry3d X_SB = Isometry3d::Identity();
    X_SB.translation() = box.center();
    boxes.push_back({models::Shape::Box(box.sizes()), stance.pose.At(stance.z) * X_SB});
  }
  const std::vector<std::string> blockers = Blockers(*world_.environment, boxes);
  return blockers.empty() ? std::string() : blockers.front();
}

bool QuasiStaticAction::CS(const graph::Point& vertex) const {
  const std::optional<GroundedStance> stance = AsStance(*model_, gait_, ToPose(vertex));
  return stance && Examine(*stance) == StanceFault::kNone;
}

/// A straight way between two stances and the samples that decide whether it is clear, each in the
/// middle of its share of the way. Feet stand all along the way. The stride frames, in which swept
/// volumes are tested, span the way less half a stride at either end; where strides turn, they span
/// the whole way.
struct QuasiStaticAction::StraightWay {
  GroundedStance from;
  PlanarPose to;
  StrideClass strides = StrideClass::kAny;
  bool stands = false;     ///< the ends are the same
  double first_frame = 0;  ///< as a fraction of the way
  double travel = 0;       ///< no point of the sweep goes farther, m
  int samples = 1;

  GroundedStance At(double sample) const { return AtFraction(sample / samples); }
  GroundedStance FrameAt(double sample) const {
    return AtFraction(first_frame + FramesShare() * sample / samples);
  }
  double FramesShare() const { return 1 - 2 * first_frame; }
  double TravelOfSample() const { return travel / (2 * samples); }

  /// Half the length of the part covered by samples `first` to `last` - 1, as a fraction of the
  /// way.
  double HalfShare(int first, int last) const {
    return static_cast<double>(last - first) / (2 * samples);
  }
  Vector2d HalfWay(int first, int last) const {
    return HalfShare(first, last) * (to.position() - from.pose.position());
  }
  GroundedStance AtFraction(double fraction) const {
    GroundedStance stance = from;
    stance.pose = Interpolate(from.pose, to, fraction);
    return stance;
  }
};

bool QuasiStaticAction::SampleIsClear(const StraightWay& way, int sample) const {
  return GroundHolds(way.At(sample + 0.5), way.TravelOfSample()) &&
         BoxesFree(way.stands ? standing_ : sweep(way.strides).boxes, way.FrameAt(sample + 0.5));
}

/// Sufficient: true only if samples `first` to `last` - 1 and the ends of their part of the way all
/// stand on ground. Relies on the distance to the edge of the ground changing no faster than the
/// position.
bool QuasiStaticAction::PartIsOverGround(const StraightWay& way, int level, int first,
                                         int last) const {
  const PlanarPose middle = way.At((first + last) / 2.0).pose;
  const double spare = world_.ground->Clearance(level, middle.position()) - bearing_radii_[gait_] -
                       way.TravelOfSample() - kSamePose - kGroundError;
  if (spare >= way.HalfWay(first, last).norm()) return true;
  const int split = (first + last) / 2;
  return spare > 0 && split > first && PartIsOverGround(way, level, first, split) &&
         PartIsOverGround(way, level, split, last);
}

/// Sufficient: true only if one face holds the paths of all bearing points along a part of the way.
/// The paths are straight except for the deviation that turning causes.
bool QuasiStaticAction::OneFaceHoldsPart(const StraightWay& way, int level, int first, int last,
                                         double half_turn) const {
  const Eigen::Isometry2d from = way.At(first).pose.Transform();
  const Eigen::Isometry2d to = way.At(last).pose.Transform();
  const double bend = bearing_radii_[gait_] * (1 - std::cos(half_turn));
  const double radius = way.TravelOfSample() + bend + kSamePose + kGroundError;
  for (const std::vector<Vector2d>& points : model_->gaits[gait_]->stance.bearing_points) {
    for (const Vector2d& p_S : points) {
      if (!world_.ground->OneFaceHolds(level, from * p_S, to * p_S, radius)) return false;
    }
  }
  return true;
}

/// Sufficient: true only if samples `first` to `last` - 1 and the ends of their part of the way are
/// clear. Tests larger boxes around the middle that hold the space covered between the ends.
bool QuasiStaticAction::PartIsCertainlyClear(const StraightWay& way, int first, int last) const {
  const double turn = std::abs(WrapAngle(way.to.yaw - way.from.pose.yaw));
  const double half_turn = way.HalfShare(first, last) * turn;
  if (!(half_turn <= std::numbers::pi / 2)) return false;
  const std::optional<int> level = OnlyLevelAt(way.from.z);
  if (!level) return false;
  const double all_round = bearing_radii_[gait_] + way.TravelOfSample() + kSamePose + kGroundError;
  const bool one_face_holds = world_.ground->OneFaceHolds(*level, way.At(first).pose.position(),
                                                          way.At(last).pose.position(), all_round);
  if (!one_face_holds && !OneFaceHoldsPart(way, *level, first, last, half_turn) &&
      !PartIsOverGround(way, *level, first, last)) {
    return false;
  }
  const GroundedStance middle = way.FrameAt((first + last) / 2.0);
  const Isometry3d X_WS = middle.pose.At(middle.z);
  const Vector2d half_way = way.FramesShare() * way.HalfWay(first, last);
  const Excursion excursion{X_WS.linear().topLeftCorner<2, 2>().transpose() * half_way,
                            std::sin(half_turn), 1 - std::cos(half_turn)};
  const models::UprightBoxes& boxes = sweep(way.strides).boxes;
  std::vector<models::Prism> swept;
  swept.reserve(boxes.boxes().size());
  for (const Eigen::AlignedBox3d& box : boxes.boxes()) {
    swept.emplace_back(Swept(box, excursion), X_WS);
  }
  return checker_.AreCertainlyFree(swept);
}

/// Tests all samples of a way that PartIsCertainlyClear does not cover as a whole. Coarse to fine,
/// so that both free stretches and blocked ways take few tests.
bool QuasiStaticAction::SamplesAreClear(const StraightWay& way) const {
  struct Part {
    int first;
    int last;
  };
  std::deque<Part> parts = {{0, way.samples}};
  while (!parts.empty()) {
    const auto [first, last] = parts.front();
    parts.pop_front();
    const bool is_part = last - first > 1 && last - first < way.samples;
    if (first == last || (is_part && PartIsCertainlyClear(way, first, last))) continue;
    const int middle = (first + last) / 2;
    if (!SampleIsClear(way, middle)) return false;
    parts.push_back({first, middle});
    parts.push_back({middle + 1, last});
  }
  return true;
}

QuasiStaticAction::StraightWay QuasiStaticAction::WayBetween(const GroundedStance& from,
                                                             const GroundedStance& to) const {
  StraightWay way{from, to.pose, ClassOfStrides(from.pose, to.pose)};
  if (KeepsHeading(way.strides)) {
    const models::GaitParameters& parameters = model_->gaits[gait_]->stance.gait->parameters;
    const int count = StrideCount(parameters, from.pose, to.pose);
    way.stands = count == 0;
    way.first_frame = 0.5 / std::max(1, count);
  }
  const double turn = std::abs(WrapAngle(to.pose.yaw - from.pose.yaw));
  way.travel =
      (to.pose.position() - from.pose.position()).norm() + sweep(way.strides).radius * turn;
  way.samples = std::max(1, static_cast<int>(std::ceil(way.travel / (2 * kEdgeInflation))));
  return way;
}

bool QuasiStaticAction::IsClear(const GroundedStance& from, const GroundedStance& to) const {
  const StraightWay way = WayBetween(from, to);
  return PartIsCertainlyClear(way, 0, way.samples) || SamplesAreClear(way);
}

bool QuasiStaticAction::CS(const graph::Edge& edge) const {
  if (IsForbidden(edge)) return false;
  const std::array<Isometry3d, 2> ends = {ToPose(edge.from), ToPose(edge.to)};
  GroundedStance start;
  if (const LocomotionModel::TransitionEntry* transition = FindTransition(ends, &start)) {
    return TransitionIsClear(*transition, start);
  }
  const std::optional<GroundedStance> from = AsStance(*model_, gait_, ends[0]);
  const std::optional<GroundedStance> to = AsStance(*model_, gait_, ends[1]);
  return from && to && IsWithinBounds(Vector2d(edge.from.head<2>())) &&
         IsWithinBounds(Vector2d(edge.to.head<2>())) && StraightWayHolds(*from, *to);
}

bool QuasiStaticAction::CS(const GroundedStance& from, const GroundedStance& to) const {
  const auto point = [&](const GroundedStance& stance) {
    return ToPoint(model_->gaits[gait_]->stance.RootPose(stance.pose, stance.z));
  };
  if (!forbidden_.empty() && IsForbidden({point(from), point(to)})) return false;
  return IsWithinBounds(from) && IsWithinBounds(to) && StraightWayHolds(from, to);
}

bool QuasiStaticAction::StraightWayHolds(const GroundedStance& from,
                                         const GroundedStance& to) const {
  if (std::abs(from.z - to.z) > kSamePose) return false;
  const StraightWay way = WayBetween(from, to);
  const bool is_level = std::abs(from.z - to.z) <= kSamePose / 4;
  // The whole way includes its ends.
  if (is_level && PartIsCertainlyClear(way, 0, way.samples)) return true;
  return Examine(to) == StanceFault::kNone && Examine(from) == StanceFault::kNone &&
         SamplesAreClear(way);
}

const LocomotionModel::TransitionEntry* QuasiStaticAction::FindTransition(
    const std::array<Isometry3d, 2>& ends, GroundedStance* start) const {
  for (const LocomotionModel::TransitionEntry& transition : model_->transitions) {
    if (transition.from != gait_ && transition.to != gait_) continue;
    for (int first = 0; first < 2; ++first) {
      const std::optional<GroundedStance> a = AsStance(*model_, transition.from, ends[first]);
      if (!a) continue;
      const Isometry3d target =
          model_->gaits[transition.to]->stance.RootPose(a->pose * transition.displacement, a->z);
      if (target.isApprox(ends[1 - first], kSamePose)) {
        *start = *a;
        return &transition;
      }
    }
  }
  return nullptr;
}

bool QuasiStaticAction::TransitionIsClear(const LocomotionModel::TransitionEntry& transition,
                                          const GroundedStance& start) const {
  GroundedStance end{transition.to, start.pose * transition.displacement, start.z};
  const size_t index = &transition - model_->transitions.data();
  return IsWithinBounds(start) && IsWithinBounds(end) && GroundHolds(start, 0) &&
         GroundHolds(end, 0) && BoxesFree(transition_sweeps_[index], start);
}

std::vector<graph::Point> QuasiStaticAction::TransitionFrom(const graph::Point& v) const {
  const Isometry3d X_WR = ToPose(v);
  for (const LocomotionModel::TransitionEntry& transition : model_->transitions) {
    const bool forward = transition.to == gait_;
    if (!forward && transition.from != gait_) continue;
    const std::optional<GroundedStance> stance =
        AsStance(*model_, forward ? transition.from : transition.to, X_WR);
    if (!stance) continue;
    const PlanarPose displacement =
        forward ? transition.displacement : transition.displacement.Inverse();
    const graph::Point target =
        ToPoint(model_->gaits[gait_]->stance.RootPose(stance->pose * displacement, stance->z));
    if (CS(graph::Edge{v, target}) && CS(target)) return {target};
  }
  return {};
}

double QuasiStaticAction::ExpectedDuration(const PlanarPose& from, const PlanarPose& to) const {
  const LocomotionModel::GaitEntry& gait = *model_->gaits[gait_];
  return gait.motion->WayDuration(gait.stance.gait->parameters, from, to);
}

double QuasiStaticAction::DurationAlone(const PlanarPose& from, const PlanarPose& to) const {
  return ExpectedDuration(from, to) + 2 * model_->gaits[gait_]->motion->RestTime();
}

double QuasiStaticAction::ExpectedDuration(const graph::Edge& edge) const {
  const std::array<Isometry3d, 2> ends = {ToPose(edge.from), ToPose(edge.to)};
  GroundedStance start;
  if (const LocomotionModel::TransitionEntry* transition = FindTransition(ends, &start)) {
    return transition->ExpectedDuration();
  }
  const auto& [from, to] = ends;
  return ExpectedDuration(
      PlanarPose{from.translation().x(), from.translation().y(), Heading(from.linear())},
      PlanarPose{to.translation().x(), to.translation().y(), Heading(to.linear())});
}

std::unique_ptr<graph::ConfirmationJob> QuasiStaticAction::SpawnConfirmationJob(
    const graph::Edge&) const {
  return nullptr;
}

void QuasiStaticAction::Forbid(const graph::Edge& edge) { forbidden_.push_back(edge); }

bool QuasiStaticAction::IsForbidden(const graph::Edge& edge) const {
  return std::any_of(forbidden_.begin(), forbidden_.end(), [&](const graph::Edge& other) {
    return (IsSamePose(edge.from, other.from) && IsSamePose(edge.to, other.to)) ||
           (IsSamePose(edge.from, other.to) && IsSamePose(edge.to, other.from));
  });
}

}  // namespace possibility::actions
