#include "experiments/exports/mujoco_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/exports/mujoco_tree.h"
#include "experiments/samples/quantities.h"
#include "models/input/atomic_file.h"

namespace possibility::experiments {
namespace {

using Eigen::Isometry3d;
using models::Shape;
using models::ShapeType;

constexpr double kKeyframePeriod = 0.02;  // s
constexpr const char* kGroundColor = "0.75 0.75 0.72 1";
constexpr const char* kObstacleColor = "0.55 0.35 0.25 1";
constexpr const char* kRobotColor = "0.35 0.45 0.6 1";

template <typename Vector>
std::string Words(const Vector& numbers) {
  return fmt::format("{}", fmt::join(numbers.begin(), numbers.end(), " "));
}

std::string QuaternionWords(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);
  return fmt::format("{} {} {} {}", q.w(), q.x(), q.y(), q.z());
}

/// Elements of an XML text, closed when they go out of scope.
class Element {
 public:
  Element(tinyxml2::XMLPrinter* printer, const char* name) : printer_(printer) {
    printer_->OpenElement(name);
  }
  ~Element() { printer_->CloseElement(); }
  Element(const Element&) = delete;
  Element& operator=(const Element&) = delete;

  Element& Set(const char* name, const std::string& value) {
    printer_->PushAttribute(name, value.c_str());
    return *this;
  }
  Element& Set(const char* name, double value) { return Set(name, fmt::format("{}", value)); }
  Element& SetPose(const Isometry3d& X) {
    return Set("pos", Words(X.translation())).Set("quat", QuaternionWords(X.linear()));
  }

 private:
  tinyxml2::XMLPrinter* printer_;
};

class MujocoWriter {
 public:
  explicit MujocoWriter(const ExportSubject& subject)
      : subject_(subject), robot_(subject.robot), tree_(subject.robot) {}

  std::string Text(const ExportSampling& sampling) {
    {
      Element root(&printer_, "mujoco");
      root.Set("model", robot_.name);
      WriteSettings();
      WriteMeshes();
      WriteWorld();
      WriteExclusions();
      WriteCouplings();
      WriteMotors();
      WriteKeyframes(sampling);
    }
    return printer_.CStr();
  }

 private:
  void WriteSettings() {
    Element(&printer_, "compiler").Set("angle", "radian").Set("inertiafromgeom", "false");
    Element(&printer_, "option").Set("gravity", fmt::format("0 0 {}", -dynamics::kGravity));
    // More than versions before 3 reserve by themselves.
    Element(&printer_, "size").Set("nconmax", 1000).Set("njmax", 5000);
    const Element defaults(&printer_, "default");
    // Of two geometries in contact MuJoCo takes the greater friction.
    Element(&printer_, "geom").Set("friction", fmt::format("{} 0.005 0.0001", robot_.friction));
  }

  /// Convex shapes are meshes; MuJoCo takes their convex hull.
  void WriteMeshes() {
    const Element assets(&printer_, "asset");
    const auto& obstacles = subject_.scenario.environment.obstacles;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      WriteMesh(fmt::format("world_{}", i), obstacles[i].shape);
    }
    for (int link = 0; link < robot_.num_links(); ++link) {
      const auto& shapes = robot_.links[link].shapes;
      for (std::size_t i = 0; i < shapes.size(); ++i) {
        WriteMesh(fmt::format("link_{}_{}", link, i), shapes[i].shape);
      }
    }
  }

  void WriteMesh(const std::string& name, const Shape& shape) {
    if (shape.type != ShapeType::kConvexMesh) return;
    std::string words;
    for (const Eigen::Vector3d& vertex : shape.vertices) words += Words(vertex) + " ";
    Element(&printer_, "mesh").Set("name", name).Set("vertex", words);
  }

  void WriteWorld() {
    const Element world(&printer_, "worldbody");
    Element(&printer_, "light")
        .Set("pos", "0 0 10")
        .Set("dir", "0 0 -1")
        .Set("directional", "true");
    const auto& obstacles = subject_.scenario.environment.obstacles;
    for (std::size_t i = 0; i < obstacles.size(); ++i) {
      Element geom(&printer_, "geom");
      // Names of pieces of one surface are the same, MuJoCo's must differ.
      geom.Set("name", fmt::format("{}:{}", i, obstacles[i].name));
      SetShape(obstacles[i].shape, obstacles[i].X_WO, fmt::format("world_{}", i), &geom);
      geom.Set("rgba", obstacles[i].is_ground ? kGroundColor : kObstacleColor);
    }
    WriteLink(0);
  }

  void SetShape(const Shape& shape, const Isometry3d& X, const std::string& mesh, Element* geom) {
    switch (shape.type) {
      case ShapeType::kBox:
        geom->Set("type", "box").Set("size", Words((0.5 * shape.size).eval()));
        break;
      case ShapeType::kSphere:
        geom->Set("type", "sphere").Set("size", shape.radius);
        break;
      case ShapeType::kCylinder:
      case ShapeType::kCapsule:
        geom->Set("type", shape.type == ShapeType::kCylinder ? "cylinder" : "capsule")
            .Set("size", fmt::format("{} {}", shape.radius, 0.5 * shape.length));
        break;
      case ShapeType::kConvexMesh:
        geom->Set("type", "mesh").Set("mesh", mesh);
        break;
    }
    geom->SetPose(X);
  }

  void WriteLink(int link) {
    Element body(&printer_, "body");
    body.Set("name", robot_.links[link].name);
    if (link == 0) {
      body.SetPose(Start());
      Element(&printer_, "freejoint").Set("name", "root");
    } else {
      body.SetPose(robot_.joints[link - 1].X_PJ);
      WriteJoint(robot_.joints[link - 1]);
    }
    WriteInertia(robot_.links[link].inertial);
    const auto& shapes = robot_.links[link].shapes;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      Element geom(&printer_, "geom");
      SetShape(shapes[i].shape, shapes[i].X_PS, fmt::format("link_{}_{}", link, i), &geom);
      geom.Set("rgba", kRobotColor);
    }
    for (const actions::BearingPoint& point : AllContactPoints(robot_)) {
      if (point.link != link) continue;
      Element(&printer_, "site")
          .Set("name", ContactColumn(robot_, point))
          .Set("pos", Words(point.p_L))
          .Set("size", 0.005);
    }
    for (const int child : tree_.children(link)) WriteLink(child);
  }

  /// Where the motion begins: MuJoCo's model must not begin inside the ground.
  Isometry3d Start() const {
    const Eigen::VectorXd& q = subject_.plan.segments.front().phases.front().knots.front().q;
    Isometry3d X = Isometry3d::Identity();
    X.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
    X.translation() = q.segment<3>(4);
    return X;
  }

  void WriteJoint(const models::Joint& joint) {
    Element element(&printer_, "joint");
    element.Set("name", joint.name)
        .Set("type", joint.type == models::JointType::kPrismatic ? "slide" : "hinge")
        .Set("axis", Words(joint.axis));
    if (std::isfinite(joint.lower) && joint.lower < joint.upper && std::isfinite(joint.upper)) {
      element.Set("limited", "true").Set("range", fmt::format("{} {}", joint.lower, joint.upper));
    }
    const models::Actuator& actuator = joint.actuator;
    if (actuator.armature > 0) element.Set("armature", actuator.armature);
    if (actuator.viscous_friction > 0) element.Set("damping", actuator.viscous_friction);
    if (actuator.dry_friction > 0) element.Set("frictionloss", actuator.dry_friction);
  }

  void WriteInertia(const models::Inertial& inertial) {
    const Eigen::Matrix3d& I = inertial.I_LC;
    Element(&printer_, "inertial")
        .Set("pos", Words(inertial.p_LC))
        .Set("mass", inertial.mass)
        .Set("fullinertia", fmt::format("{} {} {} {} {} {}", I(0, 0), I(1, 1), I(2, 2), I(0, 1),
                                        I(0, 2), I(1, 2)));
  }

  /// MuJoCo itself leaves out parent and child.
  void WriteExclusions() {
    const Element contact(&printer_, "contact");
    for (const auto& [a, b] : robot_.ignored_collisions) {
      Element(&printer_, "exclude")
          .Set("body1", robot_.links[a].name)
          .Set("body2", robot_.links[b].name);
    }
  }

  void WriteCouplings() {
    const Element equality(&printer_, "equality");
    for (const models::Joint& joint : robot_.joints) {
      if (joint.lower == joint.upper) {  // MuJoCo refuses empty ranges
        Element(&printer_, "joint")
            .Set("joint1", joint.name)
            .Set("polycoef", fmt::format("{} 0 0 0 0", joint.lower));
      }
      if (!joint.mimic) continue;
      Element(&printer_, "joint")
          .Set("joint1", joint.name)
          .Set("joint2", robot_.joints[joint.mimic->joint].name)
          .Set("polycoef",
               fmt::format("{} {} 0 0 0", joint.mimic->offset, joint.mimic->multiplier));
    }
  }

  void WriteMotors() {
    const Element actuators(&printer_, "actuator");
    for (const int j : tree_.motors()) {
      const models::Joint& joint = robot_.joints[j];
      Element motor(&printer_, "motor");
      motor.Set("name", joint.name).Set("joint", joint.name);
      if (!std::isfinite(joint.effort) || joint.effort <= 0) continue;
      motor.Set("ctrllimited", "true")
          .Set("ctrlrange", fmt::format("{} {}", -joint.effort, joint.effort));
    }
  }

  void WriteKeyframes(const ExportSampling& sampling) {
    const Element keyframes(&printer_, "keyframe");
    int index = 0;
    VisitSamples(subject_, {sampling.period.value_or(kKeyframePeriod), false},
                 [&](const PlanSample& sample) {
                   const actions::Knot& knot = sample.knot;
                   Element(&printer_, "key")
                       .Set("name", fmt::format("{}", index++))
                       .Set("time", knot.t)
                       .Set("qpos", Words(tree_.Positions(knot.q)))
                       .Set("qvel", Words(tree_.Rates(knot.q, knot.v)))
                       .Set("ctrl", Words(tree_.Controls(knot.tau)));
                 });
  }

  const ExportSubject& subject_;
  const models::RobotModel& robot_;
  MujocoTree tree_;
  tinyxml2::XMLPrinter printer_;
};

}  // namespace

std::string MujocoXml(const ExportSubject& subject, const ExportSampling& sampling) {
  return MujocoWriter(subject).Text(sampling);
}

void WriteMujoco(const ExportSubject& subject, const ExportSampling& sampling,
                 const std::filesystem::path& file) {
  models::WriteAtomically(file, MujocoXml(subject, sampling));
}

}  // namespace possibility::experiments
