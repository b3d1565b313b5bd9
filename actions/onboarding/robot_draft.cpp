#include "actions/onboarding/robot_draft.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numbers>

#include "actions/onboarding/assumed_inertials.h"
#include "actions/onboarding/facing.h"
#include "actions/onboarding/leg_measures.h"
#include "actions/onboarding/shape_corners.h"
#include "actions/onboarding/visual_shapes.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/facts/contact_points.h"
#include "models/facts/sole.h"
#include "models/facts/zero_poses.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/robot/mesh_shapes.h"
#include "models/robot/rotation_vector.h"
#include "models/robot/shape_reach.h"
#include "models/robot/urdf_robot.h"
#include "models/shapes/convex_hull.h"

namespace possibility::actions {
namespace {

using Eigen::Vector3d;
using models::PosedShape;

constexpr double kPairTolerance = 0.025;  // m: published robots differ by up to 18 mm
constexpr double kFriction = 0.7;
/// Of a sole's corners above its lowest point, m: tried in turn until there is an area.
constexpr double kSoleSlacks[] = {5e-4, 2e-3, 5e-3};
constexpr double kLeastSole = 4e-4;  // m^2
constexpr double kLeastShare = 0.4;  // of the largest sole tried
constexpr int kMostShapes = 3;       // of one link; more are joined to one hull
constexpr double kUnlimited = 1e5;   // N m: a placeholder
constexpr double kLegEffort = 0.35;  // of weight times length of the leg
constexpr double kArmEffort = 0.08;  // likewise
constexpr double kJointSpeed = 2.5;  // rad per sqrt(leg length / gravity)

/// Joins the shapes of links that have many, fingers for example, to one hull each. Simple shapes
/// alone stay: they are exact and cheap.
void JoinShapes(models::RobotModel* robot, std::vector<std::string>* findings) {
  for (models::Link& link : robot->links) {
    const bool has_mesh = std::any_of(
        link.shapes.begin(), link.shapes.end(),
        [](const PosedShape& posed) { return posed.shape.type == models::ShapeType::kConvexMesh; });
    if (!has_mesh || static_cast<int>(link.shapes.size()) <= kMostShapes) continue;
    findings->push_back(fmt::format("the {} shapes of link '{}' are joined to one hull",
                                    link.shapes.size(), link.name));
    link.shapes = {
        {models::Shape::ConvexMesh(
             models::SimpleHullOfPoints(CornersOf(link.shapes), models::kMostHullCorners).vertices),
         Eigen::Isometry3d::Identity()}};
  }
}

class Drafter {
 public:
  explicit Drafter(RobotDraft* draft) : draft_(*draft), robot_(draft->robot) {}

  void Derive() {
    FindPositions();
    draft_.left_leg = Indices(draft_.plan.left_leg);
    draft_.right_leg = Indices(draft_.plan.right_leg);
    draft_.left_arm = Indices(draft_.plan.left_arm);
    draft_.right_arm = Indices(draft_.plan.right_arm);
    robot_.friction = kFriction;
    draft_.findings.push_back(
        fmt::format("friction {}: assumed, rubber on a dry floor", kFriction));
    FindPairs();
    FindSoles();
    FindPelvis();
    FindLimits();
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", draft_.urdf_file.string(), what));
  }

  std::vector<int> Indices(const models::LimbChain& chain) const {
    std::vector<int> joints;
    for (const std::string& name : chain.joints) joints.push_back(robot_.JointIndex(name));
    return joints;
  }

  /// Small robots are published without limits of position.
  void FindPositions() {
    constexpr double kWide = 2.0;  // rad
    for (models::Joint& joint : robot_.joints) {
      if (joint.lower < joint.upper) continue;
      if (joint.lower != 0 || joint.upper != 0 || joint.type != models::JointType::kRevolute) {
        Fail(fmt::format("joint '{}': expected lower < upper, got {} and {}", joint.name,
                         joint.lower, joint.upper));
      }
      joint.lower = -kWide;
      joint.upper = kWide;
      draft_.positions.push_back(joint.name);
    }
    if (draft_.positions.empty()) return;
    draft_.warnings.push_back(fmt::format("{} have no limits of position: assumed -{} to {} rad",
                                          fmt::join(draft_.positions, ", "), kWide, kWide));
  }

  void FindPairs() {
    draft_.pairs = models::FindMirrorPairs(robot_, kPairTolerance);
    const models::MirrorPairs& pairs = draft_.pairs;
    draft_.findings.push_back(
        fmt::format("{} pairs of joints, from the mirrored tree", pairs.pairs.size()));
    if (pairs.worst_distance > models::kSymmetric) {
      draft_.warnings.push_back(
          fmt::format("the robot differs from its mirror image by {:.1f} mm at link '{}'",
                      1e3 * pairs.worst_distance, pairs.worst_link));
    }
    constexpr double kLightMass = 1e-3;  // of the robot's
    if (pairs.worst_mass > kLightMass * robot_.TotalMass()) {
      draft_.warnings.push_back(fmt::format("link '{}' differs from its partner by {:.3f} kg",
                                            pairs.worst_mass_link, pairs.worst_mass));
    }
    for (const int joint : pairs.unpaired) {
      draft_.warnings.push_back(
          fmt::format("joint '{}' has no mirror image", robot_.joints[joint].name));
    }
    for (std::size_t i = 0; i < draft_.left_leg.size(); ++i) RequirePair(i);
  }

  void RequirePair(std::size_t i) const {
    const auto is_pair = [&](const models::MirrorPairs::Pair& pair) {
      return pair.left == draft_.left_leg[i] && pair.right == draft_.right_leg[i];
    };
    if (std::any_of(draft_.pairs.pairs.begin(), draft_.pairs.pairs.end(), is_pair)) return;
    Fail(fmt::format("joints '{}' and '{}' of the legs are not each other's mirror images",
                     robot_.joints[draft_.left_leg[i]].name,
                     robot_.joints[draft_.right_leg[i]].name));
  }

  void FindSoles() {
    const std::vector<Eigen::Isometry3d> X_RL =
        models::PosesInRoot(robot_, Eigen::VectorXd::Zero(robot_.num_joints()));
    for (const auto& [name, leg] :
         {std::pair("left_sole", draft_.left_leg), std::pair("right_sole", draft_.right_leg)}) {
      const int link = leg.back() + 1;
      Eigen::Matrix3d R_RL = X_RL[link].linear();
      const models::Sole sole = SoleOf(robot_.links[link], &R_RL);
      models::ContactPatch patch;
      patch.name = name;
      patch.link = link;
      patch.points = sole.points;
      patch.normal_L = R_RL.transpose() * -Vector3d::UnitZ();
      robot_.contacts.push_back(patch);
      draft_.findings.push_back(
          fmt::format("{}: {} corners, {:.0f} cm^2, the lowest polygon of link '{}'{}", name,
                      sole.points.size(), 1e4 * sole.area, robot_.links[link].name,
                      sole.depth > 1e-6 ? fmt::format(" to {:.1f} mm", 1e3 * sole.depth) : ""));
    }
    MeasureLegs(&draft_);
    draft_.findings.push_back(
        fmt::format("legs {:.3f} m long, {:.1f} kg in all", draft_.leg_length, robot_.TotalMass()));
  }

  /// `R_RL`: at zero; turned so that the sole is level if it is not there.
  models::Sole SoleOf(const models::Link& link, Eigen::Matrix3d* R_RL) {
    if (link.shapes.empty()) {
      Fail(fmt::format(
          "link '{}', the foot, has neither collision nor visual shape: expected one to stand on",
          link.name));
    }
    // Level at zero, then turned; an edge or a corner of the foot is no sole beside its largest
    // face.
    std::vector<models::Sole> soles;
    double tilt = 0;
    const Eigen::Matrix3d turned = TurnedLevel(link, *R_RL, &tilt);
    for (const Eigen::Matrix3d& R : {*R_RL, turned}) {
      for (const double slack : kSoleSlacks) soles.push_back(models::SoleOf(link, R, slack));
    }
    double widest = 0;
    for (const models::Sole& sole : soles) widest = std::max(widest, sole.area);
    for (std::size_t i = 0; i < soles.size(); ++i) {
      if (soles[i].area < std::max(kLeastSole, kLeastShare * widest)) continue;
      if (i < std::size(kSoleSlacks)) return soles[i];
      *R_RL = turned;
      draft_.warnings.push_back(
          fmt::format("the sole of link '{}' is tilted by {:.1f} degrees with all joints at 0",
                      link.name, tilt * 180 / std::numbers::pi));
      return soles[i];
    }
    Fail(
        fmt::format("link '{}', the foot, bears on {:.1f} cm^2: expected a flat sole of at least "
                    "{:.0f} cm^2",
                    link.name, 1e4 * widest, 1e4 * kLeastSole));
  }

  /// Brings the largest face within 45 degrees of the lower side down.
  /// `R_RL`: at zero. `tilt`: rad, by which that is turned.
  static Eigen::Matrix3d TurnedLevel(const models::Link& link, const Eigen::Matrix3d& R_RL,
                                     double* tilt) {
    const models::ConvexHull hull = models::HullOfPoints(CornersOf(link.shapes));
    const auto area = [&hull](const std::array<int, 3>& f) -> Vector3d {
      return 0.5 * (hull.vertices[f[1]] - hull.vertices[f[0]])
                       .cross(hull.vertices[f[2]] - hull.vertices[f[0]]);
    };
    Vector3d best = R_RL.transpose() * -Vector3d::UnitZ();
    double largest = 0;
    for (const auto& facet : hull.facets) {
      const Vector3d normal = area(facet).normalized();
      if ((R_RL * normal).z() > -std::sqrt(0.5)) continue;
      double sum = 0;
      for (const auto& other : hull.facets) {
        if (area(other).normalized().dot(normal) > 0.9998) sum += area(other).norm();
      }
      if (sum <= largest) continue;
      largest = sum;
      best = normal;
    }
    *tilt = std::acos(std::clamp(-(R_RL * best).z(), -1.0, 1.0));
    return models::SmallestRotation(R_RL * best, -Vector3d::UnitZ()) * R_RL;
  }

  /// C_N tests the shapes of one link that the root carries.
  void FindPelvis() {
    if (!robot_.links[0].shapes.empty()) return;
    robot_.links[0].shapes.push_back(
        {models::Shape::Sphere(0.02 * draft_.leg_length), Eigen::Isometry3d::Identity()});
    draft_.findings.push_back(fmt::format(
        "link '{}' has no collision shape: a small sphere stands for it", robot_.links[0].name));
  }

  void FindLimits() {
    const double weight = robot_.TotalMass() * dynamics::kGravity;
    const double time = std::sqrt(draft_.leg_length / dynamics::kGravity);
    AssumedLimit legs{{},
                      kLegEffort * weight * draft_.leg_length,
                      "not in the URDF; assumed: 0.35 of weight times length of the leg"};
    AssumedLimit others{{},
                        kArmEffort * weight * draft_.leg_length,
                        "not in the URDF; assumed: 0.08 of weight times length of the leg"};
    AssumedLimit speeds{{}, kJointSpeed / time, "not in the URDF; assumed from the leg's length"};
    for (int i = 0; i < robot_.num_joints(); ++i) {
      models::Joint& joint = robot_.joints[i];
      if (!(joint.effort > 0 && joint.effort < kUnlimited)) {
        AssumedLimit& assumed = IsOfALeg(i) ? legs : others;
        assumed.joints.push_back(joint.name);
        joint.effort = assumed.limit;
      }
      if (!(joint.velocity > 0)) {
        speeds.joints.push_back(joint.name);
        joint.velocity = speeds.limit;
      }
    }
    for (const AssumedLimit& assumed : {legs, others}) AddLimit(assumed, "N m", &draft_.efforts);
    AddLimit(speeds, "rad/s", &draft_.speeds);
  }

  bool IsOfALeg(int joint) const {
    const auto has = [joint](const std::vector<int>& leg) {
      return std::find(leg.begin(), leg.end(), joint) != leg.end();
    };
    return has(draft_.left_leg) || has(draft_.right_leg);
  }

  void AddLimit(const AssumedLimit& assumed, const char* unit, std::vector<AssumedLimit>* limits) {
    if (assumed.joints.empty()) return;
    limits->push_back(assumed);
    draft_.warnings.push_back(fmt::format("{:.1f} {} for {}: {}", assumed.limit, unit,
                                          fmt::join(assumed.joints, ", "), assumed.reason));
  }

  RobotDraft& draft_;
  models::RobotModel& robot_;
};

bool IsBody(const models::UrdfTree& tree, const std::string& joint) {
  const auto moved = std::find_if(tree.joints.begin(), tree.joints.end(),
                                  [&](const models::UrdfJoint& j) { return j.name == joint; });
  const auto link = std::find_if(tree.links.begin(), tree.links.end(),
                                 [&](const models::UrdfLink& l) { return l.name == moved->child; });
  if (!link->inertial) return true;  // whether something below brings a mass is judged later
  try {
    models::CheckMovingBody(*link->inertial, "");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Published arms hold links with inertias that no body has. Such arms are held at 0, as part of
/// the trunk; legs need theirs.
void LumpImpossibleArms(RobotDraft* draft) {
  models::BodyPlan& plan = draft->plan;
  for (std::size_t i = 0; i < plan.left_arm.joints.size(); ++i) {
    const std::string& left = plan.left_arm.joints[i];
    const std::string& right = plan.right_arm.joints[i];
    if (IsBody(draft->tree, left) && IsBody(draft->tree, right)) continue;
    draft->warnings.push_back(
        fmt::format("the arms are held at 0: no body has the inertia of the link that '{}' or '{}' "
                    "moves",
                    left, right));
    for (const auto* arm : {&plan.left_arm, &plan.right_arm}) {
      plan.lump.insert(arm->joints.begin(), arm->joints.end());
    }
    plan.left_arm = plan.right_arm = {};
    return;
  }
}

/// Limits that no joint reaches stand for unknown ones.
void ForgetPlaceholders(models::UrdfTree* tree) {
  constexpr double kFastest = 1e3;  // rad/s or m/s
  for (models::UrdfJoint& joint : tree->joints) {
    if (!(joint.velocity <= kFastest)) joint.velocity = 0;
    if (!(joint.effort <= kUnlimited)) joint.effort = 0;
    // A continuous joint may go without a <limit>.
    if (joint.type == "continuous") joint.has_limits = true;
  }
}

void IgnoreDisabledPairs(const models::Srdf& srdf, RobotDraft* draft) {
  std::map<std::string, int> index;
  for (int i = 0; i < draft->robot.num_links(); ++i) index[draft->robot.links[i].name] = i;
  int count = 0;
  for (const models::SrdfDisabledPair& pair : srdf.disabled) {
    const auto a = index.find(pair.link1), b = index.find(pair.link2);
    if (a == index.end() || b == index.end() || a->second == b->second) continue;
    // Published lists rest on samples. Those that say so are tested again.
    if (pair.reason == "Never") continue;
    draft->ignored.push_back({std::min(a->second, b->second), std::max(a->second, b->second),
                              "SRDF: " + (pair.reason.empty() ? "disabled" : pair.reason)});
    ++count;
  }
  draft->findings.push_back(
      fmt::format("{} pairs of links are not tested because the SRDF disables them", count));
}

RobotDraft DraftOfText(const std::string& urdf, const std::filesystem::path& urdf_file,
                       const std::vector<std::filesystem::path>& packages) {
  RobotDraft draft;
  draft.urdf_file = urdf_file;
  draft.urdf = urdf;
  draft.tree = models::ParseUrdf(urdf, urdf_file);
  ForgetPlaceholders(&draft.tree);
  draft.plan = models::FindBodyPlan(draft.tree, urdf_file);
  draft.findings = draft.plan.findings;
  LumpImpossibleArms(&draft);
  models::UrdfRobot built = BuildWithAssumedInertials(packages, &draft);
  AddVisualShapes(&draft, &built);
  draft.robot = std::move(built.robot);
  draft.robot.file = urdf_file;
  models::AddMeshShapes(built.meshes, urdf_file, packages, &draft.robot);
  models::RequireShapesInReach(urdf_file, draft.robot);
  JoinShapes(&draft.robot, &draft.findings);
  Drafter(&draft).Derive();
  return draft;
}

}  // namespace

RobotDraft DraftRobot(const std::filesystem::path& urdf_file,
                      const std::vector<std::filesystem::path>& packages,
                      const std::optional<std::filesystem::path>& srdf_file) {
  const models::UrdfWithoutPoints read = models::WithoutPoints(models::ReadFileContents(urdf_file));
  const std::string& urdf = read.urdf;
  RobotDraft draft = DraftOfText(urdf, urdf_file, packages);
  if (FacesBackward(draft)) {
    const std::string root = draft.tree.root;
    draft = DraftOfText(WithTurnedRoot(urdf, root), urdf_file, packages);
    draft.warnings.push_back(
        fmt::format("the robot looks along -x of '{}', as feet and knees say: the copy of the URDF "
                    "has a root turned by half a turn",
                    root));
  }
  for (const auto& [link, count] : read.points) {
    draft.findings.push_back(fmt::format(
        "{} spheres of radius 0 on link '{}': points, no shapes; the copy of the URDF has none",
        count, link));
  }
  if (srdf_file) IgnoreDisabledPairs(models::ReadSrdf(*srdf_file, draft.tree), &draft);
  return draft;
}

}  // namespace possibility::actions
