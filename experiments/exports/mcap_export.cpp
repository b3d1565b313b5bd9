#include "experiments/exports/mcap_export.h"

#include <cmath>
#include <string>
#include <vector>

#include "dynamics/tree/tree_kinematics.h"
#include "experiments/exports/foxglove_messages.h"
#include "experiments/exports/foxglove_schemas.h"
#include "experiments/formats/mcap_writer.h"
#include "experiments/samples/quantities.h"
#include "models/input/file_contents.h"
#include "models/input/json_text.h"
#include "models/input/yaml_reader.h"

namespace possibility::experiments {
namespace {

constexpr double kMessagePeriod = 0.02;  // s

std::string UrdfText(const models::RobotModel& robot) {
  const std::string yaml = models::ReadFileContents(robot.file);
  const std::string urdf = models::YamlNode::Parse(yaml, robot.file).At("urdf").String();
  return models::ReadFileContents(robot.file.parent_path() / urdf);
}

std::uint64_t Nanoseconds(double t) { return static_cast<std::uint64_t>(std::llround(t * 1e9)); }

class McapExport {
 public:
  McapExport(const ExportSubject& subject, const std::filesystem::path& file)
      : robot_(subject.robot),
        points_(AllContactPoints(subject.robot)),
        kinematics_(subject.robot),
        writer_(file, "possibility") {
    writer_.AddMetadata("plan", {{"format", actions::kPlanFormat},
                                 {"robot", robot_.name},
                                 {"robot_hash", subject.plan.robot_hash},
                                 {"scenario", subject.scenario.name},
                                 {"scenario_hash", subject.plan.scenario_hash}});
    const auto scene = writer_.AddSchema("foxglove.SceneUpdate", SceneUpdateSchema());
    const auto text = writer_.AddSchema("std_msgs/String", TextSchema());
    transforms_ = writer_.AddChannel(
        "/tf", writer_.AddSchema("foxglove.FrameTransforms", FrameTransformsSchema()));
    joints_ = writer_.AddChannel("/joint_states",
                                 writer_.AddSchema("foxglove.JointStates", JointStatesSchema()));
    forces_ = writer_.AddChannel(
        "/contact_forces", writer_.AddSchema("possibility.ContactForces", ContactForcesSchema()));
    arrows_ = writer_.AddChannel("/contact_force_arrows", scene);
    const std::string urdf = models::JsonText(nlohmann::ordered_json{{"data", UrdfText(robot_)}});
    writer_.Write(writer_.AddChannel("/robot_description", text), 0, urdf);
    writer_.Write(writer_.AddChannel("/scene", scene), 0,
                  WorldScene(subject.scenario.environment, 0));
    writer_.Write(writer_.AddChannel("/robot", scene), 0, RobotScene(robot_, 0));
  }

  void Write(const PlanSample& sample) {
    const std::uint64_t time = Nanoseconds(sample.knot.t);
    kinematics_.SetPosition(sample.knot.q);
    const std::vector<PointForce> forces = Forces(sample);
    writer_.Write(transforms_, time, LinkTransforms(robot_, kinematics_.X_WL(), time));
    writer_.Write(joints_, time, JointStates(robot_, sample.knot, time));
    writer_.Write(forces_, time, ContactForces(forces, time));
    writer_.Write(arrows_, time, ForceArrows(forces, time));
  }

  void Commit() { writer_.Commit(); }

 private:
  std::vector<PointForce> Forces(const PlanSample& sample) const {
    std::vector<PointForce> forces;
    for (const actions::BearingPoint& point : points_) {
      forces.push_back({ContactColumn(robot_, point), false,
                        kinematics_.Position(point.link, point.p_L), Eigen::Vector3d::Zero()});
    }
    Eigen::Index column = 0;
    for (const int point : BearingColumns(robot_, *sample.phase)) {
      forces[point].bears = true;
      forces[point].force = sample.knot.forces.col(column++);
    }
    return forces;
  }

  const models::RobotModel& robot_;
  const std::vector<actions::BearingPoint> points_;
  dynamics::TreeKinematics kinematics_;
  McapWriter writer_;
  std::uint16_t transforms_ = 0, joints_ = 0, forces_ = 0, arrows_ = 0;
};

}  // namespace

void WriteMcap(const ExportSubject& subject, const ExportSampling& sampling,
               const std::filesystem::path& file) {
  McapExport recording(subject, file);
  VisitSamples(subject, {sampling.period.value_or(kMessagePeriod), false},
               [&](const PlanSample& sample) { recording.Write(sample); });
  recording.Commit();
}

}  // namespace possibility::experiments
