#include "models/robot/mimic_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::models {
namespace {

constexpr double kSmallestMultiplier = 1e-6;
constexpr double kLargestNumber = 1e6;

class Coupler {
 public:
  Coupler(const UrdfTree& tree, const std::set<std::string>& lumped, std::string file,
          RobotModel* robot)
      : lumped_(lumped), file_(std::move(file)), robot_(robot) {
    for (const UrdfJoint& joint : tree.joints) joints_.emplace(joint.name, &joint);
  }

  void Couple() {
    for (const auto& [name, joint] : joints_) {
      if (joint->type == "fixed" && joint->mimic) {
        Fail(*joint, "a fixed joint cannot mimic another one");
      }
    }
    for (Joint& joint : robot_->joints) {
      joint.mimic = Resolved(*joints_.at(joint.name));
      if (joint.mimic) joint.effort = std::numeric_limits<double>::infinity();
    }
    for (int joint = 0; joint < robot_->num_joints(); ++joint) CheckLimits(joint);
  }

 private:
  [[noreturn]] void Fail(const UrdfJoint& joint, const std::string& what) const {
    throw InputError(fmt::format("{}: joint '{}': mimic: {}", file_, joint.name, what));
  }

  const UrdfJoint& MasterOf(const UrdfJoint& joint) const {
    const std::string& name = joint.mimic->joint;
    const auto master = joints_.find(name);
    if (master == joints_.end()) {
      std::vector<std::string> known;
      for (const auto& [other, unused] : joints_) known.push_back(other);
      Fail(joint, fmt::format("unknown joint '{}'{}", name, DidYouMean(name, known)));
    }
    if (master->second->type == "fixed") Fail(joint, fmt::format("joint '{}' is fixed", name));
    if (lumped_.contains(name)) {
      Fail(joint, fmt::format("joint '{}' is lumped, expected '{}' to be lumped as well", name,
                              joint.name));
    }
    return *master->second;
  }

  void CheckNumbers(const UrdfJoint& joint, double multiplier, double offset) const {
    if (!(std::abs(multiplier) >= kSmallestMultiplier && std::abs(multiplier) <= kLargestNumber)) {
      Fail(joint, fmt::format("expected a multiplier of {:g} to {:g} in magnitude, got {}",
                              kSmallestMultiplier, kLargestNumber, multiplier));
    }
    if (!(std::abs(offset) <= kLargestNumber)) {
      Fail(joint, fmt::format("expected an offset of at most {:g} in magnitude, got {}",
                              kLargestNumber, offset));
    }
  }

  /// Follows the chain of masters to its end.
  std::optional<Mimic> Resolved(const UrdfJoint& joint) const {
    if (!joint.mimic) return std::nullopt;
    Mimic mimic;
    std::set<std::string> passed = {joint.name};
    const UrdfJoint* last = &joint;
    for (; last->mimic; last = &MasterOf(*last)) {
      if (!passed.insert(last->mimic->joint).second) {
        Fail(joint,
             fmt::format("it follows joints in a circle, by way of '{}'", last->mimic->joint));
      }
      mimic.offset += mimic.multiplier * last->mimic->offset;
      mimic.multiplier *= last->mimic->multiplier;
      CheckNumbers(joint, mimic.multiplier, mimic.offset);
    }
    mimic.joint = robot_->JointIndex(last->name);
    return mimic;
  }

  /// Checks that some interval of a master's positions is within its limits and those of all its
  /// mimics.
  void CheckLimits(int master) const {
    double lower = robot_->joints[master].lower;
    double upper = robot_->joints[master].upper;
    for (const Joint& joint : robot_->joints) {
      if (!joint.mimic || joint.mimic->joint != master) continue;
      const Mimic& mimic = *joint.mimic;
      double from = (joint.lower - mimic.offset) / mimic.multiplier;
      double to = (joint.upper - mimic.offset) / mimic.multiplier;
      if (mimic.multiplier < 0) std::swap(from, to);
      if (std::max(lower, from) < std::min(upper, to)) {
        lower = std::max(lower, from);
        upper = std::min(upper, to);
        continue;
      }
      Fail(*joints_.at(joint.name),
           fmt::format("its limits want joint '{}' within {:.6g} to {:.6g}, which contradicts "
                       "{:.6g} to {:.6g}",
                       robot_->joints[master].name, from, to, lower, upper));
    }
  }

  const std::set<std::string>& lumped_;
  const std::string file_;
  RobotModel* robot_;
  std::map<std::string, const UrdfJoint*> joints_;
};

}  // namespace

void CoupleMimicJoints(const UrdfTree& tree, const std::set<std::string>& lumped,
                       const std::string& file, RobotModel* robot) {
  Coupler(tree, lumped, file, robot).Couple();
}

void FollowMasters(const RobotModel& robot, Eigen::VectorXd* joints) {
  for (int i = 0; i < robot.num_joints(); ++i) {
    const auto& mimic = robot.joints[i].mimic;
    if (mimic) (*joints)[i] = mimic->multiplier * (*joints)[mimic->joint] + mimic->offset;
  }
}

Eigen::VectorXd MotorTorques(const RobotModel& robot, const Eigen::VectorXd& tau) {
  Eigen::VectorXd motors = tau;
  for (int i = 0; i < robot.num_joints(); ++i) {
    const auto& mimic = robot.joints[i].mimic;
    if (!mimic) continue;
    motors[mimic->joint] += mimic->multiplier * tau[i];
    motors[i] = 0;
  }
  return motors;
}

}  // namespace possibility::models
