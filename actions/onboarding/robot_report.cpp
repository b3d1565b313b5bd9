#include "actions/onboarding/robot_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "actions/gait/dynamic_gait.h"
#include "actions/gait/pace_library.h"
#include "actions/gait/swept_volume.h"
#include "actions/onboarding/pace_limits.h"
#include "actions/wholebody/motion_builder.h"
#include "actions/wholebody/nominal_stance.h"
#include "actions/wholebody/support_polygon.h"
#include "dynamics/contact/contact_forces.h"
#include "dynamics/tree/multibody_dynamics.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/facts/mirror_pairs.h"
#include "models/input/input_error.h"
#include "models/world/collision.h"

namespace possibility::actions {
namespace {

constexpr double kPairsWithin = 0.025;  // m
constexpr double kDegreesPerRadian = 180 / std::numbers::pi;

class Reporter {
 public:
  Reporter(const models::RobotModel& robot, const std::filesystem::path& library)
      : robot_(robot), paces_(robot, library) {}

  std::vector<RobotFinding> Run() {
    Symmetry();
    Actuators();
    for (const models::Gait& gait : robot_.gaits) ReportGait(gait);
    return std::move(findings_);
  }

 private:
  void Add(const std::string& subject, const std::string& text, bool is_fault = false) {
    findings_.push_back({subject, text, is_fault});
  }

  void Symmetry() {
    const models::MirrorPairs pairs = models::FindMirrorPairs(robot_, kPairsWithin);
    Add("symmetry",
        fmt::format("{} pairs of joints, {} joints without an image; at most {:.2f} mm "
                    "off{}, masses at most {:.3f} kg",
                    pairs.pairs.size(), pairs.unpaired.size(), 1e3 * pairs.worst_distance,
                    pairs.worst_link.empty() ? "" : " at '" + pairs.worst_link + "'",
                    pairs.worst_mass));
  }

  void Actuators() {
    int rotors = 0, frictions = 0, lines = 0;
    for (const models::Joint& joint : robot_.joints) {
      const models::Actuator& actuator = joint.actuator;
      rotors += actuator.armature > 0 ? 1 : 0;
      frictions += actuator.viscous_friction > 0 || actuator.dry_friction > 0 ? 1 : 0;
      lines += actuator.line ? 1 : 0;
    }
    if (rotors + frictions + lines == 0) return;
    Add("actuators", fmt::format("of {} joints {} have an armature, {} friction, {} a torque-speed "
                                 "line",
                                 robot_.num_joints(), rotors, frictions, lines));
  }

  void ReportGait(const models::Gait& gait) {
    try {
      const NominalStance stance = SolveNominalStance(robot_, gait);
      Balance(gait, stance);
      Joints(gait, stance);
      Torques(gait, stance);
      CloseLinks(gait, stance);
      Strides(gait, stance);
    } catch (const InputError& error) {
      Add(gait.name + ": posture", error.what(), true);
    }
  }

  void Balance(const models::Gait& gait, const NominalStance& stance) {
    std::vector<Eigen::Vector2d> points;
    for (const auto& limb : stance.bearing_points) {
      points.insert(points.end(), limb.begin(), limb.end());
    }
    const double margin = SupportPolygon(points).Margin(stance.centre_of_mass);
    Add(gait.name + ": balance",
        fmt::format("the centre of mass is {:.3f} m inside the support", margin), margin < 0);
  }

  void Joints(const models::Gait& gait, const NominalStance& stance) {
    double least = std::numeric_limits<double>::infinity();
    std::string nearest;
    for (const models::GaitLimb& limb : gait.limbs) {
      for (const int joint : limb.joints) {
        const models::Joint& j = robot_.joints[joint];
        const double margin =
            std::min(stance.q[7 + joint] - j.lower, j.upper - stance.q[7 + joint]);
        if (margin >= least) continue;
        least = margin;
        nearest = j.name;
      }
    }
    if (nearest.empty()) return;
    Add(gait.name + ": joints", fmt::format("'{}' is nearest to a limit, {:.1f} degrees", nearest,
                                            least * kDegreesPerRadian));
  }

  /// Share of a torque limit while all limbs bear and nothing moves.
  void Torques(const models::Gait& gait, const NominalStance& stance) {
    const auto model = UncoupledModel(robot_);
    dynamics::MultibodyDynamics dynamics(model);
    dynamics.SetState(stance.q, Eigen::VectorXd::Zero(robot_.nv()));
    std::vector<dynamics::ContactPoint> points;
    for (const models::GaitLimb& limb : gait.limbs) {
      const models::ContactPatch& patch = robot_.contacts[limb.contact];
      for (const Eigen::Vector3d& p : patch.points) {
        points.push_back({patch.link, p, Eigen::Vector3d::UnitZ()});
      }
    }
    dynamics::ContactForceSettings settings;
    settings.friction = robot_.friction;
    settings.torque_margin = 1;
    const auto forces = dynamics::DistributeContactForces(&dynamics, points, settings);
    if (!forces) {
      return Add(gait.name + ": torque", "no contact forces within the limits hold this posture",
                 true);
    }
    int worst = 0;
    double share = 0;
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const double used = std::abs(forces->torques[i]) / robot_.joints[i].effort;
      if (used <= share) continue;
      share = used;
      worst = i;
    }
    Add(gait.name + ": torque", fmt::format("'{}' bears {:.0f} % of its limit at rest",
                                            robot_.joints[worst].name, 100 * share));
  }

  void CloseLinks(const models::Gait& gait, const NominalStance& stance) {
    const models::CollisionChecker checker(robot_, models::Environment());
    dynamics::TreeKinematics kinematics(robot_);
    kinematics.SetPosition(stance.q);
    for (const models::Proximity& pair : checker.SelfProximities(kinematics.X_WL(), 0.01)) {
      Add(gait.name + ": links",
          fmt::format("'{}' and '{}' are {:.1f} mm apart", robot_.links[pair.link].name,
                      robot_.links[pair.other].name, 1e3 * pair.distance),
          pair.distance < 0);
    }
  }

  void Strides(const models::Gait& gait, const NominalStance& stance) {
    const std::optional<std::vector<Pace>> paces = paces_.Find(gait);
    const DynamicGait motion =
        paces ? DynamicGait(robot_, stance, *paces) : DynamicGait(robot_, stance);
    const PaceLimits limits(robot_, stance);
    try {
      SweepGait(robot_, stance, motion);
      Add(gait.name + ": strides", "every stride within the bounds is possible");
    } catch (const InputError& error) {
      Add(gait.name + ": strides", error.what(), true);
    }
    Add(gait.name + ": speed",
        motion.paces().empty()
            ? fmt::format("no pace fits; quasi-static strides only. The slowest pace: {}",
                          limits.BindingLimit(motion.paces()))
            : fmt::format("{:.2f} m/s. A tenth more: {}", motion.paces().front().speed(),
                          limits.BindingLimit(motion.paces())));
  }

  const models::RobotModel& robot_;
  PaceLibrary paces_;
  std::vector<RobotFinding> findings_;
};

}  // namespace

std::vector<RobotFinding> ReportOn(const models::RobotModel& robot,
                                   const std::filesystem::path& library) {
  return Reporter(robot, library).Run();
}

}  // namespace possibility::actions
