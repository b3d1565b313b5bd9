#include "dynamics/sagittal/sagittal_lumping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "models/input/input_error.h"
#include "models/robot/lumping.h"

namespace possibility::dynamics {

namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using models::Joint;
using models::JointType;
using models::Mimic;

// m, rad, or part of a unit vector: tolerated deviation of two halves from mirror images.
constexpr double kTolerance = 1e-6;

Vector3d Mirrored(const Vector3d& v) { return {v.x(), -v.y(), v.z()}; }
Vector3d InPlane(const Vector3d& v) { return {v.x(), 0, v.z()}; }

bool Near(const Vector3d& a, const Vector3d& b) { return (a - b).norm() <= kTolerance; }

class Folder {
 public:
  Folder(const models::RobotModel& robot, const Eigen::VectorXd& locked) : robot_(robot) {
    result_.rest = locked;
  }

  SagittalLumping Fold() {
    IndexPairs();
    PlaceJoints();
    for (const auto& [left, right] : robot_.sagittal_pairs) ComparePair(left, right);
    StartTree();
    for (int joint = 0; joint < robot_.num_joints(); ++joint) Attach(joint);
    LumpLinks();
    CoupleJoints();
    MergeContacts();
    return std::move(result_);
  }

 private:
  struct Placement {
    Vector3d origin;  ///< of the joint, world, rest position
    Vector3d axis;
    bool free = false;
  };

  [[noreturn]] void Fail(const std::string& what) const {
    const std::string source = robot_.file.empty() ? robot_.name : robot_.file.string();
    throw InputError(fmt::format("{}: sagittal reduction: {}", source, what));
  }
  const std::string& Name(int joint) const { return robot_.joints[joint].name; }
  std::string PairName(int left, int right) const {
    return fmt::format("joints '{}' and '{}'", Name(left), Name(right));
  }

  void IndexPairs() {
    partner_.assign(robot_.num_joints(), -1);
    sign_.assign(robot_.num_joints(), 1.0);
    for (const auto& [left, right] : robot_.sagittal_pairs) {
      for (const int joint : {left, right}) {
        if (joint < 0 || joint >= robot_.num_joints()) {
          Fail(fmt::format("a pair names joint {}, expected 0 to {}", joint,
                           robot_.num_joints() - 1));
        }
        if (partner_[joint] >= 0 || left == right) {
          Fail(fmt::format("joint '{}' is in more than one pair", Name(joint)));
        }
        partner_[joint] = joint == left ? right : left;
      }
    }
  }

  void PlaceJoints() {
    X_WL_.assign(robot_.num_links(), Isometry3d::Identity());
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const Joint& joint = robot_.joints[i];
      Isometry3d& X_WL = X_WL_[i + 1];
      X_WL = X_WL_[joint.parent] * joint.X_PJ;
      const Vector3d axis = X_WL.linear() * joint.axis;
      const bool slides = joint.type == JointType::kPrismatic;
      const double off = slides ? std::abs(axis.y()) : InPlane(axis).norm();
      placements_.push_back({X_WL.translation(), axis, off <= kTolerance});
      if (placements_[i].free) result_.rest[i] = 0;
      if (slides) {
        X_WL.translate(result_.rest[i] * joint.axis);
      } else {
        X_WL.rotate(Eigen::AngleAxisd(result_.rest[i], joint.axis));
      }
    }
  }

  void ComparePair(int left, int right) {
    if (robot_.joints[left].type != robot_.joints[right].type) {
      Fail(PairName(left, right) + " are of different types");
    }
    const Placement& l = placements_[left];
    const Placement& r = placements_[right];
    const Vector3d off = r.origin - Mirrored(l.origin);
    if (!(off.norm() <= kTolerance)) {
      Fail(fmt::format("{} are no mirror images: their places differ by ({:.3g}, {:.3g}, {:.3g}) m",
                       PairName(left, right), off.x(), off.y(), off.z()));
    }
    // Displacements are mirrored. A mirrored rotation has the opposite sense about the mirrored
    // axis.
    const bool slides = robot_.joints[left].type == JointType::kPrismatic;
    const Vector3d mirrored = slides ? Mirrored(l.axis) : Vector3d(-Mirrored(l.axis));
    sign_[right] = mirrored.dot(r.axis) < 0 ? -1 : 1;
    const Vector3d turned = r.axis - sign_[right] * mirrored;
    if (!(turned.norm() <= kTolerance)) {
      Fail(fmt::format("{} are no mirror images: their axes differ by ({:.3g}, {:.3g}, {:.3g})",
                       PairName(left, right), turned.x(), turned.y(), turned.z()));
    }
    const double apart = result_.rest[right] - sign_[right] * result_.rest[left];
    if (!(std::abs(apart) <= kTolerance)) {
      Fail(fmt::format("{} are locked at {:.6g} and {:.6g}, which is not symmetric",
                       PairName(left, right), result_.rest[left], result_.rest[right]));
    }
    if (!l.free) result_.locked.push_back({left, right, sign_[right]});
  }

  void StartTree() {
    models::RobotModel& tree = result_.tree;
    tree.name = robot_.name + "_sagittal";
    tree.file = robot_.file;
    tree.content_hash = robot_.content_hash;
    tree.friction = robot_.friction;
    tree.links.resize(1);
    tree.links[0].name = robot_.links[0].name;
    origins_.push_back(Vector3d::Zero());
    result_.lumped_link.assign(robot_.num_links(), 0);
    lumped_joint_.assign(robot_.num_joints(), -1);
    is_right_.assign(robot_.num_joints(), false);
    for (const auto& [left, right] : robot_.sagittal_pairs) is_right_[right] = true;
  }

  /// Places the link that a joint moves in the tree. The second link of a pair joins the first.
  void Attach(int joint) {
    const int parent = result_.lumped_link[robot_.joints[joint].parent];
    const int partner = partner_[joint];
    const bool is_second = partner >= 0 && partner < joint;
    if (is_second) {
      const int other = result_.lumped_link[robot_.joints[partner].parent];
      if (other != parent) {
        Fail(fmt::format("{} hang on links that do not move alike", PairName(partner, joint)));
      }
    }
    int& link = result_.lumped_link[joint + 1];
    if (!placements_[joint].free) {
      link = parent;
    } else if (is_second) {
      link = result_.lumped_link[partner + 1];
      lumped_joint_[joint] = lumped_joint_[partner];
    } else {
      AddJoint(joint, parent);
      link = result_.tree.num_joints();
    }
  }

  void AddJoint(int first, int parent) {
    const int partner = partner_[first];
    const SagittalJoint pair = is_right_[first] ? SagittalJoint{partner, first, sign_[first]}
                               : partner >= 0   ? SagittalJoint{first, partner, sign_[partner]}
                                                : SagittalJoint{first, -1, 1};
    Joint joint = robot_.joints[pair.left];
    const Placement& placement = placements_[pair.left];
    const bool slides = joint.type == JointType::kPrismatic;
    joint.parent = parent;
    joint.mimic.reset();
    joint.axis = slides ? InPlane(placement.axis).normalized()
                        : Vector3d(0, placement.axis.y() > 0 ? 1 : -1, 0);
    const Vector3d origin = InPlane(placement.origin);
    joint.X_PJ = Isometry3d::Identity();
    joint.X_PJ.translation() = origin - origins_[parent];
    if (pair.right >= 0) CombineLimits(pair, &joint);
    lumped_joint_[first] = result_.tree.num_joints();
    result_.tree.joints.push_back(joint);
    result_.tree.links.push_back({robot_.links[pair.left + 1].name, {}, {}});
    result_.joints.push_back(pair);
    origins_.push_back(origin);
  }

  void CombineLimits(const SagittalJoint& pair, Joint* joint) const {
    const Joint& left = robot_.joints[pair.left];
    const Joint& right = robot_.joints[pair.right];
    const double a = pair.right_sign * right.lower;
    const double b = pair.right_sign * right.upper;
    joint->lower = std::max(left.lower, std::min(a, b));
    joint->upper = std::min(left.upper, std::max(a, b));
    if (!(joint->lower < joint->upper)) {
      Fail(PairName(pair.left, pair.right) + " have position limits without a common range");
    }
    joint->velocity = std::min(left.velocity, right.velocity);
    // A mimic joint has no motor.
    joint->effort = (left.mimic ? 0 : left.effort) + (right.mimic ? 0 : right.effort);
    joint->actuator = CombinedActuator(pair);
  }

  /// Both motors drive one joint at one speed.
  models::Actuator CombinedActuator(const SagittalJoint& pair) const {
    const Joint& left = robot_.joints[pair.left];
    const Joint& right = robot_.joints[pair.right];
    if (left.mimic || right.mimic) return left.mimic ? right.actuator : left.actuator;
    models::Actuator both = left.actuator;
    const models::Actuator& other = right.actuator;
    both.armature += other.armature;
    both.viscous_friction += other.viscous_friction;
    both.dry_friction += other.dry_friction;
    if (left.actuator.dry_friction == 0) both.dry_speed = other.dry_speed;
    if (left.actuator.dry_friction > 0 && other.dry_friction > 0 &&
        left.actuator.dry_speed != other.dry_speed) {
      Fail(PairName(pair.left, pair.right) + " differ in their dry_speed");
    }
    CheckLines(pair);
    if (both.line) both.line->stall_torque += other.line->stall_torque;
    return both;
  }

  /// Limits of a pair add up to the limit of the sum only if both fall alike.
  void CheckLines(const SagittalJoint& pair) const {
    const Joint& left = robot_.joints[pair.left];
    const Joint& right = robot_.joints[pair.right];
    const auto& a = left.actuator.line;
    const auto& b = right.actuator.line;
    if (!a && !b) return;
    const bool alike = a && b && a->no_load_speed == b->no_load_speed &&
                       std::abs(a->stall_torque * right.effort - b->stall_torque * left.effort) <=
                           kTolerance * a->stall_torque * right.effort;
    if (!alike) Fail(PairName(pair.left, pair.right) + " differ in their torque-speed lines");
  }

  void LumpLinks() {
    models::RobotModel& tree = result_.tree;
    result_.X_GL = X_WL_;
    for (int i = 0; i < robot_.num_links(); ++i) {
      const int group = result_.lumped_link[i];
      Isometry3d& X_GL = result_.X_GL[i];
      X_GL.pretranslate(-origins_[group]);
      models::Link& link = tree.links[group];
      AddProjected(robot_.links[i].inertial, X_GL, &link.inertial);
      for (const models::PosedShape& posed : robot_.links[i].shapes) {
        link.shapes.push_back({posed.shape, X_GL * posed.X_PS});
      }
    }
    for (models::Link& link : tree.links) {
      // Only the moment of inertia about y matters in the plane; three equal moments are those of a
      // ball.
      link.inertial.I_LC = link.inertial.I_LC(1, 1) * Matrix3d::Identity();
    }
    std::set<std::pair<int, int>> ignored;
    for (const auto& [a, b] : robot_.ignored_collisions) {
      const std::pair<int, int> links =
          std::minmax({result_.lumped_link[a], result_.lumped_link[b]});
      if (links.first != links.second) ignored.insert(links);
    }
    tree.ignored_collisions.assign(ignored.begin(), ignored.end());
    tree.pelvis_shape_link = result_.lumped_link[robot_.pelvis_shape_link];
  }

  static void AddProjected(const models::Inertial& body, const Isometry3d& X_GL,
                           models::Inertial* total) {
    models::Inertial projected;
    projected.mass = body.mass;
    projected.p_LC = InPlane(X_GL * body.p_LC);
    const Vector3d y_L = X_GL.linear().transpose() * Vector3d::UnitY();
    projected.I_LC(1, 1) = y_L.dot(body.I_LC * y_L);
    if (total->mass + projected.mass > 0) {
      *total = models::Combined(*total, projected, Isometry3d::Identity());
    } else {
      total->I_LC += projected.I_LC;
    }
  }

  /// The coupling of a free joint, in terms of the tree's joints and the left joint's sign. None if
  /// it is independent or follows its own partner as symmetry requires.
  std::optional<Mimic> LumpedCoupling(int joint) const {
    const std::optional<Mimic>& mimic = robot_.joints[joint].mimic;
    if (!mimic) return std::nullopt;
    const int master = lumped_joint_[mimic->joint];
    if (master < 0) {
      Fail(fmt::format("joint '{}' mimics '{}', which does not move in the plane", Name(joint),
                       Name(mimic->joint)));
    }
    const double sign = sign_[joint];
    const Mimic coupling{master, sign * mimic->multiplier * sign_[mimic->joint],
                         sign * mimic->offset};
    if (master != lumped_joint_[joint]) return coupling;
    if (std::abs(coupling.multiplier - 1) > kTolerance || std::abs(coupling.offset) > kTolerance) {
      Fail(fmt::format("joint '{}' mimics '{}', but not symmetrically", Name(joint),
                       Name(mimic->joint)));
    }
    return std::nullopt;
  }

  void CoupleJoints() {
    for (int i = 0; i < robot_.num_joints(); ++i) {
      if (!placements_[i].free) CheckLockedCoupling(i);
    }
    for (std::size_t i = 0; i < result_.joints.size(); ++i) {
      const SagittalJoint& pair = result_.joints[i];
      const std::optional<Mimic> left = LumpedCoupling(pair.left);
      result_.tree.joints[i].mimic = left;
      if (pair.right < 0) continue;
      const std::optional<Mimic> right = LumpedCoupling(pair.right);
      const bool alike = left.has_value() == right.has_value() &&
                         (!left || (left->joint == right->joint &&
                                    std::abs(left->multiplier - right->multiplier) <= kTolerance &&
                                    std::abs(left->offset - right->offset) <= kTolerance));
      if (!alike) Fail(PairName(pair.left, pair.right) + " mimic other joints differently");
    }
  }

  void CheckLockedCoupling(int joint) const {
    const std::optional<Mimic>& mimic = robot_.joints[joint].mimic;
    if (!mimic) return;
    if (placements_[mimic->joint].free) {
      Fail(fmt::format("joint '{}' leaves the plane, but mimics '{}', which moves in it",
                       Name(joint), Name(mimic->joint)));
    }
    const double expected = mimic->multiplier * result_.rest[mimic->joint] + mimic->offset;
    if (!(std::abs(result_.rest[joint] - expected) <= kTolerance)) {
      Fail(fmt::format("joint '{}' is locked at {:.6g}, but mimics '{}' and should be at {:.6g}",
                       Name(joint), result_.rest[joint], Name(mimic->joint), expected));
    }
  }

  /// A contact of the full robot in its lumped link.
  struct PlacedPatch {
    int group = 0;
    std::vector<Vector3d> points;
    Vector3d normal;
  };

  PlacedPatch Placed(const models::ContactPatch& patch) const {
    const Isometry3d& X_GL = result_.X_GL[patch.link];
    PlacedPatch placed{result_.lumped_link[patch.link], {}, X_GL.linear() * patch.normal_L};
    for (const Vector3d& p_L : patch.points) placed.points.push_back(X_GL * p_L);
    return placed;
  }

  static bool AreMirrorImages(const PlacedPatch& a, const PlacedPatch& b) {
    if (a.group != b.group || a.points.size() != b.points.size()) return false;
    return Near(a.normal, Mirrored(b.normal)) &&
           std::all_of(a.points.begin(), a.points.end(), [&](const Vector3d& p) {
             return std::any_of(b.points.begin(), b.points.end(),
                                [&](const Vector3d& r) { return Near(p, Mirrored(r)); });
           });
  }

  void MergeContacts() {
    const int count = static_cast<int>(robot_.contacts.size());
    std::vector<PlacedPatch> placed;
    for (const models::ContactPatch& patch : robot_.contacts) placed.push_back(Placed(patch));
    std::vector<bool> used(count, false);
    for (int i = 0; i < count; ++i) {
      if (used[i]) continue;
      int mirror = AreMirrorImages(placed[i], placed[i]) ? i : -1;
      for (int k = i + 1; k < count && mirror < 0; ++k) {
        if (!used[k] && AreMirrorImages(placed[i], placed[k])) mirror = k;
      }
      if (mirror < 0) {
        Fail(fmt::format("contact '{}' has no mirror image", robot_.contacts[i].name));
      }
      used[i] = used[mirror] = true;
      const bool i_is_left = robot_.contacts[i].points.empty() ||
                             placed[i].points[0].y() >= placed[mirror].points[0].y();
      AddContact(i_is_left ? i : mirror, i_is_left ? mirror : i, placed);
    }
  }

  void AddContact(int left, int right, const std::vector<PlacedPatch>& placed) {
    models::ContactPatch patch;
    patch.name = robot_.contacts[left].name;
    patch.link = placed[left].group;
    patch.normal_L = InPlane(placed[left].normal);
    if (!(patch.normal_L.norm() > kTolerance)) {
      Fail(fmt::format("contact '{}' faces sideways", patch.name));
    }
    patch.normal_L.normalize();
    std::vector<std::vector<ContactPoint>> full_points;
    const std::set<int> sources = {left, right};
    for (const int source : {left, right}) {
      if (source == right && sources.size() == 1) break;
      const models::ContactPatch& full = robot_.contacts[source];
      for (std::size_t i = 0; i < full.points.size(); ++i) {
        const Vector3d p = InPlane(placed[source].points[i]);
        std::size_t k = 0;
        while (k < patch.points.size() && !Near(patch.points[k], p)) ++k;
        if (k == patch.points.size()) {
          patch.points.push_back(p);
          full_points.emplace_back();
        }
        full_points[k].push_back({full.link, full.points[i]});
      }
    }
    result_.tree.contacts.push_back(patch);
    result_.full_points.push_back(full_points);
  }

  const models::RobotModel& robot_;
  std::vector<int> partner_;       // by full joint: the other one of its pair, or -1
  std::vector<double> sign_;       // by full joint: its position over the left one's
  std::vector<bool> is_right_;     // by full joint
  std::vector<int> lumped_joint_;  // by full joint: joint of the tree, or -1
  std::vector<Placement> placements_;
  std::vector<Isometry3d> X_WL_;   // by full link, everything at rest
  std::vector<Vector3d> origins_;  // by link of the tree, everything at rest
  SagittalLumping result_;
};

}  // namespace

SagittalLumping LumpSagittally(const models::RobotModel& robot, const Eigen::VectorXd& locked) {
  return Folder(robot, locked).Fold();
}

}  // namespace possibility::dynamics
