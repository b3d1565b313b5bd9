#include "experiments/exports/foxglove_messages.h"

#include <fmt/format.h>

#include <cmath>

#include "experiments/exports/hull_triangles.h"
#include "models/input/json_text.h"
#include "models/robot/rotation_vector.h"

namespace possibility::experiments {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;
using models::ShapeType;

constexpr double kMetresPerNewton = 1e-3;
constexpr double kArrowHead = 0.03;  // m

const Json kGroundPaint = {{"r", 0.75}, {"g", 0.75}, {"b", 0.72}, {"a", 1}};
const Json kObstaclePaint = {{"r", 0.55}, {"g", 0.35}, {"b", 0.25}, {"a", 1}};
const Json kRobotPaint = {{"r", 0.35}, {"g", 0.45}, {"b", 0.6}, {"a", 1}};
const Json kForcePaint = {{"r", 0.9}, {"g", 0.2}, {"b", 0.1}, {"a", 1}};

/// Rounded, so that files stay small; without negative zeros.
double Short(double number, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return std::round(number * scale) / scale + 0.0;
}

Json TimeJson(std::uint64_t time) {
  return {{"sec", time / 1000000000}, {"nsec", time % 1000000000}};
}

Json VectorJson(const Vector3d& vector, int decimals = 6) {
  return {{"x", Short(vector.x(), decimals)},
          {"y", Short(vector.y(), decimals)},
          {"z", Short(vector.z(), decimals)}};
}

Json RotationJson(const Eigen::Quaterniond& rotation) {
  const double sign = rotation.w() < 0 ? -1 : 1;
  return {{"x", Short(sign * rotation.x(), 7)},
          {"y", Short(sign * rotation.y(), 7)},
          {"z", Short(sign * rotation.z(), 7)},
          {"w", Short(sign * rotation.w(), 7)}};
}

Json PoseJson(const Isometry3d& X) {
  return {{"position", VectorJson(X.translation())},
          {"orientation", RotationJson(Eigen::Quaterniond(X.linear()))}};
}

Json EmptyEntity(const std::string& frame, const std::string& id, std::uint64_t time) {
  Json entity = {{"timestamp", TimeJson(time)},
                 {"frame_id", frame},
                 {"id", id},
                 {"lifetime", TimeJson(0)},
                 {"frame_locked", true}};
  for (const char* list : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                           "triangles", "texts", "models"}) {
    entity[list] = Json::array();
  }
  return entity;
}

std::string SceneText(const Json& entities) {
  return models::JsonText(Json{{"deletions", Json::array()}, {"entities", entities}});
}

Json SizedPrimitive(const Isometry3d& X, const Vector3d& size, const Json& color) {
  return {{"pose", PoseJson(X)}, {"color", color}, {"size", VectorJson(size)}};
}

Json CylinderPrimitive(const Isometry3d& X, double radius, double length, const Json& color) {
  Json cylinder = SizedPrimitive(X, {2 * radius, 2 * radius, length}, color);
  cylinder["bottom_scale"] = 1;
  cylinder["top_scale"] = 1;
  return cylinder;
}

template <typename Triangles>
Json TrianglePrimitive(const Isometry3d& X, const std::vector<Vector3d>& points,
                       const Triangles& triangles, const Json& color) {
  Json corners = Json::array();
  for (const Vector3d& point : points) corners.push_back(VectorJson(point));
  Json indices = Json::array();
  for (const auto& triangle : triangles) {
    for (const int corner : triangle) indices.push_back(corner);
  }
  return {{"pose", PoseJson(X)},
          {"color", color},
          {"points", corners},
          {"colors", Json::array()},
          {"indices", indices}};
}

void AddShape(const models::Shape& shape, const Isometry3d& X, const Json& color, Json* entity) {
  const Vector3d ball = Vector3d::Constant(2 * shape.radius);
  switch (shape.type) {
    case ShapeType::kBox:
      (*entity)["cubes"].push_back(SizedPrimitive(X, shape.size, color));
      break;
    case ShapeType::kSphere:
      (*entity)["spheres"].push_back(SizedPrimitive(X, ball, color));
      break;
    case ShapeType::kCylinder:
      (*entity)["cylinders"].push_back(CylinderPrimitive(X, shape.radius, shape.length, color));
      break;
    case ShapeType::kCapsule:
      (*entity)["cylinders"].push_back(CylinderPrimitive(X, shape.radius, shape.length, color));
      for (const double end : {-0.5, 0.5}) {
        Isometry3d X_end = X;
        X_end.translate(Vector3d(0, 0, end * shape.length));
        (*entity)["spheres"].push_back(SizedPrimitive(X_end, ball, color));
      }
      break;
    case ShapeType::kConvexMesh:
      (*entity)["triangles"].push_back(
          TrianglePrimitive(X, shape.vertices, HullTriangles(shape.vertices), color));
      break;
  }
}

}  // namespace

std::string WorldScene(const models::Environment& environment, std::uint64_t time) {
  Json entities = Json::array();
  for (const models::Obstacle& obstacle : environment.obstacles) {
    if (obstacle.surface >= 0) continue;  // shown as the whole surface
    Json entity = EmptyEntity("world", obstacle.name, time);
    AddShape(obstacle.shape, obstacle.X_WO, obstacle.is_ground ? kGroundPaint : kObstaclePaint,
             &entity);
    entities.push_back(entity);
  }
  for (const models::Surface& surface : environment.surfaces) {
    Json entity = EmptyEntity("world", surface.name, time);
    entity["triangles"].push_back(
        TrianglePrimitive(Isometry3d::Identity(), surface.mesh.vertices, surface.mesh.triangles,
                          surface.is_ground ? kGroundPaint : kObstaclePaint));
    entities.push_back(entity);
  }
  return SceneText(entities);
}

std::string RobotScene(const models::RobotModel& robot, std::uint64_t time) {
  Json entities = Json::array();
  for (const models::Link& link : robot.links) {
    if (link.shapes.empty()) continue;
    Json entity = EmptyEntity(link.name, "robot/" + link.name, time);
    for (const models::PosedShape& posed : link.shapes) {
      AddShape(posed.shape, posed.X_PS, kRobotPaint, &entity);
    }
    entities.push_back(entity);
  }
  return SceneText(entities);
}

std::string LinkTransforms(const models::RobotModel& robot, const std::vector<Isometry3d>& X_WL,
                           std::uint64_t time) {
  Json transforms = Json::array();
  for (int link = 0; link < robot.num_links(); ++link) {
    const int parent = link == 0 ? -1 : robot.joints[link - 1].parent;
    const Isometry3d X_PL = parent < 0 ? X_WL[link] : X_WL[parent].inverse() * X_WL[link];
    transforms.push_back({{"timestamp", TimeJson(time)},
                          {"parent_frame_id", parent < 0 ? "world" : robot.links[parent].name},
                          {"child_frame_id", robot.links[link].name},
                          {"translation", VectorJson(X_PL.translation())},
                          {"rotation", RotationJson(Eigen::Quaterniond(X_PL.linear()))}});
  }
  return models::JsonText(Json{{"transforms", transforms}});
}

std::string JointStates(const models::RobotModel& robot, const actions::Knot& knot,
                        std::uint64_t time) {
  Json joints = Json::array();
  for (int j = 0; j < robot.num_joints(); ++j) {
    joints.push_back({{"name", robot.joints[j].name},
                      {"position", Short(knot.q[7 + j], 6)},
                      {"velocity", Short(knot.v[6 + j], 5)},
                      {"effort", Short(knot.tau[j], 3)}});
  }
  return models::JsonText(Json{{"timestamp", TimeJson(time)}, {"joints", joints}});
}

std::string ForceArrows(const std::vector<PointForce>& forces, std::uint64_t time) {
  Json entity = EmptyEntity("world", "contact_forces", time);
  for (const PointForce& point : forces) {
    const double length = kMetresPerNewton * point.force.norm();
    if (!point.bears || length == 0) continue;
    Isometry3d X = Isometry3d::Identity();
    X.translation() = point.position;
    X.linear() = models::SmallestRotation(Vector3d::UnitX(), point.force).matrix();
    entity["arrows"].push_back({{"pose", PoseJson(X)},
                                {"color", kForcePaint},
                                {"shaft_length", Short(length, 4)},
                                {"shaft_diameter", 0.01},
                                {"head_length", kArrowHead},
                                {"head_diameter", 0.02}});
  }
  return SceneText(Json::array({entity}));
}

std::string ContactForces(const std::vector<PointForce>& forces, std::uint64_t time) {
  Json points = Json::array();
  for (const PointForce& point : forces) {
    points.push_back(
        {{"name", point.name}, {"bears", point.bears}, {"force", VectorJson(point.force, 3)}});
  }
  return models::JsonText(Json{{"timestamp", TimeJson(time)}, {"points", points}});
}

}  // namespace possibility::experiments
