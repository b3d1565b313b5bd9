#pragma once

#include <string>

namespace possibility::models {

/// A small valid robot for tests: a box on two legs of three joints each (yaw, roll, slide) with
/// a tool on a fixed joint. Standing, its feet are 1 m below the root.
inline std::string TwoLeggedUrdf() {
  std::string urdf = "<robot name=\"two_legged\">\n";
  const auto link = [&](const std::string& name, const std::string& collision) {
    urdf += "<link name=\"" + name + "\">\n<inertial><origin xyz=\"0.01 0.02 -0.03\"/>" +
            "<mass value=\"2\"/><inertia ixx=\"0.02\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.03\"" +
            " iyz=\"0\" izz=\"0.04\"/></inertial>\n" + collision + "</link>\n";
  };
  const auto joint = [&](const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& rest) {
    urdf += "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
            "\"/><child link=\"" + child + "\"/>" + rest + "</joint>\n";
  };
  const std::string box =
      "<collision><geometry><box size=\"0.2 0.3 0.1\"/></geometry></collision>\n";
  const std::string limit = "<limit lower=\"-1\" upper=\"1\" velocity=\"5\" effort=\"50\"/>";
  link("base", box);
  link("tool", "<collision><geometry><sphere radius=\"0.05\"/></geometry></collision>\n");
  joint("mount", "fixed", "base", "tool", "<origin xyz=\"0 0 0.3\" rpy=\"0 0.5 0\"/>");
  for (const std::string side : {"l", "r"}) {
    const std::string y = side == "l" ? "0.1" : "-0.1";
    for (const std::string part : {"_hip", "_thigh", "_foot"}) link(side + part, "");
    joint(side + "_yaw", "revolute", "base", side + "_hip",
          "<origin xyz=\"0 " + y + " 0\"/><axis xyz=\"0 0 1\"/>" + limit);
    joint(side + "_roll", "revolute", side + "_hip", side + "_thigh",
          "<axis xyz=\"1 0 0\"/>" + limit);
    joint(side + "_slide", "prismatic", side + "_thigh", side + "_foot",
          "<origin xyz=\"0 0 -0.8\"/><axis xyz=\"0 0 2\"/>" + limit);
  }
  return urdf + "</robot>\n";
}

inline std::string TwoLeggedYaml() {
  return R"(name: two_legged
urdf: robot.urdf
root_link: base
pelvis_link: base
friction: 0.6
effort:
  - {joints: [l_yaw, r_yaw], limit: 30, reason: assumed}
shapes:
  l_foot:
    - {shape: capsule, radius: 0.02, length: 0.1, position: [0, 0, -0.1], rpy_deg: [0, 90, 0]}
contacts:
  - {name: left, link: l_foot, points: [[0, 0, -0.2]], normal: [0, 0, -2]}
  - {name: right, link: r_foot, points: [[0, 0, -0.2]], normal: [0, 0, -1]}
sagittal_pairs: [[l_yaw, r_yaw], [l_roll, r_roll], [l_slide, r_slide]]
ignored_collisions: [[l_thigh, r_thigh]]
gaits:
  - name: stand
    posture: {root_height: 1, root_pitch_deg: 0, joints_deg: {l_yaw: 10}}
    limbs:
      - {contact: left, hold_orientation: false, joints: [l_yaw, l_roll, l_slide]}
      - {contact: right, hold_orientation: false, joints: [r_yaw, r_roll, r_slide]}
    parameters: {forward: 0.1, lateral: 0.1, turn_deg: 10, clearance: 0.05, com_margin: 0.01,
                 swing_time: 1, com_acceleration: 0.5, minimum_shift_time: 0.2}
  - name: squat
    posture: {root_height: 0.7, root_pitch_deg: 0, joints_deg: {l_slide: 0.3, r_slide: 0.3}}
    limbs:
      - {contact: right, hold_orientation: false, joints: [r_yaw, r_roll, r_slide]}
      - {contact: left, hold_orientation: false, joints: [l_yaw, l_roll, l_slide]}
    parameters: {forward: 0.1, lateral: 0.1, turn_deg: 10, clearance: 0.05, com_margin: 0.01,
                 swing_time: 1, com_acceleration: 0.5, minimum_shift_time: 0.2}
transitions:
  - from: stand
    to: squat
)";
}

}  // namespace possibility::models
