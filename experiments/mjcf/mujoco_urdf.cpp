#ifdef POSSIBILITY_WITH_MUJOCO

#include "experiments/mjcf/mujoco_urdf.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "experiments/support/file_name.h"
#include "experiments/support/xml_text.h"
#include "models/input/input_error.h"
#include "models/mesh/mesh_writer.h"

namespace possibility::experiments {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kLinkBetween = 1e-6;  // of the body's mass, for a link between two of its joints

Vector3d VectorOf(const mjtNum* p) { return {p[0], p[1], p[2]}; }

Isometry3d PoseOf(const mjtNum* position, const mjtNum* quaternion) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = VectorOf(position);
  X.linear() = Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3])
                   .normalized()
                   .toRotationMatrix();
  return X;
}

/// A URDF turns about fixed axes by roll, pitch and yaw, in this order.
Vector3d RollPitchYaw(const Eigen::Matrix3d& R) {
  const double pitch = std::asin(std::clamp(-R(2, 0), -1.0, 1.0));
  if (std::abs(R(2, 0)) > 1 - 1e-12) return {std::atan2(-R(1, 2), R(1, 1)), pitch, 0};
  return {std::atan2(R(2, 1), R(2, 2)), pitch, std::atan2(R(1, 0), R(0, 0))};
}

std::string Numbers(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

std::string Origin(const Isometry3d& X) {
  return fmt::format("<origin xyz=\"{}\" rpy=\"{}\"/>", Numbers(X.translation()),
                     Numbers(RollPitchYaw(X.linear())));
}

/// A mesh as MuJoCo keeps it: in single precision, about its own frame.
models::TriangleMesh MeshOf(const mjModel& model, int mesh) {
  models::TriangleMesh result;
  const float* vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) {
    result.vertices.emplace_back(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
  }
  const int* faces = model.mesh_face + 3 * model.mesh_faceadr[mesh];
  for (int i = 0; i < model.mesh_facenum[mesh]; ++i) {
    result.triangles.push_back({faces[3 * i], faces[3 * i + 1], faces[3 * i + 2]});
  }
  return result;
}

class Converter {
 public:
  Converter(const mjModel& model, std::string robot, const std::map<std::string, double>& efforts)
      : model_(model), robot_(std::move(robot)), efforts_(efforts) {}

  MjcfRobot Convert() {
    root_ = FindRoot();
    ReadEqualities();
    urdf_ = fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", XmlText(robot_));
    LevelRoot();
    for (int body = 1; body < model_.nbody; ++body) {
      if (IsPart(body)) AddBody(body);
    }
    result_.urdf = urdf_ + "</robot>\n";
    result_.srdf = Srdf();
    return result_;
  }

 private:
  std::string NameOf(int type, int id, const char* kind) const {
    const char* name = mj_id2name(&model_, type, id);
    return name != nullptr && *name != 0 ? name : fmt::format("{}_{}", kind, id);
  }
  std::string Body(int id) const { return NameOf(mjOBJ_BODY, id, "body"); }
  std::string Joint(int id) const { return NameOf(mjOBJ_JOINT, id, "joint"); }

  bool IsPart(int body) const { return model_.body_rootid[body] == root_; }

  /// Whether a tree's root has three slides and three hinges, which stand for a free joint.
  bool IsFreeInParts(int body) const {
    int slides = 0, hinges = 0;
    for (int k = 0; k < model_.body_jntnum[body]; ++k) {
      const int type = model_.jnt_type[model_.body_jntadr[body] + k];
      slides += type == mjJNT_SLIDE;
      hinges += type == mjJNT_HINGE ? 1 : type == mjJNT_BALL ? 3 : 0;
    }
    return model_.body_parentid[body] == 0 && slides == 3 && hinges == 3;
  }

  /// The body's joints but for those with which a robot floats.
  std::vector<int> JointsOf(int body) const {
    std::vector<int> joints;
    if (IsFreeInParts(body)) return joints;
    for (int k = 0; k < model_.body_jntnum[body]; ++k) {
      const int joint = model_.body_jntadr[body] + k;
      if (model_.jnt_type[joint] != mjJNT_FREE) joints.push_back(joint);
    }
    return joints;
  }

  int FindRoot() {
    std::map<int, int> joints;  // of each tree
    for (int body = 1; body < model_.nbody; ++body) {
      joints[model_.body_rootid[body]] += static_cast<int>(JointsOf(body).size());
    }
    std::vector<int> robots;
    std::vector<std::string> names, others;
    for (const auto& [root, count] : joints) {
      if (count > 0) robots.push_back(root);
      (count > 0 ? names : others).push_back(Body(root));
    }
    if (robots.empty())
      throw InputError("expected a robot, a tree of bodies with hinges; no body has one");
    if (robots.size() > 1) {
      throw InputError(fmt::format("expected one robot, got {} trees of bodies with joints: {}",
                                   robots.size(), fmt::join(names, ", ")));
    }
    if (!others.empty()) {
      result_.findings.push_back(
          fmt::format("bodies beside the robot are left out: {}", fmt::join(others, ", ")));
    }
    const int root = robots.front();
    if (!JointsOf(root).empty()) {
      throw InputError(fmt::format("body '{}' moves by '{}' in the world: expected a free joint",
                                   Body(root), Joint(JointsOf(root).front())));
    }
    return root;
  }

  /// A root that stands turned in the world hangs from a link that does not.
  void LevelRoot() {
    const Isometry3d X = PoseOf(model_.body_pos + 3 * root_, model_.body_quat + 4 * root_);
    if (X.linear().isIdentity(1e-12)) return;
    const std::string level = Body(root_) + "_level";
    urdf_ += fmt::format("  <link name=\"{}\"/>\n", XmlText(level));
    AddFixed(Body(root_), level, Isometry3d(X.linear()));
  }

  /// Equalities: joints that follow others, joints that are held, and what no tree has.
  void ReadEqualities() {
    for (int k = 0; k < model_.neq; ++k) {
      if (!model_.eq_active[k]) continue;
      const int first = model_.eq_obj1id[k], second = model_.eq_obj2id[k];
      const std::string name = NameOf(mjOBJ_EQUALITY, k, "equality");
      if (model_.eq_type[k] == mjEQ_JOINT) {
        if (!IsPart(model_.jnt_bodyid[first])) continue;
        const mjtNum* c = model_.eq_data + mjNEQDATA * k;
        if (second < 0) {
          held_[first] = c[0];
          continue;
        }
        if (c[2] != 0 || c[3] != 0 || c[4] != 0) {
          throw InputError(
              fmt::format("equality '{}': expected joint '{}' to follow another one in proportion",
                          name, Joint(first)));
        }
        mimics_[first] = fmt::format("<mimic joint=\"{}\" multiplier=\"{}\" offset=\"{}\"/>",
                                     XmlText(Joint(second)), c[1], c[0]);
        continue;
      }
      const bool is_between =
          (model_.eq_type[k] == mjEQ_CONNECT || model_.eq_type[k] == mjEQ_WELD) && IsPart(first) &&
          IsPart(second);
      if (is_between) {
        throw InputError(
            fmt::format("equality '{}' closes a loop from body '{}' to '{}': expected a tree", name,
                        Body(first), Body(second)));
      }
      result_.findings.push_back(fmt::format("equality '{}' is left out", name));
    }
  }

  /// Where the body's own link is in the body: in its last joint.
  Vector3d LinkIn(int body) const {
    const std::vector<int> joints = JointsOf(body);
    return joints.empty() ? Vector3d::Zero() : VectorOf(model_.jnt_pos + 3 * joints.back());
  }

  void AddBody(int body) {
    const std::vector<int> joints = JointsOf(body);
    if (body != root_) {
      const int parent = model_.body_parentid[body];
      Isometry3d X_PB = PoseOf(model_.body_pos + 3 * body, model_.body_quat + 4 * body);
      X_PB.pretranslate(-LinkIn(parent));
      if (joints.empty()) AddFixed(Body(body), Body(parent), X_PB);
      std::string above = Body(parent);
      Vector3d before = Vector3d::Zero();
      for (std::size_t k = 0; k < joints.size(); ++k) {
        const Vector3d here = VectorOf(model_.jnt_pos + 3 * joints[k]);
        Isometry3d X = k == 0 ? X_PB : Isometry3d::Identity();
        X.translate(here - before);
        const bool is_last = k + 1 == joints.size();
        const std::string link = is_last ? Body(body) : Joint(joints[k]) + "_link";
        if (!is_last) AddLinkBetween(link, body);
        AddJoint(joints[k], above, link, X);
        above = link;
        before = here;
      }
    }
    AddLink(body);
  }

  /// Pose behind a joint at a position, in the joint's frame at zero.
  Isometry3d Moved(int joint, double position) const {
    const Vector3d axis = VectorOf(model_.jnt_axis + 3 * joint);
    if (model_.jnt_type[joint] == mjJNT_SLIDE) {
      return Isometry3d(Eigen::Translation3d(position * axis));
    }
    return Isometry3d(Eigen::AngleAxisd(position, axis));
  }

  void AddFixed(const std::string& child, const std::string& parent, const Isometry3d& X_PB) {
    urdf_ += fmt::format(
        "  <joint name=\"{0}_fixed\" type=\"fixed\">\n    {1}\n    <parent link=\"{2}\"/>\n"
        "    <child link=\"{0}\"/>\n  </joint>\n",
        XmlText(child), Origin(X_PB), XmlText(parent));
  }

  void AddJoint(int joint, const std::string& parent, const std::string& child,
                const Isometry3d& X) {
    const int type = model_.jnt_type[joint];
    if (type == mjJNT_BALL) {
      throw InputError(
          fmt::format("joint '{}' is a ball joint: expected hinges and slides", Joint(joint)));
    }
    if (const auto held = held_.find(joint); held != held_.end()) {
      AddFixed(child, parent, X * Moved(joint, held->second));
      return;
    }
    // MuJoCo before 2.3 ignores a range that is not said to be limited; its files meant it.
    const double zero = model_.qpos0[model_.jnt_qposadr[joint]];
    const mjtNum* range = model_.jnt_range + 2 * joint;
    const bool has_range = range[0] < range[1];
    const auto mimic = mimics_.find(joint);
    urdf_ += fmt::format(
        "  <joint name=\"{}\" type=\"{}\">\n    {}\n    <parent link=\"{}\"/>\n"
        "    <child link=\"{}\"/>\n    <axis xyz=\"{}\"/>\n"
        "    <limit lower=\"{}\" upper=\"{}\" effort=\"{}\" velocity=\"0\"/>\n{}  </joint>\n",
        XmlText(Joint(joint)), type == mjJNT_SLIDE ? "prismatic" : "revolute", Origin(X),
        XmlText(parent), XmlText(child), Numbers(VectorOf(model_.jnt_axis + 3 * joint)),
        has_range ? range[0] - zero : 0, has_range ? range[1] - zero : 0, EffortOf(joint),
        mimic == mimics_.end() ? "" : "    " + mimic->second + "\n");
  }

  /// N m or N that a joint bears; 0: no limit is known.
  double EffortOf(int joint) const {
    const double actuators = ActuatorsEffort(joint);
    const auto own = efforts_.find(Joint(joint));
    if (own == efforts_.end()) return actuators;
    return actuators > 0 ? std::min(actuators, own->second) : own->second;
  }

  /// N m or N that the actuators at a joint give together; 0: no limit is known.
  double ActuatorsEffort(int joint) const {
    const auto largest = [](const mjtNum* range) {
      return std::max(std::abs(range[0]), std::abs(range[1]));
    };
    double effort = 0;
    for (int k = 0; k < model_.nu; ++k) {
      const int transmission = model_.actuator_trntype[k];
      const bool is_at_joint = transmission == mjTRN_JOINT || transmission == mjTRN_JOINTINPARENT;
      if (!is_at_joint || model_.actuator_trnid[2 * k] != joint) continue;
      const double gear = std::abs(model_.actuator_gear[6 * k]);
      double force = largest(model_.actuator_forcerange + 2 * k);
      const bool is_motor =
          model_.actuator_gaintype[k] == mjGAIN_FIXED && model_.actuator_biastype[k] == mjBIAS_NONE;
      if (force == 0 && is_motor) {
        force = std::abs(model_.actuator_gainprm[mjNGAIN * k]) *
                largest(model_.actuator_ctrlrange + 2 * k);
      }
      if (force == 0) return 0;
      effort += gear * force;
    }
    return effort;
  }

  void AddLinkBetween(const std::string& link, int body) {
    const double mass = kLinkBetween * model_.body_mass[body];
    const mjtNum* inertia = model_.body_inertia + 3 * body;
    const double moment = kLinkBetween * std::max({inertia[0], inertia[1], inertia[2]});
    urdf_ += fmt::format(
        "  <link name=\"{}\">\n    <inertial><mass value=\"{}\"/><inertia ixx=\"{}\" ixy=\"0\" "
        "ixz=\"0\" iyy=\"{}\" iyz=\"0\" izz=\"{}\"/></inertial>\n  </link>\n",
        XmlText(link), mass, moment, moment, moment);
    result_.findings.push_back(fmt::format(
        "link '{}' stands between two joints of body '{}', with a millionth of its mass", link,
        Body(body)));
  }

  void AddLink(int body) {
    urdf_ += fmt::format("  <link name=\"{}\">\n", XmlText(Body(body)));
    const Vector3d link = LinkIn(body);
    if (model_.body_mass[body] > 0) {
      Isometry3d X = PoseOf(model_.body_ipos + 3 * body, model_.body_iquat + 4 * body);
      X.pretranslate(-link);
      const mjtNum* inertia = model_.body_inertia + 3 * body;
      urdf_ += fmt::format(
          "    <inertial>{}<mass value=\"{}\"/><inertia ixx=\"{}\" ixy=\"0\" ixz=\"0\" "
          "iyy=\"{}\" iyz=\"0\" izz=\"{}\"/></inertial>\n",
          Origin(X), model_.body_mass[body], inertia[0], inertia[1], inertia[2]);
    }
    for (int k = 0; k < model_.body_geomnum[body]; ++k)
      AddGeom(model_.body_geomadr[body] + k, link);
    urdf_ += "  </link>\n";
  }

  void AddGeom(int geom, const Vector3d& link) {
    const std::string shape = ShapeOf(geom);
    if (shape.empty()) return;
    Isometry3d X = PoseOf(model_.geom_pos + 3 * geom, model_.geom_quat + 4 * geom);
    X.pretranslate(-link);
    const bool collides = model_.geom_contype[geom] != 0 || model_.geom_conaffinity[geom] != 0;
    urdf_ += fmt::format("    <{0}>{1}<geometry>{2}</geometry></{0}>\n",
                         collides ? "collision" : "visual", Origin(X), shape);
  }

  std::string ShapeOf(int geom) {
    const mjtNum* size = model_.geom_size + 3 * geom;
    switch (model_.geom_type[geom]) {
      case mjGEOM_SPHERE:
        return fmt::format("<sphere radius=\"{}\"/>", size[0]);
      case mjGEOM_CAPSULE:
        return fmt::format("<capsule radius=\"{}\" length=\"{}\"/>", size[0], 2 * size[1]);
      case mjGEOM_CYLINDER:
        return fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", size[0], 2 * size[1]);
      case mjGEOM_ELLIPSOID:
        result_.findings.push_back(fmt::format(
            "an ellipsoid of body '{}' becomes the box around it", Body(model_.geom_bodyid[geom])));
        [[fallthrough]];
      case mjGEOM_BOX:
        return fmt::format("<box size=\"{}\"/>", Numbers(2 * VectorOf(size)));
      case mjGEOM_MESH:
        return fmt::format("<mesh filename=\"{}\"/>", MeshFile(model_.geom_dataid[geom]));
      default:
        result_.findings.push_back(fmt::format("{} of body '{}' is left out",
                                               NameOf(mjOBJ_GEOM, geom, "geom"),
                                               Body(model_.geom_bodyid[geom])));
        return "";
    }
  }

  std::string MeshFile(int mesh) {
    std::string file =
        fmt::format("meshes/{}_{}.stl", mesh, SafeFileName(NameOf(mjOBJ_MESH, mesh, "mesh")));
    if (meshes_.insert(mesh).second) {
      result_.files.push_back({file, models::BinaryStl(MeshOf(model_, mesh))});
    }
    return file;
  }

  std::string Srdf() const {
    std::string pairs;
    for (int k = 0; k < model_.nexclude; ++k) {
      const int first = (model_.exclude_signature[k] >> 16) - 1;
      const int second = (model_.exclude_signature[k] & 0xffff) - 1;
      if (!IsPart(first) || !IsPart(second)) continue;
      pairs += fmt::format(
          "  <disable_collisions link1=\"{}\" link2=\"{}\" reason=\"excluded in the MJCF\"/>\n",
          XmlText(Body(first)), XmlText(Body(second)));
    }
    if (pairs.empty()) return "";
    return fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n{}</robot>\n",
                       XmlText(robot_), pairs);
  }

  const mjModel& model_;
  const std::string robot_;
  const std::map<std::string, double>& efforts_;
  int root_ = 0;
  std::map<int, std::string> mimics_;  ///< of a joint, its element
  std::map<int, double> held_;         ///< joints that an equality holds, and where
  std::set<int> meshes_;
  std::string urdf_;
  MjcfRobot result_;
};

}  // namespace

MjcfRobot UrdfOfModel(const mjModel& model, const std::string& robot,
                      const std::map<std::string, double>& efforts) {
  return Converter(model, robot, efforts).Convert();
}

}  // namespace possibility::experiments

#endif
