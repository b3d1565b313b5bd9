#include "actions/onboarding/robot_yaml_writer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <numbers>

namespace possibility::actions {
namespace {

using models::Shape;
using models::ShapeType;

constexpr double kDegrees = 180 / std::numbers::pi;

/// Quoted for YAML, whatever it contains.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string Quoted(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& name : names) quoted.push_back(Quoted(name));
  return fmt::format("[{}]", fmt::join(quoted, ", "));
}

/// To a tenth of a micrometre, and no minus zero.
std::string List(const Eigen::Vector3d& v) {
  const auto rounded = [](double x) { return std::round(x * 1e7) / 1e7 + 0.0; };
  return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

std::string Dimensions(const Shape& shape) {
  switch (shape.type) {
    case ShapeType::kBox:
      return fmt::format("box, size: {}", List(shape.size));
    case ShapeType::kSphere:
      return fmt::format("sphere, radius: {:.10g}", shape.radius);
    case ShapeType::kCylinder:
      return fmt::format("cylinder, radius: {:.10g}, length: {:.10g}", shape.radius, shape.length);
    case ShapeType::kCapsule:
      return fmt::format("capsule, radius: {:.10g}, length: {:.10g}", shape.radius, shape.length);
    case ShapeType::kConvexMesh:
      break;
  }
  std::vector<std::string> vertices;
  for (const Eigen::Vector3d& vertex : shape.vertices) vertices.push_back(List(vertex));
  return fmt::format("convex, vertices: [{}]", fmt::join(vertices, ", "));
}

/// Turns about the fixed axes x, y, z in this order, degrees.
Eigen::Vector3d RollPitchYawDegrees(const Eigen::Matrix3d& R) {
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  const bool is_upright = std::abs(R(2, 0)) < 1 - 1e-12;
  const double roll = is_upright ? std::atan2(R(2, 1), R(2, 2)) : std::atan2(-R(1, 2), R(1, 1));
  const double yaw = is_upright ? std::atan2(R(1, 0), R(0, 0)) : 0;
  return Eigen::Vector3d(roll, pitch, yaw) * kDegrees;
}

/// Convex shapes in the link's frame, so that they need no pose.
std::string ShapeLine(const models::PosedShape& posed) {
  if (posed.shape.type == ShapeType::kConvexMesh) {
    Shape placed = posed.shape;
    for (Eigen::Vector3d& vertex : placed.vertices) vertex = posed.X_PS * vertex;
    return fmt::format("    - {{shape: {}}}\n", Dimensions(placed));
  }
  const Eigen::Vector3d rpy = RollPitchYawDegrees(posed.X_PS.linear());
  return fmt::format("    - {{shape: {}, position: {}{}}}\n", Dimensions(posed.shape),
                     List(posed.X_PS.translation()),
                     rpy.norm() < 1e-9 ? "" : ", rpy_deg: " + List(rpy));
}

class YamlWriter {
 public:
  explicit YamlWriter(const RobotDraft& draft) : draft_(draft), robot_(draft.robot) {}

  std::string Write(const std::string& urdf) {
    Head(urdf);
    Positions();
    Inertials();
    Limits("effort", draft_.efforts);
    Limits("velocity", draft_.speeds);
    Shapes();
    Contacts();
    Pairs();
    text_ += "\ngaits:\n";
    for (const models::Gait& gait : robot_.gaits) WriteGait(gait);
    return text_;
  }

 private:
  template <typename... Args>
  void Add(fmt::format_string<Args...> format, Args&&... args) {
    text_ += fmt::format(format, std::forward<Args>(args)...);
  }

  void Head(const std::string& urdf) {
    Add("# Written by `possibility robot init`. Schema: docs/file_formats.md, \"Robot YAML\".\n");
    for (const std::string& finding : draft_.findings) Add("#   {}\n", finding);
    for (const std::string& warning : draft_.warnings) Add("#   warning: {}\n", warning);
    Add("name: {}\nurdf: {}\nroot_link: {}\npelvis_link: {}\n", Quoted(robot_.name), Quoted(urdf),
        Quoted(draft_.tree.root), Quoted(robot_.links[robot_.pelvis_shape_link].name));
    if (!draft_.plan.lump.empty()) {
      Add("lump: {}\n",
          Quoted(std::vector<std::string>(draft_.plan.lump.begin(), draft_.plan.lump.end())));
    }
    Add("friction: {:.6g}\n", robot_.friction);
  }

  void Positions() {
    if (draft_.positions.empty()) return;
    const models::Joint& joint = robot_.joints[robot_.JointIndex(draft_.positions.front())];
    Add("\nposition:\n  - joints: {}\n    limits_deg: [{:.6g}, {:.6g}]\n    reason: not in the "
        "URDF; "
        "assumed\n",
        Quoted(draft_.positions), joint.lower * kDegrees, joint.upper * kDegrees);
  }

  void Inertials() {
    if (draft_.inertials.empty()) return;
    Add("\ninertials:\n");
    for (const AssumedInertial& assumed : draft_.inertials) {
      const models::Inertial& body = assumed.inertial;
      const Eigen::Matrix3d& I = body.I_LC;
      Add("  - link: {}\n    mass: {:.10g}\n    com: {}\n    moments: [{:.10g}, {:.10g}, {:.10g}]\n"
          "    products: [{:.10g}, {:.10g}, {:.10g}]\n    reason: {}\n",
          Quoted(assumed.link), body.mass, List(body.p_LC), I(0, 0), I(1, 1), I(2, 2), I(0, 1),
          I(0, 2), I(1, 2), Quoted(assumed.reason));
    }
  }

  void Limits(const char* key, const std::vector<AssumedLimit>& limits) {
    if (limits.empty()) return;
    Add("\n{}:\n", key);
    for (const AssumedLimit& limit : limits) {
      Add("  - joints: {}\n    limit: {:.6g}\n    reason: {}\n", Quoted(limit.joints), limit.limit,
          Quoted(limit.reason));
    }
  }

  void Shapes() {
    Add("\nshapes:\n");
    for (const models::Link& link : robot_.links) {
      if (link.shapes.empty()) continue;
      Add("  {}:\n", Quoted(link.name));
      for (const models::PosedShape& posed : link.shapes) text_ += ShapeLine(posed);
    }
  }

  void Contacts() {
    Add("\ncontacts:\n");
    for (const models::ContactPatch& contact : robot_.contacts) {
      std::vector<std::string> points;
      for (const Eigen::Vector3d& p : contact.points) points.push_back(List(p));
      Add("  - name: {}\n    link: {}\n    points: [{}]\n    normal: {}\n", Quoted(contact.name),
          Quoted(robot_.links[contact.link].name), fmt::join(points, ", "), List(contact.normal_L));
    }
  }

  void Pairs() {
    Add("\nsagittal_pairs:\n");
    for (const models::MirrorPairs::Pair& pair : draft_.pairs.pairs) {
      Add("  - [{}, {}]\n", Quoted(robot_.joints[pair.left].name),
          Quoted(robot_.joints[pair.right].name));
    }
    if (draft_.ignored.empty()) return;
    Add("\nignored_collisions:\n");
    for (const IgnoredPair& pair : draft_.ignored) {
      Add("  - [{}, {}]  # {}\n", Quoted(robot_.links[pair.link].name),
          Quoted(robot_.links[pair.other].name), pair.reason);
    }
  }

  void WriteGait(const models::Gait& gait) {
    Add("  - name: {}\n    posture:\n      root_height: {:.9f}\n      root_pitch_deg: {:.9g}\n"
        "      joints_deg: {{",
        Quoted(gait.name), gait.posture.root_height, gait.posture.root_pitch * kDegrees);
    const char* separator = "";
    for (int i = 0; i < robot_.num_joints(); ++i) {
      const double unit = robot_.joints[i].type == models::JointType::kPrismatic ? 1 : kDegrees;
      const double value = gait.posture.joints[i] * unit;
      if (value == 0 || robot_.joints[i].mimic) continue;
      Add("{}{}: {:.9f}", separator, Quoted(robot_.joints[i].name), value);
      separator = ", ";
    }
    Add("}}\n    limbs:\n");
    for (const models::GaitLimb& limb : gait.limbs) {
      std::vector<std::string> joints;
      for (const int joint : limb.joints) joints.push_back(robot_.joints[joint].name);
      Add("      - contact: {}\n        hold_orientation: {}\n        joints: {}\n",
          Quoted(robot_.contacts[limb.contact].name), limb.hold_orientation, Quoted(joints));
    }
    const models::GaitParameters& p = gait.parameters;
    Add("    parameters:\n      forward: {:.4g}\n      lateral: {:.4g}\n      turn_deg: {:.4g}\n"
        "      clearance: {:.4g}\n      com_margin: {:.4g}\n      swing_time: {:.4g}\n"
        "      com_acceleration: {:.4g}\n      minimum_shift_time: {:.4g}\n",
        p.forward, p.lateral, p.turn * kDegrees, p.clearance, p.com_margin, p.swing_time,
        p.com_acceleration, p.minimum_shift_time);
    if (p.sway != 0) Add("      sway_deg: {:.4g}\n", p.sway * kDegrees);
  }

  const RobotDraft& draft_;
  const models::RobotModel& robot_;
  std::string text_;
};

}  // namespace

std::string RobotYaml(const RobotDraft& draft, const std::string& urdf) {
  return YamlWriter(draft).Write(urdf);
}

std::string FlatScenarioYaml(const std::string& name, const std::string& robot, double distance,
                             double height) {
  const double beyond = 1.5 * height;
  return fmt::format(
      "# Written by `possibility robot init`: a level floor.\n"
      "name: {}\nrobot: {}\nactions: [walk]\n"
      "start: {{action: walk, x: 0, y: 0, yaw_deg: 0}}\ngoal: {{action: walk, x: {:.4g}, y: 0, "
      "yaw_deg: 0}}\n"
      "time_limit: 60\nseed: 1\nenvironment:\n"
      "  bounds: {{x: [{:.4g}, {:.4g}], y: [{:.4g}, {:.4g}]}}\n"
      "  ground:\n    - {{name: floor, size: [{:.4g}, {:.4g}, 0.5], position: [{:.4g}, 0, "
      "-0.25]}}\n",
      Quoted(name), Quoted(robot), distance, -beyond, distance + beyond, -beyond, beyond,
      distance + 4 * beyond, 4 * beyond, distance / 2);
}

}  // namespace possibility::actions
