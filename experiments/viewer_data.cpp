#include "experiments/viewer_data.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "actions/contact_name.h"
#include "experiments/base64.h"
#include "experiments/plan_summary.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little);

/// Linear interpolation over this time, s, cannot be told from the motion itself by eye.
constexpr double kFrame = 0.04;

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

template <typename Number>
std::string Packed(const std::vector<Number>& numbers) {
  static_assert(sizeof(Number) == 4);
  return Base64({reinterpret_cast<const char*>(numbers.data()), 4 * numbers.size()});
}

void Append(const Eigen::Ref<const Eigen::VectorXd>& values, std::vector<float>* numbers) {
  for (const double value : values) numbers->push_back(static_cast<float>(value));
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

Json LinksJson(const models::RobotModel& robot) {
  Json links = Json::array();
  for (const models::Link& link : robot.links) {
    Json shapes = Json::array();
    for (const models::PosedShape& posed : link.shapes) {
      shapes.push_back(ShapeJson(posed.shape));
      shapes.back()["pose"] = PoseJson(posed.X_PS);
    }
    links.push_back({{"name", link.name}, {"shapes", shapes}});
  }
  return links;
}

Json JointsJson(const models::RobotModel& robot) {
  Json joints = Json::array();
  for (const models::Joint& joint : robot.joints) {
    joints.push_back({{"name", joint.name},
                      {"prismatic", joint.type == models::JointType::kPrismatic},
                      {"parent", joint.parent},
                      {"pose", PoseJson(joint.X_PJ)},
                      {"axis", {joint.axis.x(), joint.axis.y(), joint.axis.z()}}});
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
    obstacles.push_back({{"name", obstacle.name},
                         {"shape", ShapeJson(obstacle.shape)},
                         {"pose", PoseJson(obstacle.X_WO)},
                         {"ground", obstacle.is_ground}});
  }
  return obstacles;
}

Json StanceJson(const models::Stance& stance) {
  return {{"x", stance.x}, {"y", stance.y}, {"z", stance.z}, {"yaw", stance.yaw}};
}

/// Knots of all phases behind one another, thinned out to the pace of a video.
class MotionPacker {
 public:
  explicit MotionPacker(const models::RobotModel& robot) : robot_(robot) {}

  Json Add(const actions::Phase& phase) {
    Json contacts = Json::array();
    Json points = Json::array();
    for (const actions::BearingPatch& bearing : actions::BearingPatches(robot_, phase)) {
      contacts.push_back(bearing.patch);
      points.push_back(bearing.points);
    }
    const int first = count_;
    const std::size_t first_force = forces_.size();
    const actions::Knot* kept = nullptr;
    for (const actions::Knot& knot : phase.knots) {
      const bool at_end = &knot == &phase.knots.back();
      if (kept != nullptr && !at_end && knot.t - kept->t < kFrame) continue;
      kept = &knot;
      AddKnot(knot);
    }
    return {{"contacts", contacts},
            {"points", points},
            {"first", first},
            {"count", count_ - first},
            {"forces", first_force}};
  }

  std::string knots() const { return Packed(knots_); }
  std::string forces() const { return Packed(forces_); }

 private:
  void AddKnot(const actions::Knot& knot) {
    knots_.push_back(static_cast<float>(knot.t));
    Append(knot.q, &knots_);
    Append(knot.forces.reshaped(), &forces_);
    ++count_;
  }

  const models::RobotModel& robot_;
  int count_ = 0;
  std::vector<float> knots_;
  std::vector<float> forces_;
};

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

/// Pairs of words, in the order in which they are shown.
Json FactsJson(const actions::Plan& plan, const models::RobotModel& robot,
               const models::Scenario& scenario) {
  Json facts = Json::array();
  const auto add = [&facts](const char* name, const std::string& value) {
    facts.push_back(Json::array({name, value}));
  };
  add("Scenario", scenario.name);
  add("Robot", robot.name);
  if (plan.segments.empty()) return facts;
  add("Duration", fmt::format("{:.1f} s", plan.duration()));
  add("Planned in", fmt::format("{:.2f} s", PlanningSeconds(plan)));
  if (const auto ratio = RealTimeRatio(plan)) {
    add("Real-time ratio", fmt::format("{:.1f}", *ratio));
  }
  add("Explored", fmt::format("{} vertices, {} edges", plan.explored.vertices.size(),
                              plan.explored.edges.size()));
  add("Seed", fmt::format("{}", plan.seed));
  return facts;
}

/// No '<' or '&', so that nothing inside can end the element; text that is not UTF-8 is replaced.
std::string ScriptSafe(const Json& json) {
  std::string safe;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<' || c == '>' || c == '&') {
      safe += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::string ViewerTitle(const models::Scenario& scenario) {
  return scenario.name + " – possibility";
}

std::string ViewerDataJson(const actions::Plan& plan, const models::RobotModel& robot,
                           const models::Scenario& scenario) {
  MotionPacker motion(robot);
  Json segments = Json::array();
  for (const actions::Segment& segment : plan.segments) {
    Json phases = Json::array();
    for (const actions::Phase& phase : segment.phases) phases.push_back(motion.Add(phase));
    segments.push_back({{"action", segment.action}, {"phases", phases}});
  }
  Json goals = Json::array();
  for (const models::Stance& goal : scenario.goals) goals.push_back(StanceJson(goal));
  const Eigen::AlignedBox2d& bounds = scenario.environment.bounds;
  Json json;
  json["title"] = ViewerTitle(scenario);
  json["facts"] = FactsJson(plan, robot, scenario);
  json["links"] = LinksJson(robot);
  json["joints"] = JointsJson(robot);
  json["contacts"] = ContactsJson(robot);
  json["obstacles"] = ObstaclesJson(scenario.environment);
  json["bounds"] = {bounds.min().x(), bounds.min().y(), bounds.max().x(), bounds.max().y()};
  json["start"] = StanceJson(scenario.start);
  json["goals"] = goals;
  json["segments"] = segments;
  json["knots"] = motion.knots();
  json["forces"] = motion.forces();
  json["explored"] = ExploredJson(plan.explored);
  return ScriptSafe(json);
}

}  // namespace possibility::experiments
