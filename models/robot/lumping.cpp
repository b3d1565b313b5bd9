#include "models/robot/lumping.h"

#include <fmt/format.h>

#include <limits>
#include <map>
#include <utility>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

Eigen::Matrix3d PointInertia(double mass, const Eigen::Vector3d& p) {
  return mass * (p.squaredNorm() * Eigen::Matrix3d::Identity() - p * p.transpose());
}

class TreeBuilder {
 public:
  TreeBuilder(const UrdfTree& tree, const std::set<std::string>& lumped, std::string file,
              RobotModel* robot)
      : lumped_(lumped), file_(std::move(file)), robot_(robot) {
    for (const UrdfLink& link : tree.links) links_.emplace(link.name, &link);
    for (const UrdfJoint& joint : tree.joints) joints_below_.emplace(joint.parent, &joint);
  }

  PendingMeshes Build(const std::string& root) {
    robot_->links.push_back({root, {}, {}});
    Attach(root, 0, Eigen::Isometry3d::Identity());
    for (const Link& link : robot_->links) {
      CheckOwnInertial(link);
      if (!(link.inertial.mass > 0)) {
        Fail(
            fmt::format("link '{}': expected an inertial (only links on fixed or lumped joints may "
                        "go without)",
                        link.name));
      }
      CheckMovingBody(link.inertial, fmt::format("{}: link '{}'", file_, link.name));
    }
    return std::move(meshes_);
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const { throw InputError(file_ + ": " + what); }

  // Before anything is lumped into the link, unless that outweighs it.
  void CheckOwnInertial(const Link& link) const {
    const std::optional<Inertial>& own = links_.at(link.name)->inertial;
    if (!own || (own->mass == 0 && own->I_LC.isZero(0))) return;
    if (own->mass > 0 && 2 * own->mass < link.inertial.mass) return;
    CheckMovingBody(*own, fmt::format("{}: link '{}'", file_, link.name));
  }

  // Adds the URDF link to the kept link `kept`, posed there at X_KL, and continues below it.
  void Attach(const std::string& name, int kept, const Eigen::Isometry3d& X_KL) {
    const UrdfLink& source = *links_.at(name);
    Link& target = robot_->links[kept];
    if (source.inertial) CheckDefinite(*source.inertial, fmt::format("{}: link '{}'", file_, name));
    // Without a mass it is a frame.
    if (source.inertial && source.inertial->mass > 0) {
      target.inertial = Combined(target.inertial, *source.inertial, X_KL);
    }
    for (const PosedShape& posed : source.shapes) {
      target.shapes.push_back({posed.shape, X_KL * posed.X_PS});
    }
    for (UrdfMesh mesh : source.meshes) {
      mesh.X_LM = X_KL * mesh.X_LM;
      meshes_.emplace(kept, std::move(mesh));
    }
    const auto [begin, end] = joints_below_.equal_range(name);
    for (auto it = begin; it != end; ++it) {
      const UrdfJoint& joint = *it->second;
      const Eigen::Isometry3d X_KJ = X_KL * joint.X_PJ;
      if (joint.type == "fixed" || lumped_.contains(joint.name)) {
        Attach(joint.child, kept, X_KJ);
      } else {
        robot_->joints.push_back(KeptJoint(joint, kept, X_KJ));
        robot_->links.push_back({joint.child, {}, {}});
        Attach(joint.child, robot_->num_links() - 1, Eigen::Isometry3d::Identity());
      }
    }
  }

  Joint KeptJoint(const UrdfJoint& joint, int parent, const Eigen::Isometry3d& X_PJ) const {
    const std::string owner = fmt::format("joint '{}'", joint.name);
    static const std::map<std::string, JointType> kTypes = {{"revolute", JointType::kRevolute},
                                                            {"continuous", JointType::kContinuous},
                                                            {"prismatic", JointType::kPrismatic}};
    const auto type = kTypes.find(joint.type);
    if (type == kTypes.end()) {
      Fail(
          fmt::format("{}: {} joints are not supported, expected fixed, revolute, continuous or "
                      "prismatic",
                      owner, joint.type));
    }
    if (!joint.has_limits) Fail(owner + ": expected a <limit> with velocity and effort");
    if (!(joint.axis.norm() > 1e-9)) Fail(owner + ": the axis is zero");
    Joint result{joint.name,  type->second, parent,         X_PJ,         joint.axis.normalized(),
                 joint.lower, joint.upper,  joint.velocity, joint.effort, std::nullopt};
    if (result.type == JointType::kContinuous) {
      result.lower = -std::numeric_limits<double>::infinity();
      result.upper = std::numeric_limits<double>::infinity();
    }
    return result;
  }

  const std::set<std::string>& lumped_;
  const std::string file_;
  RobotModel* robot_;
  PendingMeshes meshes_;
  std::map<std::string, const UrdfLink*> links_;
  // Joints come sorted by name, and equal keys keep their order of insertion.
  std::multimap<std::string, const UrdfJoint*> joints_below_;
};

}  // namespace

Inertial Combined(const Inertial& total, const Inertial& body, const Eigen::Isometry3d& X_PL) {
  const Eigen::Vector3d p_PB = X_PL * body.p_LC;
  const Eigen::Matrix3d I_PB = X_PL.linear() * body.I_LC * X_PL.linear().transpose();
  Inertial sum;
  sum.mass = total.mass + body.mass;
  sum.p_LC = (total.mass * total.p_LC + body.mass * p_PB) / sum.mass;
  sum.I_LC = total.I_LC + PointInertia(total.mass, total.p_LC - sum.p_LC) + I_PB +
             PointInertia(body.mass, p_PB - sum.p_LC);
  return sum;
}

PendingMeshes BuildLumpedTree(const UrdfTree& tree, const std::set<std::string>& lumped,
                              const std::string& file, RobotModel* robot) {
  return TreeBuilder(tree, lumped, file, robot).Build(tree.root);
}

}  // namespace possibility::models
