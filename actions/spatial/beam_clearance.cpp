#include "actions/spatial/beam_clearance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "actions/spatial/core_corners.h"
#include "actions/wholebody/limb_bend.h"
#include "collocation/problem/function.h"
#include "collocation/robot/turning_plane.h"
#include "dynamics/tree/base_joints.h"
#include "models/shapes/prepared_shape.h"

namespace possibility::actions {
namespace {

using namespace collocation;  // reads like the mathematics
using models::ContactSchedule;

constexpr double kUpright = std::numbers::pi / 2;  // turn of a plane before the beam, rad
constexpr double kPlaneWeight = 0.01;  // of squares of a plane's departure from its guess

/// What one plane keeps off the beam.
struct KeptPart {
  std::string name;
  std::vector<dynamics::ContactPoint> points;  ///< cores of its shapes, on OnJoints' links
  std::vector<double> radii;                   ///< m, by point
};

void AddLink(const models::RobotModel& robot, int link, KeptPart* part) {
  for (const models::PosedShape& posed : robot.links[link].shapes) {
    const double radius = models::PreparedShape(posed.shape).radius();
    for (const Eigen::Vector3d& corner : CoreCorners(posed.shape)) {
      part->points.push_back({link + dynamics::kNumBaseJoints, posed.X_PS * corner});
      part->radii.push_back(radius);
    }
  }
}

/// Height of the beam's highest corner along the normal of a plane with this turn.
double SupportOf(const Beam& beam, double turn) {
  const double x = std::sin(turn) > 0 ? beam.begin : beam.end;
  return std::cos(turn) * beam.height - std::sin(turn) * x;
}

class BeamRows {
 public:
  BeamRows(const Beam& beam, double clearance, const models::RobotModel& robot,
           const ContactSchedule& schedule, RobotSystem model)
      : beam_(beam),
        clearance_(clearance),
        robot_(robot),
        schedule_(schedule),
        model_(std::move(model)) {}

  void Add(const models::GaitLimb& limb, const std::vector<RobotPhase>& phases) {
    const std::optional<LimbBend> bend = BendOf(robot_, limb);
    const int contact = ContactOf(limb);
    if (!bend || contact < 0) return;
    KeptPart shank{"shank of " + bend->name, {}, {}};
    AddLink(robot_, limb.joints[bend->joint] + 1, &shank);
    KeptPart foot{"foot of " + bend->name, {}, {}};
    for (std::size_t i = bend->joint + 1; i < limb.joints.size(); ++i) {
      AddLink(robot_, limb.joints[i] + 1, &foot);
    }
    for (std::size_t k = 0; k < phases.size(); ++k) {
      const int interval = static_cast<int>(k);
      AddPlane(shank, interval, contact, phases[k]);
      const auto [begin, end] = Sides(interval, contact);
      if (begin != end) AddPlane(foot, interval, contact, phases[k]);
    }
  }

 private:
  int ContactOf(const models::GaitLimb& limb) const {
    const auto found = std::find(schedule_.contacts.begin(), schedule_.contacts.end(),
                                 robot_.contacts[limb.contact].name);
    return found == schedule_.contacts.end() ? -1
                                             : static_cast<int>(found - schedule_.contacts.begin());
  }

  /// 1 before the beam, -1 behind it.
  double SideOf(const Eigen::Isometry3d& place, int contact) const {
    const double x = place.translation().x();
    if (x > beam_.begin && x < beam_.end) {
      throw std::invalid_argument(
          fmt::format("beam: {} bears on it at {:.3f} m", schedule_.contacts[contact], x));
    }
    return x <= beam_.begin ? 1 : -1;
  }

  /// Where a plane is upright at the start and the end of interval `k`, as shares of a half turn
  /// from before the beam (1) to behind it (-1).
  std::pair<double, double> Sides(int k, int contact) const {
    const auto bears = [&](int i) { return schedule_.intervals[i].bearing[contact].has_value(); };
    double before = 0;
    double after = 0;
    for (int i = k - 1; i >= 0 && !bears(i); --i) before += schedule_.intervals[i].duration;
    const int last = static_cast<int>(schedule_.intervals.size()) - 1;
    for (int i = k + 1; i <= last && !bears(i); ++i) after += schedule_.intervals[i].duration;
    const double from = SideOf(schedule_.Before(k, contact), contact);
    const double to = SideOf(schedule_.After(k, contact), contact);
    const double own = schedule_.intervals[k].duration;
    const auto at = [&](double time) { return from + (to - from) * time / (before + own + after); };
    return {at(before), at(before + own)};
  }

  void AddPlane(const KeptPart& part, int k, int contact, const RobotPhase& robot) {
    const auto [begin, end] = Sides(k, contact);
    const auto turn_at = [begin = begin, end = end](auto s) {
      return kUpright * (begin + (end - begin) * s);
    };
    const Variable turn =
        robot.phase->AddControl("turn before " + part.name, {-kUpright, kUpright});
    const Variable offset = robot.phase->AddControl("offset before " + part.name);
    robot.phase->Guess(turn, [turn_at](double s) { return turn_at(s); });
    robot.phase->Guess(offset, [this, turn_at](double s) { return SupportOf(beam_, turn_at(s)); });
    AddRows(part, turn, offset, k, robot);
    robot.phase->AddIntegralCost("plane before " + part.name, FunctionOf([turn_at](auto t, auto s) {
                                   const auto off = t - turn_at(s);
                                   return off * off;
                                 }),
                                 {turn, robot.phase->share()}, kPlaneWeight);
    const double level = beam_.height;
    const double middle = (beam_.begin + beam_.end) / 2;
    robot.phase->AddIntegralCost("offset before " + part.name,
                                 FunctionOf([level, middle](auto t, auto d) {
                                   const auto off = d - cos(t) * level + sin(t) * middle;
                                   return off * off;
                                 }),
                                 {turn, offset}, kPlaneWeight);
  }

  void AddRows(const KeptPart& part, Variable turn, Variable offset, int k,
               const RobotPhase& robot) {
    const At at = k == 0 ? At::kEverywhere : At::kAfterStart;
    robot.phase->Constrain("beam behind plane of " + part.name,
                           FunctionOf([beam = beam_](auto t, auto d) {
                             return std::array{d - cos(t) * beam.height + sin(t) * beam.begin,
                                               d - cos(t) * beam.height + sin(t) * beam.end};
                           }),
                           {turn, offset}, std::vector<Bounds>(2, Bounds{0, kInfinity}), at);
    std::vector<Variable> arguments = robot.Positions();
    arguments.push_back(turn);
    arguments.push_back(offset);
    std::vector<Bounds> bounds;
    for (const double radius : part.radii) bounds.push_back({radius + clearance_, kInfinity});
    robot.phase->Constrain(part.name + " before its plane",
                           HeightsOverTurningPlane(model_, part.points), arguments, bounds, at);
  }

  const Beam beam_;
  double clearance_;
  const models::RobotModel& robot_;
  const ContactSchedule& schedule_;
  RobotSystem model_;
};

}  // namespace

void KeepOffBeam(const Beam& beam, double clearance, const models::RobotModel& robot,
                 const models::Gait& limbs, const ContactSchedule& schedule,
                 const RobotSystem& model, const std::vector<RobotPhase>& phases) {
  BeamRows rows(beam, clearance, robot, schedule, model);
  for (const models::GaitLimb& limb : limbs.limbs) rows.Add(limb, phases);
}

}  // namespace possibility::actions
