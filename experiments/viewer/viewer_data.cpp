#include "experiments/viewer/viewer_data.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/report/action_colors.h"
#include "experiments/report/cost_of_transport.h"
#include "experiments/report/plan_speeds.h"
#include "experiments/report/plan_summary.h"
#include "experiments/viewer/robot_look.h"
#include "experiments/viewer/viewer_motion.h"
#include "experiments/viewer/viewer_packing.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

double Rounded(double value) { return std::round(1e5 * value) / 1e5; }

Json Numbers(const Eigen::VectorXd& values) {
  Json json = Json::array();
  for (const double value : values) json.push_back(Rounded(value));
  return json;
}

Json PoseJson(const Eigen::Isometry3d& X) {
  const Eigen::Quaterniond r(X.linear());
  Json json = {r.w(), r.x(), r.y(), r.z()};
  for (const double p : X.translation()) json.push_back(Rounded(p));
  return json;
}

Json ShapeJson(const models::Shape& shape) {
  switch (shape.type) {
    case models::ShapeType::kBox:
      return {{"type", "box"}, {"size", Numbers(shape.size)}};
    case models::ShapeType::kSphere:
      return {{"type", "sphere"}, {"radius", shape.radius}};
    case models::ShapeType::kCylinder:
      return {{"type", "cylinder"}, {"radius", shape.radius}, {"length", shape.length}};
    case models::ShapeType::kCapsule:
      return {{"type", "capsule"}, {"radius", shape.radius}, {"length", shape.length}};
    case models::ShapeType::kConvexMesh:
      break;
  }
  Json vertices = Json::array();
  for (const Eigen::Vector3d& vertex : shape.vertices) vertices.push_back(Numbers(vertex));
  return {{"type", "convex"}, {"vertices", vertices}};
}

Json ShapesJson(const std::vector<models::PosedShape>& shapes) {
  Json json = Json::array();
  for (const models::PosedShape& posed : shapes) {
    json.push_back(ShapeJson(posed.shape));
    json.back()["pose"] = PoseJson(posed.X_PS);
  }
  return json;
}

Json LinksJson(const models::RobotModel& robot) {
  Json links = Json::array();
  for (const models::Link& link : robot.links) {
    links.push_back({{"name", link.name}, {"shapes", ShapesJson(link.shapes)}});
  }
  return links;
}

Json MeshJson(const models::TriangleMesh& mesh) {
  std::vector<float> vertices;
  for (const Eigen::Vector3d& vertex : mesh.vertices) Append(vertex, &vertices);
  std::vector<std::int32_t> triangles;
  for (const auto& triangle : mesh.triangles) {
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  }
  return {{"vertices", Packed(vertices)}, {"triangles", Packed(triangles)}};
}

/// Adds what is seen of each link to its JSON, where that is known.
void AddLooks(const RobotLook& look, Json* links) {
  for (std::size_t i = 0; i < look.links.size(); ++i) {
    Json parts = ShapesJson(look.links[i].shapes);
    for (const PosedMesh& posed : look.links[i].meshes) {
      parts.push_back({{"type", "mesh"}, {"mesh", posed.mesh}, {"pose", PoseJson(posed.X_LM)}});
    }
    if (!parts.empty()) (*links)[i]["look"] = parts;
  }
}

Json MeshesJson(const RobotLook& look) {
  Json meshes = Json::array();
  for (const models::TriangleMesh& mesh : look.meshes) meshes.push_back(MeshJson(mesh));
  return meshes;
}

/// What the page says of meshes that are not drawn.
std::string FaultText(const std::vector<std::string>& faults) {
  if (faults.size() == 1) return faults.front();
  return fmt::format("{} (and {} more)", faults.front(), faults.size() - 1);
}

/// Null for a limit that is absent or zero.
Json LimitJson(double limit) {
  return std::isfinite(limit) && limit > 0 ? Json(Rounded(limit)) : Json();
}

Json RangeJson(const models::Joint& joint) {
  if (!std::isfinite(joint.lower) || !std::isfinite(joint.upper)) return {};
  return joint.lower < joint.upper ? Json{Rounded(joint.lower), Rounded(joint.upper)} : Json();
}

/// Null: the joint's limit holds at every speed.
Json LineJson(const models::Actuator& actuator) {
  if (!actuator.line) return {};
  return {{"stall_torque", Rounded(actuator.line->stall_torque)},
          {"no_load_speed", Rounded(actuator.line->no_load_speed)}};
}

Json JointsJson(const models::RobotModel& robot) {
  Json joints = Json::array();
  for (const models::Joint& joint : robot.joints) {
    joints.push_back({{"name", joint.name},
                      {"prismatic", joint.type == models::JointType::kPrismatic},
                      {"parent", joint.parent},
                      {"pose", PoseJson(joint.X_PJ)},
                      {"axis", {joint.axis.x(), joint.axis.y(), joint.axis.z()}},
                      {"range", RangeJson(joint)},
                      {"speed", LimitJson(joint.velocity)},
                      {"effort", LimitJson(joint.effort)},
                      {"line", LineJson(joint.actuator)}});
  }
  return joints;
}

Json ContactsJson(const models::RobotModel& robot) {
  Json contacts = Json::array();
  for (const models::ContactPatch& patch : robot.contacts) {
    Json points = Json::array();
    for (const Eigen::Vector3d& point : patch.points) points.push_back(Numbers(point));
    contacts.push_back({{"name", patch.name}, {"link", patch.link}, {"points", points}});
  }
  return contacts;
}

Json ObstaclesJson(const models::Environment& environment) {
  Json obstacles = Json::array();
  for (const models::Obstacle& obstacle : environment.obstacles) {
    if (obstacle.surface >= 0) continue;
    obstacles.push_back({{"name", obstacle.name},
                         {"shape", ShapeJson(obstacle.shape)},
                         {"pose", PoseJson(obstacle.X_WO)},
                         {"ground", obstacle.is_ground}});
  }
  return obstacles;
}

/// Meshes and height maps, each once and whole, not in the pieces that are obstacles.
Json SurfacesJson(const models::Environment& environment) {
  Json surfaces = Json::array();
  for (const models::Surface& surface : environment.surfaces) {
    surfaces.push_back(MeshJson(surface.mesh));
    surfaces.back()["name"] = surface.name;
    surfaces.back()["ground"] = surface.is_ground;
  }
  return surfaces;
}

Json StanceJson(const models::Stance& stance) {
  return {{"x", stance.x}, {"y", stance.y}, {"z", stance.z}, {"yaw", stance.yaw}};
}

Json ExploredJson(const actions::ExploredGraph& explored) {
  std::vector<float> vertices;
  for (const auto& vertex : explored.vertices) Append(vertex.position, &vertices);
  std::vector<std::string> names;
  std::vector<std::int32_t> edges;
  for (const auto& edge : explored.edges) {
    const auto known = std::find(names.begin(), names.end(), edge.action);
    const auto index = static_cast<std::int32_t>(known - names.begin());
    if (known == names.end()) names.push_back(edge.action);
    edges.insert(edges.end(), {edge.from, edge.to, index});
  }
  return {{"vertices", Packed(vertices)}, {"edges", Packed(edges)}, {"actions", names}};
}

Json PassageJson(const actions::NarrowPassage& passage) {
  Json needs = Json::array();
  for (const actions::PassageNeed& need : passage.needs) {
    needs.push_back({{"available", Rounded(need.available)}, {"needed", Rounded(need.needed)}});
  }
  return {{"place", Numbers(passage.place)}, {"needs", needs}};
}

Json NoJson(const actions::NoPlan& no) {
  Json json = {{"status", no.status}, {"explanation", no.explanation}, {"barrier", Json()}};
  json["passage"] = no.passage ? PassageJson(*no.passage) : Json();
  if (!no.barrier) return json;
  Json reached = Json::array();
  for (const actions::ReachedRegion& region : no.barrier->reached) {
    Json outlines = Json::array();
    for (const std::vector<Eigen::Vector2d>& outline : region.outlines) {
      Json corners = Json::array();
      for (const Eigen::Vector2d& corner : outline) corners.push_back(Numbers(corner));
      outlines.push_back(corners);
    }
    reached.push_back(
        {{"action", region.action}, {"z", Rounded(region.z)}, {"outlines", outlines}});
  }
  json["barrier"] = {{"closest", Numbers(no.barrier->closest)},
                     {"distance", Rounded(no.barrier->distance)},
                     {"closed_by", no.barrier->closed_by},
                     {"reached", reached}};
  return json;
}

/// By the name of every action that the page shows.
Json ActionColorsJson(const actions::Plan& plan) {
  Json colors = Json::object();
  const auto add = [&colors](const std::string& action) { colors[action] = ActionColor(action); };
  for (const actions::Segment& segment : plan.segments) add(segment.action);
  for (const auto& edge : plan.explored.edges) add(edge.action);
  if (plan.no && plan.no->barrier) {
    for (const actions::ReachedRegion& region : plan.no->barrier->reached) add(region.action);
  }
  return colors;
}

/// No '<' or '&', so that nothing inside can end the element; text that is not UTF-8 is replaced.
std::string ScriptSafe(const Json& json) {
  std::string safe;
  for (const char c : models::AsciiJsonText(json)) {
    if (c == '<' || c == '>' || c == '&') {
      safe += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

PageHeading HeadingOf(const actions::Plan& plan, const models::RobotModel& robot,
                      const models::Scenario& scenario) {
  PageHeading heading;
  heading.title = scenario.name + " – possibility";
  const auto add = [&heading](const char* name, const std::string& value) {
    heading.facts.emplace_back(name, value);
  };
  add("Scenario", scenario.name);
  add("Robot", robot.name);
  if (plan.no) {
    add("Answer", fmt::format("no plan ({})", plan.no->status));
    if (const double seconds = PlanningSeconds(plan); seconds > 0) {
      add("Answered in", fmt::format("{:.2f} s", seconds));
    }
  }
  if (plan.segments.empty()) return heading;
  add("Duration", fmt::format("{:.1f} s", plan.duration()));
  add("Path length", fmt::format("{:.2f} m", PlanarLength(plan)));
  if (const auto cost = CostOfTransport(robot, plan)) {
    add("Cost of transport", fmt::format("{:.2f}", *cost));
  }
  add("Planned in", fmt::format("{:.2f} s", PlanningSeconds(plan)));
  if (const auto ratio = RealTimeRatio(plan)) {
    add("Real-time ratio", fmt::format("{:.1f}", *ratio));
  }
  add("Explored", fmt::format("{} vertices, {} edges", plan.explored.vertices.size(),
                              plan.explored.edges.size()));
  add("Seed", fmt::format("{}", plan.seed));
  return heading;
}

std::string ViewerDataJson(const actions::Plan& plan, const models::RobotModel& robot,
                           const models::Scenario& scenario, const PageHeading& heading) {
  MotionPacker motion(robot, scenario.environment);
  Json segments = Json::array();
  for (const actions::Segment& segment : plan.segments) segments.push_back(motion.Add(segment));
  Json goals = Json::array();
  for (const models::Stance& goal : scenario.goals) goals.push_back(StanceJson(goal));
  const Eigen::AlignedBox2d& bounds = scenario.environment.bounds;
  const RobotLook look = LookOf(robot);
  Json links = LinksJson(robot);
  AddLooks(look, &links);
  Json json;
  json["title"] = heading.title;
  json["facts"] = heading.facts;
  if (!look.faults.empty()) json["facts"].push_back({"Not drawn", FaultText(look.faults)});
  json["plots_first"] = heading.plots_first;
  json["gravity"] = dynamics::kGravity;
  json["weight"] = dynamics::kGravity * robot.TotalMass();
  json["friction"] = robot.friction;
  json["links"] = links;
  json["meshes"] = MeshesJson(look);
  json["joints"] = JointsJson(robot);
  json["pairs"] = robot.sagittal_pairs;
  json["contacts"] = ContactsJson(robot);
  json["obstacles"] = ObstaclesJson(scenario.environment);
  json["surfaces"] = SurfacesJson(scenario.environment);
  json["bounds"] = {bounds.min().x(), bounds.min().y(), bounds.max().x(), bounds.max().y()};
  json["start"] = StanceJson(scenario.start);
  json["goals"] = goals;
  json["segments"] = segments;
  json["action_colors"] = ActionColorsJson(plan);
  motion.WriteTo(&json);
  json["explored"] = ExploredJson(plan.explored);
  json["no"] = plan.no ? NoJson(*plan.no) : Json();
  return ScriptSafe(json);
}

}  // namespace possibility::experiments
