#include "models/facts/body_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>

#include "models/facts/zero_poses.h"
#include "models/input/input_error.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

constexpr double kMirrorTolerance = 0.03;  // m, to recognise pairs; their accuracy is judged later
constexpr double kBeside = 0.005;          // m, of a limb's joint from the middle
constexpr std::size_t kLegJoints = 6;
constexpr std::size_t kMostArmJoints = 7;

/// Joints that move, and where they are.
class JointTree {
 public:
  explicit JointTree(const UrdfTree& tree) : tree_(tree), X_RL_(ZeroPoses(tree)) {
    for (const UrdfJoint& joint : tree.joints) {
      above_[joint.child] = &joint;
      if (joint.type == "fixed") continue;
      moving_.push_back(&joint);
    }
    for (const UrdfJoint* joint : moving_) {
      if (const UrdfJoint* parent = MovingAbove(joint->parent))
        below_[parent->name].push_back(joint);
    }
  }

  const std::vector<const UrdfJoint*>& moving() const { return moving_; }
  Vector3d Place(const UrdfJoint& joint) const { return X_RL_.at(joint.child).translation(); }
  const std::vector<const UrdfJoint*>& Below(const UrdfJoint& joint) const {
    static const std::vector<const UrdfJoint*> kNone;
    const auto found = below_.find(joint.name);
    return found == below_.end() ? kNone : found->second;
  }

  /// From the root to the joint.
  std::vector<const UrdfJoint*> Chain(const UrdfJoint& last) const {
    std::vector<const UrdfJoint*> chain;
    for (const UrdfJoint* joint = &last; joint != nullptr; joint = MovingAbove(joint->parent)) {
      chain.push_back(joint);
    }
    std::reverse(chain.begin(), chain.end());
    return chain;
  }

  /// The joint nearest to the mirrored place, or null if none is near; with as many joints above.
  const UrdfJoint* Mirrored(const UrdfJoint& joint) const {
    const Vector3d place = Place(joint).cwiseProduct(Vector3d(1, -1, 1));
    const std::size_t depth = Chain(joint).size();
    const UrdfJoint* best = nullptr;
    double nearest = kMirrorTolerance;
    for (const UrdfJoint* other : moving_) {
      if (other == &joint || Chain(*other).size() != depth) continue;
      if (const double distance = (Place(*other) - place).norm(); distance < nearest) {
        nearest = distance;
        best = other;
      }
    }
    return best;
  }

 private:
  const UrdfJoint* MovingAbove(std::string link) const {
    while (true) {
      const auto found = above_.find(link);
      if (found == above_.end()) return nullptr;
      if (found->second->type != "fixed") return found->second;
      link = found->second->parent;
    }
  }

  const UrdfTree& tree_;
  std::map<std::string, Eigen::Isometry3d> X_RL_;
  std::map<std::string, const UrdfJoint*> above_;  ///< by child link
  std::vector<const UrdfJoint*> moving_;
  std::map<std::string, std::vector<const UrdfJoint*>> below_;  ///< by joint
};

using Joints = std::vector<const UrdfJoint*>;

/// What the chains of two limbs share is the trunk.
std::size_t Shared(const Joints& a, const Joints& b) {
  return std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin();
}

LimbChain ChainFrom(const Joints& joints, std::size_t first, std::size_t most) {
  LimbChain chain;
  for (std::size_t i = first; i < joints.size() && chain.joints.size() < most; ++i) {
    chain.joints.push_back(joints[i]->name);
    chain.tip = joints[i]->child;
  }
  return chain;
}

class PlanFinder {
 public:
  PlanFinder(const UrdfTree& tree, std::string file) : joints_(tree), file_(std::move(file)) {}

  BodyPlan Find() {
    FindLegs();
    FindArms();
    LumpTheRest();
    return std::move(plan_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { throw InputError(file_ + ": " + what); }

  void FindLegs() {
    const UrdfJoint* lowest = nullptr;
    for (const UrdfJoint* joint : joints_.moving()) {
      const Vector3d place = joints_.Place(*joint);
      if (place.y() < kBeside || joints_.Mirrored(*joint) == nullptr) continue;
      const double lead = lowest == nullptr ? 1 : joints_.Place(*lowest).z() - place.z();
      // Of joints at one place the last.
      if (lead > 1e-6 ||
          (lead > -1e-6 && joints_.Chain(*joint).size() > joints_.Chain(*lowest).size())) {
        lowest = joint;
      }
    }
    if (lowest == nullptr || joints_.Place(*lowest).z() >= 0) {
      Fail(
          "no two legs below the root link: expected a left and a right chain of joints (x ahead, "
          "y to the left, z up in the root link's frame)");
    }
    const Joints left = joints_.Chain(*lowest), right = joints_.Chain(*joints_.Mirrored(*lowest));
    const std::size_t first = Shared(left, right);
    if (left.size() - first < kLegJoints || right.size() != left.size()) {
      Fail(fmt::format(
          "the legs that end in '{}' and '{}' have {} and {} joints, expected 6 each: "
          "fewer cannot place a foot in every direction",
          left.back()->name, right.back()->name, left.size() - first, right.size() - first));
    }
    plan_.left_leg = ChainFrom(left, first, kLegJoints);
    plan_.right_leg = ChainFrom(right, first, kLegJoints);
    RequireUncoupled(plan_.left_leg);
    RequireUncoupled(plan_.right_leg);
    for (std::size_t i = 0; i < first; ++i) plan_.trunk.push_back(left[i]->name);
    plan_.findings.push_back(fmt::format("legs: {}; {} (the lowest pair of joints left and right)",
                                         fmt::join(plan_.left_leg.joints, ", "),
                                         fmt::join(plan_.right_leg.joints, ", ")));
  }

  void RequireUncoupled(const LimbChain& leg) const {
    for (const UrdfJoint* joint : joints_.moving()) {
      const auto& names = leg.joints;
      const auto has = [&names](const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
      };
      if (joint->mimic && (has(joint->name) || has(joint->mimic->joint))) {
        Fail(fmt::format("joint '{}' mimics '{}', and legs move each joint by itself", joint->name,
                         joint->mimic->joint));
      }
    }
  }

  /// The chain on from a joint until it branches or mimics.
  Joints Onward(const UrdfJoint& first) const {
    Joints chain = joints_.Chain(first);
    while (true) {
      const Joints& below = joints_.Below(*chain.back());
      if (below.size() != 1 || below.front()->mimic) return chain;
      chain.push_back(below.front());
    }
  }

  double LengthFrom(const Joints& chain, std::size_t first) const {
    double length = 0;
    for (std::size_t i = first + 1; i < chain.size(); ++i) {
      length += (joints_.Place(*chain[i]) - joints_.Place(*chain[i - 1])).norm();
    }
    return length;
  }

  void FindArms() {
    double longest = 0;
    for (const UrdfJoint* joint : joints_.moving()) {
      const UrdfJoint* other = joints_.Mirrored(*joint);
      if (other == nullptr || joints_.Place(*joint).y() < kBeside || IsOfALeg(*joint)) continue;
      const Joints left = Onward(*joint), right = Onward(*other);
      const std::size_t first = Shared(left, right);
      const std::size_t end = std::min({left.size(), right.size(), first + kMostArmJoints});
      const Joints arm(left.begin(), left.begin() + end);
      if (end - first < 3 || !(LengthFrom(arm, first) > longest)) continue;
      longest = LengthFrom(arm, first);
      plan_.left_arm = ChainFrom(arm, first, kMostArmJoints);
      plan_.right_arm =
          ChainFrom(Joints(right.begin(), right.begin() + end), first, kMostArmJoints);
      trunk_of_arms_.assign(left.begin(), left.begin() + first);
    }
    for (const UrdfJoint* joint : trunk_of_arms_) {
      if (!joint->mimic && !Contains(plan_.trunk, joint->name)) plan_.trunk.push_back(joint->name);
    }
    plan_.findings.push_back(plan_.left_arm.joints.empty()
                                 ? "no arms of at least three joints"
                                 : fmt::format("arms: {}; {} (the longest other pair)",
                                               fmt::join(plan_.left_arm.joints, ", "),
                                               fmt::join(plan_.right_arm.joints, ", ")));
  }

  static bool Contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  }

  bool IsOfALeg(const UrdfJoint& joint) const {
    for (const UrdfJoint* above : joints_.Chain(joint)) {
      if (Contains(plan_.left_leg.joints, above->name) ||
          Contains(plan_.right_leg.joints, above->name)) {
        return true;
      }
    }
    return false;
  }

  void LumpTheRest() {
    for (const UrdfJoint* joint : joints_.moving()) {
      const std::string& name = joint->name;
      if (Contains(plan_.trunk, name) || Contains(plan_.left_leg.joints, name) ||
          Contains(plan_.right_leg.joints, name) || Contains(plan_.left_arm.joints, name) ||
          Contains(plan_.right_arm.joints, name)) {
        continue;
      }
      plan_.lump.insert(name);
    }
    if (!plan_.lump.empty()) {
      plan_.findings.push_back(fmt::format("held at 0: {} (in neither legs, arms nor trunk)",
                                           fmt::join(plan_.lump, ", ")));
    }
  }

  JointTree joints_;
  const std::string file_;
  BodyPlan plan_;
  Joints trunk_of_arms_;
};

}  // namespace

BodyPlan FindBodyPlan(const UrdfTree& tree, const std::filesystem::path& urdf_file) {
  return PlanFinder(tree, urdf_file.string()).Find();
}

}  // namespace possibility::models
