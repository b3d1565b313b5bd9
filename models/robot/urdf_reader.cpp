#include "models/robot/urdf_reader.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <mutex>

#include "models/input/input_error.h"
#include "models/robot/urdf_extract.h"

namespace possibility::models {
namespace {

// urdfdom reports only to a process-wide handler. Keeps the first errors instead of printing them.
class ErrorCapture : public console_bridge::OutputHandler {
 public:
  ErrorCapture() : lock_(Mutex()) { console_bridge::useOutputHandler(this); }
  ~ErrorCapture() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR || ++count_ > kKept) return;
    errors_ += (errors_.empty() ? "" : "; ") + text;
  }
  // The first error says what is wrong, the second where.
  const std::string& errors() const { return errors_; }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static constexpr int kKept = 2;

  std::lock_guard<std::mutex> lock_;
  std::string errors_;
  int count_ = 0;
};

std::string OneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= 0x20;
    if (!blank) line += c;
    if (blank && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  constexpr std::size_t kLongest = 200;
  return line.size() > kLongest ? line.substr(0, kLongest) + "..." : line;
}

Eigen::Vector3d PrincipalMoments(const Eigen::Matrix3d& inertia) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia, Eigen::EigenvaluesOnly)
      .eigenvalues();
}

std::string Indefinite(const Eigen::Vector3d& principal, const std::string& owner) {
  return fmt::format(
      "{}: inertia is not positive definite (principal moments {:.3g}, {:.3g}, {:.3g} kg m^2)",
      owner, principal[0], principal[1], principal[2]);
}

class UrdfConverter {
 public:
  UrdfConverter(const urdf::ModelInterface& model, const std::vector<std::string>& mesh_files,
                const std::filesystem::path& file)
      : model_(model), mesh_files_(mesh_files), file_(file.string()) {}

  UrdfTree Convert() const {
    UrdfTree tree;
    for (const auto& [name, link] : model_.links_) tree.links.push_back(ConvertLink(*link));
    for (const auto& [name, joint] : model_.joints_) tree.joints.push_back(ConvertJoint(*joint));
    // urdfdom sorts by the names of the extract, in which another byte replaces each '%'.
    std::ranges::sort(tree.links, {}, &UrdfLink::name);
    std::ranges::sort(tree.joints, {}, &UrdfJoint::name);
    tree.root = Root(tree);
    LeaveOutWorld(&tree);
    CheckReachable(tree);
    return tree;
  }

 private:
  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", file_, OneLine(what)));
  }

  Eigen::Isometry3d Pose(const urdf::Pose& pose, const std::string& owner) const {
    const urdf::Vector3& p = pose.position;
    const urdf::Rotation& r = pose.rotation;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Vector3d(p.x, p.y, p.z);
    X.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
    CheckMagnitude({p.x, p.y, p.z}, owner, "origin");
    if (!X.linear().allFinite()) Fail(fmt::format("{}: origin: not a rotation", owner));
    return X;
  }

  // Numbers larger than those of any robot would overflow when squared.
  void CheckMagnitude(const std::vector<double>& values, const std::string& owner,
                      const std::string& what) const {
    for (const double value : values) {
      if (!(std::abs(value) <= 1e6)) {
        Fail(fmt::format("{}: {}: expected numbers of at most 1e6 in magnitude, got {}", owner,
                         what, value));
      }
    }
  }

  UrdfLink ConvertLink(const urdf::Link& link) const {
    UrdfLink result{DecodeUrdfName(link.name), std::nullopt, {}, {}};
    if (link.inertial) result.inertial = ConvertInertial(*link.inertial, result.name);
    for (const auto& collision : link.collision_array) {
      const std::string owner = fmt::format("link '{}': collision", result.name);
      if (!collision || !collision->geometry) Fail(owner + ": no geometry");
      if (const auto* mesh = dynamic_cast<const urdf::Mesh*>(collision->geometry.get())) {
        result.meshes.push_back(ConvertMesh(*mesh, Pose(collision->origin, owner), owner));
        continue;
      }
      result.shapes.push_back(
          {ConvertGeometry(*collision->geometry, collision->name == kCapsuleName, owner),
           Pose(collision->origin, owner)});
    }
    return result;
  }

  Inertial ConvertInertial(const urdf::Inertial& inertial, const std::string& link) const {
    const std::string owner = fmt::format("link '{}'", link);
    const Eigen::Isometry3d X_LC = Pose(inertial.origin, owner + ": inertial");
    CheckMagnitude({inertial.mass, inertial.ixx, inertial.ixy, inertial.ixz, inertial.iyy,
                    inertial.iyz, inertial.izz},
                   owner, "inertial");
    if (!(inertial.mass >= 0)) {
      Fail(fmt::format("{}: expected a positive mass, got {}", owner, inertial.mass));
    }
    Eigen::Matrix3d I_C;
    I_C << inertial.ixx, inertial.ixy, inertial.ixz, inertial.ixy, inertial.iyy, inertial.iyz,
        inertial.ixz, inertial.iyz, inertial.izz;
    return {inertial.mass, X_LC.translation(), X_LC.linear() * I_C * X_LC.linear().transpose()};
  }

  double Dimension(double value, const std::string& owner, const std::string& what) const {
    if (!(value > 0 && value <= 1e6)) {
      Fail(fmt::format("{}: expected a positive {}, got {}", owner, what, value));
    }
    return value;
  }

  Shape ConvertGeometry(const urdf::Geometry& geometry, bool is_capsule,
                        const std::string& owner) const {
    if (const auto* box = dynamic_cast<const urdf::Box*>(&geometry)) {
      return Shape::Box({Dimension(box->dim.x, owner, "box size"),
                         Dimension(box->dim.y, owner, "box size"),
                         Dimension(box->dim.z, owner, "box size")});
    }
    if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&geometry)) {
      return Shape::Sphere(Dimension(sphere->radius, owner, "sphere radius"));
    }
    if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&geometry)) {
      if (is_capsule) {
        return Shape::Capsule(Dimension(cylinder->radius, owner, "capsule radius"),
                              Dimension(cylinder->length, owner, "capsule length"));
      }
      return Shape::Cylinder(Dimension(cylinder->radius, owner, "cylinder radius"),
                             Dimension(cylinder->length, owner, "cylinder length"));
    }
    Fail(owner + ": expected a box, cylinder, sphere, capsule or mesh");
  }

  UrdfMesh ConvertMesh(const urdf::Mesh& mesh, const Eigen::Isometry3d& X_LM,
                       const std::string& owner) const {
    const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
    CheckMagnitude({scale.x(), scale.y(), scale.z()}, owner, "mesh scale");
    if (!(scale.cwiseAbs().minCoeff() > 0)) Fail(owner + ": mesh scale: expected no zero");
    // The extract has numbers in place of names.
    return {mesh_files_.at(std::stoul(mesh.filename)), scale, X_LM};
  }

  static std::string TypeName(int type) {
    static const std::map<int, std::string> kNames = {
        {urdf::Joint::REVOLUTE, "revolute"},   {urdf::Joint::CONTINUOUS, "continuous"},
        {urdf::Joint::PRISMATIC, "prismatic"}, {urdf::Joint::FIXED, "fixed"},
        {urdf::Joint::FLOATING, "floating"},   {urdf::Joint::PLANAR, "planar"}};
    const auto found = kNames.find(type);
    return found == kNames.end() ? "unknown" : found->second;
  }

  std::optional<UrdfMimic> ConvertMimic(const urdf::Joint& joint, const std::string& owner) const {
    if (!joint.mimic) return std::nullopt;
    const urdf::JointMimic& mimic = *joint.mimic;
    CheckMagnitude({mimic.multiplier, mimic.offset}, owner, "mimic");
    return UrdfMimic{DecodeUrdfName(mimic.joint_name), mimic.multiplier, mimic.offset};
  }

  UrdfJoint ConvertJoint(const urdf::Joint& joint) const {
    const std::string name = DecodeUrdfName(joint.name);
    const std::string owner = fmt::format("joint '{}'", name);
    UrdfJoint result{.name = name,
                     .parent = DecodeUrdfName(joint.parent_link_name),
                     .child = DecodeUrdfName(joint.child_link_name),
                     .type = TypeName(joint.type),
                     .mimic = ConvertMimic(joint, owner),
                     .has_limits = joint.limits != nullptr,
                     .X_PJ = Pose(joint.parent_to_joint_origin_transform, owner),
                     .axis = {joint.axis.x, joint.axis.y, joint.axis.z}};
    CheckMagnitude({joint.axis.x, joint.axis.y, joint.axis.z}, owner, "axis");
    if (result.has_limits) {
      const urdf::JointLimits& limits = *joint.limits;
      result.lower = limits.lower;
      result.upper = limits.upper;
      result.velocity = limits.velocity;
      result.effort = limits.effort;
    }
    return result;
  }

  /// Some URDFs say by a joint that the robot floats, which it does anyway.
  static void LeaveOutWorld(UrdfTree* tree) {
    const auto world = std::ranges::find(tree->links, tree->root, &UrdfLink::name);
    const auto joint = std::ranges::find(tree->joints, tree->root, &UrdfJoint::parent);
    if (world->inertial || joint == tree->joints.end() || joint->type != "floating" ||
        std::ranges::count(tree->joints, tree->root, &UrdfJoint::parent) != 1) {
      return;
    }
    tree->root = joint->child;
    tree->links.erase(world);
    tree->joints.erase(joint);
  }

  std::string Root(const UrdfTree& tree) const {
    std::map<std::string, std::string> joint_above;
    for (const UrdfJoint& joint : tree.joints) {
      const auto [other, is_new] = joint_above.emplace(joint.child, joint.name);
      if (!is_new) {
        Fail(fmt::format("link '{}' is the child of two joints, '{}' and '{}'", joint.child,
                         other->second, joint.name));
      }
    }
    std::string root;
    for (const UrdfLink& link : tree.links) {
      if (joint_above.contains(link.name)) continue;
      if (!root.empty()) Fail(fmt::format("two root links, '{}' and '{}'", root, link.name));
      root = link.name;
    }
    if (root.empty()) Fail("no root link: the joints form a cycle");
    return root;
  }

  // Every link but the root has one parent, so a link that the root does not reach hangs on a
  // cycle.
  void CheckReachable(const UrdfTree& tree) const {
    std::multimap<std::string, std::string> children;
    for (const UrdfJoint& joint : tree.joints) children.emplace(joint.parent, joint.child);
    std::vector<std::string> open = {tree.root};
    std::map<std::string, bool> reached;
    while (!open.empty()) {
      const std::string link = open.back();
      open.pop_back();
      reached[link] = true;
      const auto [begin, end] = children.equal_range(link);
      for (auto it = begin; it != end; ++it) open.push_back(it->second);
    }
    for (const UrdfLink& link : tree.links) {
      if (!reached[link.name]) Fail(fmt::format("link '{}' is part of a cycle", link.name));
    }
  }

  const urdf::ModelInterface& model_;
  const std::vector<std::string>& mesh_files_;
  const std::string file_;
};

urdf::ModelInterfaceSharedPtr ParseWithUrdfdom(const std::string& text, const std::string& file) {
  ErrorCapture capture;
  std::string reason;
  try {
    auto model = urdf::parseURDF(text);
    // urdfdom also returns a model without the collision or inertial elements that it could not
    // read.
    if (model && capture.errors().empty()) return model;
    reason = DecodeUrdfName(capture.errors());
  } catch (const std::exception& error) {
    reason = error.what();
  }
  throw InputError(fmt::format("{}: not a valid URDF: {}", file,
                               reason.empty() ? "urdfdom gives no reason" : OneLine(reason)));
}

}  // namespace

UrdfTree ParseUrdf(const std::string& text, const std::filesystem::path& file,
                   UrdfGeometry geometry) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    throw InputError(fmt::format("{}: the file is empty, expected a URDF", file.string()));
  }
  if (text.find('\0') != std::string::npos) {
    throw InputError(fmt::format("{}: not a text file, expected a URDF", file.string()));
  }
  std::vector<std::string> mesh_files;
  const std::string extract = ExtractUrdf(text, file, &mesh_files, geometry);
  const urdf::ModelInterfaceSharedPtr model = ParseWithUrdfdom(extract, file.string());
  return UrdfConverter(*model, mesh_files, file).Convert();
}

void CheckDefinite(const Inertial& inertial, const std::string& owner) {
  constexpr double kRounding = 1e-9;     // of the greatest moment
  constexpr double kNegligible = 1e-15;  // kg m^2
  const Eigen::Vector3d principal = PrincipalMoments(inertial.I_LC);
  if (!(principal[0] >= -std::max(kNegligible, kRounding * std::abs(principal[2])))) {
    throw InputError(Indefinite(principal, owner));
  }
}

void CheckMovingBody(const Inertial& inertial, const std::string& owner) {
  if (!(inertial.mass > 0)) {
    throw InputError(fmt::format("{}: expected a positive mass, got {}", owner, inertial.mass));
  }
  const Eigen::Vector3d principal = PrincipalMoments(inertial.I_LC);
  if (!(principal[0] > 0)) throw InputError(Indefinite(principal, owner));
  constexpr double kRounding = 1e-4;  // published inertias come with few digits
  if (principal[2] > (principal[0] + principal[1]) * (1 + kRounding)) {
    throw InputError(
        fmt::format("{}: no body has this inertia: principal moment {:.3g} exceeds the sum of "
                    "the other two, {:.3g} and {:.3g} kg m^2",
                    owner, principal[2], principal[0], principal[1]));
  }
}

}  // namespace possibility::models
