#include "tests/fuzz/onboarding_subjects.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <optional>
#include <string>
#include <utility>

#include "actions/onboarding/robot_draft.h"
#include "actions/onboarding/robot_yaml_writer.h"
#include "models/input/file_contents.h"
#include "tests/models/mesh/mesh_files.h"

namespace possibility::fuzz {
namespace {

namespace fs = std::filesystem;

const fs::path kHumanoids = fs::path(POSSIBILITY_SOURCE_DIR) / "models";

fs::path Put(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

void UseDraft(const fs::path& urdf, const std::optional<fs::path>& srdf) {
  actions::RobotYaml(actions::DraftRobot(urdf, {}, srdf), "robot.urdf");
}

/// T1, whose feet have a mesh in place of a box.
std::string UrdfWithMeshes(const std::string& mesh) {
  std::string text = models::ReadFileContents(kHumanoids / "t1/t1.urdf");
  const std::string box = "<box size=\"0.2248 0.1 0.031\"/>";
  for (std::size_t at = text.find(box); at != std::string::npos; at = text.find(box)) {
    text.replace(at, box.size(), fmt::format("<mesh filename=\"{}\"/>", mesh));
  }
  return text;
}

std::string SrdfOfT1() {
  std::string text =
      "<?xml version=\"1.0\"?>\n<robot name=\"t1\">\n"
      "  <group name=\"left_leg\"><chain base_link=\"Waist\" "
      "tip_link=\"left_foot_link\"/></group>\n"
      "  <group name=\"right_arm\"><joint name=\"Right_Shoulder_Pitch\"/>"
      "<link name=\"AR2\"/></group>\n"
      "  <group name=\"limbs\"><group name=\"left_leg\"/><group name=\"right_arm\"/></group>\n"
      "  <group_state name=\"half_sitting\" group=\"left_leg\">\n"
      "    <joint name=\"Left_Hip_Pitch\" value=\"-0.4\"/><joint name=\"Left_Knee_Pitch\" "
      "value=\"0.8\"/>\n"
      "  </group_state>\n"
      "  <end_effector name=\"foot\" parent_link=\"left_foot_link\" group=\"left_leg\"/>\n"
      "  <virtual_joint name=\"world\" type=\"floating\" parent_frame=\"map\" "
      "child_link=\"Trunk\"/>\n";
  for (const char* reason : {"Adjacent", "Never", "Default", ""}) {
    text += fmt::format(
        "  <disable_collisions link1=\"Trunk\" link2=\"Waist\" reason=\"{}\"/>\n"
        "  <disable_collisions link1=\"AL1\" link2=\"Hip_Yaw_Left\" reason=\"{}\"/>\n",
        reason, reason);
  }
  return text + "</robot>\n";
}

}  // namespace

Subject InitUrdfSubject(const fs::path& folder) {
  const std::array<std::string, 3> texts = {
      models::ReadFileContents(kHumanoids / "drchubo1/drchubo1.urdf"),
      models::ReadFileContents(kHumanoids / "t1/t1.urdf"),
      models::ReadFileContents(kHumanoids / "h1_2/h1_2.urdf")};
  return {"init_urdf", ".urdf", Syntax::kXml,
          [texts](std::uint64_t seed) { return texts[seed % texts.size()]; },
          [folder](std::uint64_t, const std::string& text) {
            UseDraft(Put(folder / "spoilt.urdf", text), std::nullopt);
          }};
}

Subject InitSrdfSubject(const fs::path& folder) {
  return {"init_srdf", ".srdf", Syntax::kXml, [](std::uint64_t) { return SrdfOfT1(); },
          [folder](std::uint64_t, const std::string& text) {
            UseDraft(kHumanoids / "t1/t1.urdf", Put(folder / "spoilt.srdf", text));
          }};
}

Subject InitMeshSubject(const fs::path& folder) {
  using namespace models::testing;  // NOLINT
  Put(folder / "robot.urdf", UrdfWithMeshes("foot.stl"));
  const models::TriangleMesh foot = BoxMesh({0.22, 0.1, 0.03});
  const std::array<std::pair<std::string, std::string>, 4> files = {{
      {"foot.stl", BinaryStl(foot)},
      {"foot.stl", TextStl(foot)},
      {"foot.obj", Obj(foot)},
      {"foot.dae", Collada(foot, 1, "Z_UP")},
  }};
  return {"init_mesh", ".mesh", Syntax::kYaml,
          [files](std::uint64_t seed) { return files[seed % files.size()].second; },
          [folder, files](std::uint64_t seed, const std::string& text) {
            const std::string& name = files[seed % files.size()].first;
            Put(folder / name, text);
            UseDraft(Put(folder / "robot.urdf", UrdfWithMeshes(name)), std::nullopt);
          }};
}

}  // namespace possibility::fuzz
