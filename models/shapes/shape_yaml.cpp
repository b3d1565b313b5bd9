#include "models/shapes/shape_yaml.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <numbers>

#include "models/input/nearest_name.h"

namespace possibility::models {
namespace {

const std::map<std::string, std::vector<std::string>> kDimensions = {
    {"box", {"size"}},
    {"sphere", {"radius"}},
    {"cylinder", {"radius", "length"}},
    {"capsule", {"radius", "length"}},
    {"convex", {"vertices"}},
};

void CheckDimensions(const YamlNode& node, const std::string& type) {
  const std::vector<std::string>& wanted = kDimensions.at(type);
  for (const std::string key : {"size", "radius", "length", "vertices"}) {
    if (node.Find(key) && std::find(wanted.begin(), wanted.end(), key) == wanted.end()) {
      node.At(key).Fail(fmt::format("a {} has no {}", type, key));
    }
  }
}

bool SpansAVolume(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) covariance += (p - mean) * (p - mean).transpose();
  const Eigen::Vector3d spread = covariance.selfadjointView<Eigen::Lower>().eigenvalues();
  return spread.allFinite() && spread[0] > 1e-12 * spread[2];
}

Shape ReadConvex(const YamlNode& node) {
  std::vector<Eigen::Vector3d> vertices;
  for (const YamlNode& vertex : node.Items()) vertices.push_back(vertex.Vector3());
  if (vertices.size() < 4 || !SpansAVolume(vertices)) {
    node.Fail("expected at least four points that do not lie in one plane");
  }
  return Shape::ConvexMesh(std::move(vertices));
}

Shape ReadShape(const YamlNode& node) {
  const std::string type = node.At("shape").String();
  if (!kDimensions.contains(type)) {
    const std::vector<std::string> known = {"box", "sphere", "cylinder", "capsule", "convex"};
    node.At("shape").Fail(fmt::format("expected box, sphere, cylinder, capsule or convex, got {}{}",
                                      type, DidYouMean(type, known)));
  }
  CheckDimensions(node, type);
  if (type == "box") return Shape::Box(node.At("size").PositiveVector3());
  if (type == "sphere") return Shape::Sphere(node.At("radius").Positive());
  if (type == "convex") return ReadConvex(node.At("vertices"));
  const double radius = node.At("radius").Positive();
  const double length = node.At("length").Positive();
  return type == "cylinder" ? Shape::Cylinder(radius, length) : Shape::Capsule(radius, length);
}

}  // namespace

const std::vector<std::string> kShapeKeys = {"shape",    "size",     "radius", "length",
                                             "vertices", "position", "rpy_deg"};

Eigen::Quaterniond FromRollPitchYaw(const Eigen::Vector3d& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX());
}

PosedShape ReadPosedShape(const YamlNode& node) {
  PosedShape posed{ReadShape(node), Eigen::Isometry3d::Identity()};
  // The vertices of a convex shape already place it, so its position is optional.
  if (posed.shape.type != ShapeType::kConvexMesh || node.Find("position")) {
    posed.X_PS.translation() = node.At("position").Vector3();
  }
  if (const auto rpy_deg = node.Find("rpy_deg")) {
    const Eigen::Vector3d rpy = rpy_deg->Vector3() * std::numbers::pi / 180;
    posed.X_PS.linear() = FromRollPitchYaw(rpy).toRotationMatrix();
  }
  return posed;
}

}  // namespace possibility::models
