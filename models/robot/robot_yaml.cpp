#include "models/robot/robot_yaml.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/input/named_lookup.h"
#include "models/input/yaml_reader.h"
#include "models/robot/actuator_yaml.h"
#include "models/robot/gait_yaml.h"
#include "models/robot/inertial_yaml.h"
#include "models/robot/mesh_shapes.h"
#include "models/robot/shape_reach.h"
#include "models/robot/urdf_reader.h"
#include "models/robot/urdf_robot.h"
#include "models/shapes/shape_yaml.h"

namespace possibility::models {
namespace {

std::set<std::string> ReadLumped(const YamlNode& root, const UrdfTree& tree) {
  std::set<std::string> lumped;
  const auto list = root.Find("lump");
  if (!list) return lumped;
  for (const int joint : IndicesOfNamed(*list, tree.joints, "joint")) {
    lumped.insert(tree.joints[joint].name);
  }
  return lumped;
}

void ReadRootLink(const YamlNode& node, const UrdfTree& tree) {
  if (node.String() == tree.root) return;
  node.Fail(fmt::format("expected the root of the URDF, '{}', got {}", tree.root, node.String()));
}

/// Calls `set` with each joint of a list of limits and its limit.
void ReadLimits(const YamlNode& list, const RobotModel& robot,
                const std::function<void(int, double, const YamlNode&)>& set) {
  std::set<int> seen;
  for (const YamlNode& node : list.Items()) {
    node.MapOf({"joints", "limit", "reason"});
    node.At("reason").String();
    const double limit = node.At("limit").Positive();
    for (const int joint : IndicesOfNamed(node.At("joints"), robot.joints, "joint")) {
      if (!seen.insert(joint).second) {
        node.At("joints").Fail(fmt::format("joint '{}' is listed twice", robot.joints[joint].name));
      }
      set(joint, limit, node.At("joints"));
    }
  }
}

void ReadEfforts(const YamlNode& list, RobotModel* robot) {
  ReadLimits(list, *robot, [robot](int joint, double limit, const YamlNode& node) {
    if (const auto& mimic = robot->joints[joint].mimic) {
      node.Fail(fmt::format("joint '{}' mimics '{}', whose limit counts for both",
                            robot->joints[joint].name, robot->joints[mimic->joint].name));
    }
    robot->joints[joint].effort = limit;
  });
}

void ReadSpeeds(const YamlNode& list, RobotModel* robot) {
  ReadLimits(list, *robot, [robot](int joint, double limit, const YamlNode&) {
    robot->joints[joint].velocity = limit;
  });
}

void ReadPositions(const YamlNode& list, RobotModel* robot) {
  std::set<int> seen;
  for (const YamlNode& node : list.Items()) {
    node.MapOf({"joints", "limits_deg", "reason"});
    node.At("reason").String();
    const Eigen::Vector2d limits = node.At("limits_deg").Interval() * std::numbers::pi / 180;
    for (const int joint : IndicesOfNamed(node.At("joints"), robot->joints, "joint")) {
      Joint& changed = robot->joints[joint];
      if (!seen.insert(joint).second) {
        node.At("joints").Fail(fmt::format("joint '{}' is listed twice", changed.name));
      }
      if (changed.type != JointType::kRevolute) {
        node.At("joints").Fail(fmt::format("joint '{}' is not revolute", changed.name));
      }
      changed.lower = limits[0];
      changed.upper = limits[1];
    }
  }
}

/// Numbers larger than those of any robot would overflow when squared.
void CheckMagnitudes(const std::filesystem::path& urdf_file, const RobotModel& robot) {
  for (const Joint& joint : robot.joints) {
    for (const double value : {joint.lower, joint.upper, joint.velocity, joint.effort}) {
      // Continuous joints and mimics have infinite limits.
      if (std::isinf(value) || std::abs(value) <= 1e6) continue;
      throw InputError(
          fmt::format("{}: joint '{}': limit: expected numbers of at most 1e6 in magnitude, got {}",
                      urdf_file.string(), joint.name, value));
    }
  }
}

void CheckPositions(const std::filesystem::path& urdf_file, const RobotModel& robot) {
  for (const Joint& joint : robot.joints) {
    if (joint.lower < joint.upper) continue;
    throw InputError(fmt::format("{}: joint '{}': expected lower < upper, got {} and {}",
                                 urdf_file.string(), joint.name, joint.lower, joint.upper));
  }
}

void CheckSpeeds(const std::filesystem::path& urdf_file, const RobotModel& robot) {
  for (const Joint& joint : robot.joints) {
    if (joint.velocity > 0) continue;
    throw InputError(fmt::format("{}: joint '{}': expected a positive velocity limit, got {}",
                                 urdf_file.string(), joint.name, joint.velocity));
  }
}

void CheckEfforts(const YamlNode& root, const RobotModel& robot) {
  for (const Joint& joint : robot.joints) {
    if (joint.effort > 0) continue;
    root.Fail(
        fmt::format("joint '{}' has no effort limit: expected a positive one in the URDF or "
                    "under 'effort'",
                    joint.name));
  }
}

void ReadShapes(const YamlNode& map, RobotModel* robot, PendingMeshes* meshes) {
  std::vector<std::string> names;
  for (const Link& link : robot->links) names.push_back(link.name);
  map.MapOf(names);
  for (const auto& [name, list] : map.Entries()) {
    const int link = robot->LinkIndex(name);
    std::vector<PosedShape>& shapes = robot->links[link].shapes;
    shapes.clear();
    meshes->erase(link);
    for (const YamlNode& node : list.Items()) {
      shapes.push_back(ReadPosedShape(node.MapOf(kShapeKeys)));
    }
  }
}

ContactPatch ReadContact(const YamlNode& node, const RobotModel& robot) {
  node.MapOf({"name", "link", "points", "normal"});
  ContactPatch contact;
  contact.name = node.At("name").String();
  contact.link = IndexOfNamed(node.At("link"), robot.links, "link");
  for (const YamlNode& point : node.At("points").Items()) {
    contact.points.push_back(point.Vector3());
  }
  if (contact.points.empty()) node.At("points").FailExpected("at least one point");
  const Eigen::Vector3d normal = node.At("normal").Vector3();
  if (!(normal.norm() > 1e-6)) node.At("normal").Fail("expected a direction, got a zero vector");
  contact.normal_L = normal.normalized();
  return contact;
}

std::vector<ContactPatch> ReadContacts(const YamlNode& list, const RobotModel& robot) {
  std::vector<ContactPatch> contacts;
  for (const YamlNode& node : list.Items()) {
    ContactPatch contact = ReadContact(node, robot);
    for (const ContactPatch& other : contacts) {
      if (other.name == contact.name) node.At("name").Fail("this name is already taken");
    }
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

/// A list of pairs of names, none paired with itself.
template <typename Named>
std::vector<std::pair<int, int>> ReadPairs(const YamlNode& list, const std::vector<Named>& items,
                                           const std::string& kind) {
  std::vector<std::pair<int, int>> pairs;
  for (const YamlNode& node : list.Items()) {
    const std::vector<int> pair = IndicesOfNamed(node, items, kind);
    if (pair.size() != 2) node.FailExpected(fmt::format("a pair of {}s", kind));
    pairs.emplace_back(pair[0], pair[1]);
  }
  return pairs;
}

std::vector<std::pair<int, int>> ReadSagittalPairs(const YamlNode& list, const RobotModel& robot) {
  const auto pairs = ReadPairs(list, robot.joints, "joint");
  std::set<int> seen;
  const std::vector<YamlNode> nodes = list.Items();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const int joint : {pairs[i].first, pairs[i].second}) {
      if (seen.insert(joint).second) continue;
      nodes[i].Fail(fmt::format("joint '{}' is in two pairs", robot.joints[joint].name));
    }
    if (robot.joints[pairs[i].first].type != robot.joints[pairs[i].second].type) {
      nodes[i].Fail("expected two joints of one type");
    }
  }
  return pairs;
}

const std::vector<std::string> kRobotKeys = {
    "name",        "urdf",      "root_link",      "pelvis_link",       "lump",
    "packages",    "friction",  "position",       "velocity",          "effort",
    "inertials",   "actuators", "shapes",         "contacts",          "gaits",
    "transitions", "jumps",     "sagittal_pairs", "ignored_collisions"};

/// Folders of packages, relative to the YAML.
std::vector<std::filesystem::path> ReadPackages(const YamlNode& root,
                                                const std::filesystem::path& yaml_file) {
  std::vector<std::filesystem::path> folders;
  const auto list = root.Find("packages");
  if (!list) return folders;
  for (const YamlNode& node : list->Items()) {
    folders.push_back(yaml_file.parent_path() / node.String());
    std::error_code error;
    if (!std::filesystem::is_directory(folders.back(), error)) node.FailExpected("a folder");
  }
  return folders;
}

/// Friction, limits and the shapes that replace the URDF's.
void ReadPhysics(const YamlNode& root, const std::filesystem::path& urdf_file, UrdfRobot* built) {
  RobotModel* robot = &built->robot;
  robot->pelvis_shape_link = IndexOfNamed(root.At("pelvis_link"), robot->links, "link");
  robot->friction = root.At("friction").Positive();
  if (const auto positions = root.Find("position")) ReadPositions(*positions, robot);
  CheckPositions(urdf_file, *robot);
  if (const auto speeds = root.Find("velocity")) ReadSpeeds(*speeds, robot);
  CheckSpeeds(urdf_file, *robot);
  if (const auto efforts = root.Find("effort")) ReadEfforts(*efforts, robot);
  CheckMagnitudes(urdf_file, *robot);
  CheckEfforts(root, *robot);
  if (const auto actuators = root.Find("actuators")) ReadActuators(*actuators, robot);
  if (const auto shapes = root.Find("shapes")) ReadShapes(*shapes, robot, &built->meshes);
}

/// Reads everything but the tree, limits and shapes.
void ReadDescription(const YamlNode& root, RobotModel* robot) {
  if (robot->links[robot->pelvis_shape_link].shapes.empty()) {
    root.At("pelvis_link").Fail("this link has no collision shape");
  }
  robot->contacts = ReadContacts(root.At("contacts"), *robot);
  if (const auto pairs = root.Find("sagittal_pairs")) {
    robot->sagittal_pairs = ReadSagittalPairs(*pairs, *robot);
  }
  if (const auto pairs = root.Find("ignored_collisions")) {
    robot->ignored_collisions = ReadPairs(*pairs, robot->links, "link");
  }
  robot->gaits = ReadGaits(root.At("gaits"), *robot);
  if (const auto transitions = root.Find("transitions")) {
    robot->transitions = ReadTransitions(*transitions, *robot);
  }
  if (const auto jumps = root.Find("jumps")) robot->jumps = ReadJumps(*jumps, *robot);
}

/// The file that the YAML names. @throws InputError unless there is one.
std::filesystem::path UrdfFile(const YamlNode& root, const std::filesystem::path& yaml_file) {
  const YamlNode urdf = root.At("urdf");
  const std::filesystem::path file = yaml_file.parent_path() / urdf.String();
  if (std::error_code error; !std::filesystem::is_regular_file(file, error)) {
    urdf.Fail(fmt::format("no such file: {}", file.string()));
  }
  return file;
}

/// Links and joints of the URDF, with what the YAML changes of them.
UrdfRobot BuildTree(const YamlNode& root, const std::filesystem::path& urdf_file,
                    const std::string& urdf, UrdfGeometry geometry) {
  UrdfTree tree = ParseUrdf(urdf, urdf_file, geometry);
  if (const auto inertials = root.Find("inertials")) ReadInertials(*inertials, &tree);
  ReadRootLink(root.At("root_link"), tree);
  return BuildUrdfRobot(tree, ReadLumped(root, tree), urdf_file);
}

}  // namespace

RobotVisuals LoadRobotVisuals(const std::filesystem::path& yaml_file) {
  const YamlNode root = YamlNode::Parse(ReadFileContents(yaml_file), yaml_file);
  RobotVisuals visuals;
  visuals.urdf_file = UrdfFile(root, yaml_file);
  const std::string urdf = ReadFileContents(visuals.urdf_file);
  if (urdf.find("<visual") == std::string::npos) return visuals;
  UrdfRobot built = BuildTree(root, visuals.urdf_file, urdf, UrdfGeometry::kVisual);
  visuals.links = std::move(built.robot.links);
  visuals.meshes = std::move(built.meshes);
  visuals.packages = ReadPackages(root, yaml_file);
  return visuals;
}

std::string RobotContentHash(const std::filesystem::path& yaml_file) {
  const std::string yaml = ReadFileContents(yaml_file);
  const YamlNode root = YamlNode::Parse(yaml, yaml_file);
  const std::string urdf = ReadFileContents(UrdfFile(root, yaml_file));
  // Which meshes count, if any, only reading the robot tells.
  if (urdf.find("<mesh") != std::string::npos) return LoadRobotModel(yaml_file).content_hash;
  return HashOfParts({yaml, urdf});
}

RobotModel LoadRobotModel(const std::filesystem::path& yaml_file) {
  const std::string yaml = ReadFileContents(yaml_file);
  const YamlNode root = YamlNode::Parse(yaml, yaml_file);
  root.MapOf(kRobotKeys);
  const std::string name = root.At("name").String();
  const std::filesystem::path urdf_file = UrdfFile(root, yaml_file);
  const std::string urdf = ReadFileContents(urdf_file);
  UrdfRobot built = BuildTree(root, urdf_file, urdf, UrdfGeometry::kCollision);
  RobotModel& robot = built.robot;
  robot.name = name;
  robot.file = yaml_file;
  ReadPhysics(root, urdf_file, &built);
  const MeshFiles meshes =
      AddMeshShapes(built.meshes, urdf_file, ReadPackages(root, yaml_file), &robot);
  RequireShapesInReach(yaml_file, robot);
  std::vector<std::string_view> parts = {yaml, urdf};
  parts.insert(parts.end(), meshes.contents.begin(), meshes.contents.end());
  robot.content_hash = HashOfParts(parts);
  ReadDescription(root, &robot);
  return std::move(robot);
}

}  // namespace possibility::models
