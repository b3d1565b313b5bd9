// Ways to spoil a robot's files, each with the one line of its error message.

#include <gtest/gtest.h>

#include "models/input/input_error.h"
#include "models/robot/robot_model.h"
#include "models/robot/robot_yaml.h"
#include "tests/models/temporary_folder.h"
#include "tests/models/two_legged_robot.h"
#include "tests/replaced.h"

namespace possibility::models {
namespace {

struct BadRobot {
  std::string what;
  bool in_urdf;
  std::string from;  ///< replaced once, at its first occurrence; empty: the whole file
  std::string to;
  std::string message;  ///< without the folder
};

std::string RobotMessageOf(const std::string& yaml, const std::string& urdf) {
  const TemporaryFolder folder;
  folder.Write("robot.urdf", urdf);
  const std::filesystem::path file = folder.Write("robot.yaml", yaml);
  try {
    LoadRobotModel(file);
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string prefix = folder.path().string() + "/";
    for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) {
      message.erase(at, prefix.size());
    }
    return message;
  }
  return "no error";
}

class RobotErrors : public ::testing::TestWithParam<BadRobot> {};

TEST_P(RobotErrors, EachFaultIsNamedInOneLine) {
  const BadRobot& bad = GetParam();
  const std::string yaml = TwoLeggedYaml();
  const std::string urdf = TwoLeggedUrdf();
  EXPECT_EQ(bad.in_urdf ? RobotMessageOf(yaml, Replaced(urdf, bad.from, bad.to))
                        : RobotMessageOf(Replaced(yaml, bad.from, bad.to), urdf),
            bad.message);
}

TEST(RobotErrorsBaseline, TheUnspoiltRobotLoads) {
  EXPECT_EQ(RobotMessageOf(TwoLeggedYaml(), TwoLeggedUrdf()), "no error");
}

TEST(RobotErrorsBaseline, AMissingYamlIsNamed) {
  try {
    LoadRobotModel("/nowhere/robot.yaml");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "/nowhere/robot.yaml: no such file");
  }
}

TEST(RobotErrorsBaseline, AFolderInPlaceOfTheYamlIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW(LoadRobotModel(folder.path()), InputError);
}

const std::string kYawJoint = "<joint name=\"l_yaw\" type=\"revolute\">";
const std::string kYawAxis = "<axis xyz=\"0 0 1\"/>";
const std::string kYawLimit = "<limit lower=\"-1\" upper=\"1\" velocity=\"5\" effort=\"50\"/>";
const std::string kInertia =
    "<inertia ixx=\"0.02\" ixy=\"0.001\" ixz=\"0\" iyy=\"0.03\" iyz=\"0\" izz=\"0.04\"/>";
const std::string kInertial =
    "<inertial><origin xyz=\"0.01 0.02 -0.03\"/><mass value=\"2\"/>" + kInertia + "</inertial>";
const std::string kTransition = "to: squat";

const std::string kYawRest =
    "<parent link=\"base\"/><child link=\"l_hip\"/><origin xyz=\"0 0.1 0\"/>" + kYawAxis;

/// A list of actuators before the shapes.
std::string Actuators(const std::string& entry) {
  return "actuators: [\n    {" + entry + "}]\nshapes:";
}

const BadRobot kBadYaml[] = {
    {"Empty", false, "", "", "robot.yaml: expected a YAML map, got nothing"},
    {"OnlyAComment", false, "", "# nothing\n", "robot.yaml: expected a YAML map, got nothing"},
    {"NotAMap", false, "", "- a\n", "robot.yaml:1: expected a map, got a list of 1"},
    {"SyntaxErrorWithLine", false, "friction: 0.6", "friction: [0.6",
     "robot.yaml:6: not valid YAML: end of sequence flow not found"},
    {"TwoDocuments", false, "name: two_legged", "name: two_legged\n---\na: b",
     "robot.yaml: expected one YAML document and nothing after it"},
    {"UnknownKey", false, "friction: 0.6", "frction: 0.6",
     "robot.yaml:5: unknown key 'frction' (did you mean 'friction'?)"},
    {"UnknownKeyNothingLike", false, "friction: 0.6", "xyzzy: 0.6",
     "robot.yaml:5: unknown key 'xyzzy'"},
    {"KeyTwice", false, "friction: 0.6", "friction: 0.6\nfriction: 0.7",
     "robot.yaml:6: the key 'friction' appears twice"},
    {"MissingKey", false, "friction: 0.6\n", "", "robot.yaml:1: the key 'friction' is missing"},
    {"NameIsAList", false, "name: two_legged", "name: [a]",
     "robot.yaml:1: name: expected a text, got a list of 1"},
    {"FrictionNotANumber", false, "friction: 0.6", "friction: high",
     "robot.yaml:5: friction: expected a number, got high"},
    {"FrictionNaN", false, "friction: 0.6", "friction: nan",
     "robot.yaml:5: friction: expected a finite number, got nan"},
    {"FrictionYamlNaN", false, "friction: 0.6", "friction: .nan",
     "robot.yaml:5: friction: expected a number, got .nan"},
    {"FrictionInfinite", false, "friction: 0.6", "friction: inf",
     "robot.yaml:5: friction: expected a finite number, got inf"},
    {"FrictionNegative", false, "friction: 0.6", "friction: -0.6",
     "robot.yaml:5: friction: expected a positive number, got -0.6"},
    {"FrictionHuge", false, "friction: 0.6", "friction: 1e7",
     "robot.yaml:5: friction: expected a number of at most 1e6 in magnitude, got 1e7"},
    {"FrictionEmpty", false, "friction: 0.6",
     "friction:", "robot.yaml:5: friction: expected a number, got nothing"},
    {"UrdfMissing", false, "urdf: robot.urdf", "urdf: robt.urdf",
     "robot.yaml:2: urdf: no such file: robt.urdf"},
    {"RootLink", false, "root_link: base", "root_link: tool",
     "robot.yaml:3: root_link: expected the root of the URDF, 'base', got tool"},
    {"PelvisOnALumpedLink", false, "pelvis_link: base", "pelvis_link: tool",
     "robot.yaml:4: pelvis_link: unknown link 'tool'"},
    {"PelvisWithoutShape", false, "pelvis_link: base", "pelvis_link: l_hip",
     "robot.yaml:4: pelvis_link: this link has no collision shape"},
    {"LumpUnknownJoint", false, "friction: 0.6", "friction: 0.6\nlump: [l_yaww]",
     "robot.yaml:6: lump[0]: unknown joint 'l_yaww' (did you mean 'l_yaw'?)"},
    {"LumpTwice", false, "friction: 0.6", "friction: 0.6\nlump: [l_yaw, l_yaw]",
     "robot.yaml:6: lump[1]: joint 'l_yaw' is listed twice"},
    {"EffortUnknownJoint", false, "joints: [l_yaw, r_yaw], limit: 30", "joints: [l_jaw], limit: 30",
     "robot.yaml:7: effort[0].joints[0]: unknown joint 'l_jaw' (did you mean 'l_yaw'?)"},
    {"EffortNegative", false, "limit: 30", "limit: -30",
     "robot.yaml:7: effort[0].limit: expected a positive number, got -30"},
    {"EffortWithoutReason", false, ", reason: assumed", "",
     "robot.yaml:7: effort[0]: the key 'reason' is missing"},
    {"ActuatorUnknownKey", false, "shapes:", Actuators("joints: [l_yaw], armatur: 1, reason: a"),
     "robot.yaml:9: actuators[0]: unknown key 'armatur' (did you mean 'armature'?)"},
    {"ActuatorUnknownJoint", false, "shapes:", Actuators("joints: [l_jaw], armature: 1, reason: a"),
     "robot.yaml:9: actuators[0].joints[0]: unknown joint 'l_jaw' (did you mean 'l_yaw'?)"},
    {"ActuatorNegative", false, "shapes:", Actuators("joints: [l_yaw], armature: -1, reason: a"),
     "robot.yaml:9: actuators[0].armature: expected a number of at least 0, got -1"},
    {"ActuatorNaN", false,
     "shapes:", Actuators("joints: [l_yaw], viscous_friction: nan, reason: a"),
     "robot.yaml:9: actuators[0].viscous_friction: expected a finite number, got nan"},
    {"ActuatorWithoutReason", false, "shapes:", Actuators("joints: [l_yaw], armature: 1"),
     "robot.yaml:9: actuators[0]: the key 'reason' is missing"},
    {"ActuatorOfNothing", false, "shapes:", Actuators("joints: [l_yaw], reason: a"),
     "robot.yaml:9: actuators[0]: expected at least one of armature, viscous_friction, "
     "dry_friction, stall_torque"},
    {"ActuatorTwice", false, "shapes:",
     Actuators("joints: [l_yaw, r_yaw], armature: 1, reason: a},\n    {joints: [r_yaw], armature: "
               "2, reason: b"),
     "robot.yaml:10: actuators[1].joints: joint 'r_yaw' is listed twice"},
    {"ActuatorDrySpeedAlone", false,
     "shapes:", Actuators("joints: [l_yaw], armature: 1, dry_speed: 1, reason: a"),
     "robot.yaml:9: actuators[0].dry_speed: expected dry_friction beside it"},
    {"ActuatorDrySpeedZero", false,
     "shapes:", Actuators("joints: [l_yaw], dry_friction: 1, dry_speed: 0, reason: a"),
     "robot.yaml:9: actuators[0].dry_speed: expected a number from 0.001 to 1000000, got 0"},
    {"ActuatorHalfALine", false,
     "shapes:", Actuators("joints: [l_yaw], stall_torque: 1, reason: a"),
     "robot.yaml:9: actuators[0]: expected both stall_torque and no_load_speed or neither"},
    {"ActuatorLineTooShort", false,
     "shapes:", Actuators("joints: [l_yaw], stall_torque: 29, no_load_speed: 6, reason: a"),
     "robot.yaml:9: actuators[0].stall_torque: expected at least the torque limit of joint "
     "'l_yaw', 30, got 29"},
    {"ActuatorLineTooSteep", false,
     "shapes:", Actuators("joints: [l_yaw], stall_torque: 30, no_load_speed: 4, reason: a"),
     "robot.yaml:9: actuators[0].no_load_speed: expected more than the speed limit of joint "
     "'l_yaw', 5, got 4"},
    {"ShapeOnUnknownLink", false, "l_foot:\n", "l_foott:\n",
     "robot.yaml:9: shapes: unknown key 'l_foott' (did you mean 'l_foot'?)"},
    {"ShapeKind", false, "shape: capsule", "shape: capsul",
     "robot.yaml:10: shapes.l_foot[0].shape: expected box, sphere, cylinder, capsule or convex, "
     "got capsul (did you mean 'capsule'?)"},
    {"ShapeRadius", false, "radius: 0.02", "radius: 0",
     "robot.yaml:10: shapes.l_foot[0].radius: expected a positive number, got 0"},
    {"ShapeForeignDimension", false, "radius: 0.02", "radius: 0.02, size: [1, 1, 1]",
     "robot.yaml:10: shapes.l_foot[0].size: a capsule has no size"},
    {"ShapeUnknownKey", false, "rpy_deg", "rpy",
     "robot.yaml:10: shapes.l_foot[0]: unknown key 'rpy'"},
    {"ShapePositionShort", false, "position: [0, 0, -0.1]", "position: [0, 0]",
     "robot.yaml:10: shapes.l_foot[0].position: expected three numbers, got a list of 2"},
    {"ShapePositionNaN", false, "position: [0, 0, -0.1]", "position: [0, nan, 0]",
     "robot.yaml:10: shapes.l_foot[0].position: expected three numbers, got nan"},
    {"ContactOnUnknownLink", false, "link: l_foot", "link: l_feet",
     "robot.yaml:12: contacts[0].link: unknown link 'l_feet' (did you mean 'l_foot'?)"},
    {"ContactNameTaken", false, "name: right,", "name: left,",
     "robot.yaml:13: contacts[1].name: this name is already taken"},
    {"ContactWithoutPoints", false, "points: [[0, 0, -0.2]]", "points: []",
     "robot.yaml:12: contacts[0].points: expected at least one point, got an empty list"},
    {"ContactNormalZero", false, "normal: [0, 0, -2]", "normal: [0, 0, 0]",
     "robot.yaml:12: contacts[0].normal: expected a direction, got a zero vector"},
    {"SagittalUnknownJoint", false, "[l_roll, r_roll]", "[l_roll, r_rol]",
     "robot.yaml:14: sagittal_pairs[1][1]: unknown joint 'r_rol' (did you mean 'r_roll'?)"},
    {"SagittalThreeJoints", false, "[l_roll, r_roll]", "[l_roll, r_roll, r_yaw]",
     "robot.yaml:14: sagittal_pairs[1]: expected a pair of joints, got a list of 3"},
    {"SagittalTwice", false, "[l_roll, r_roll]", "[l_roll, r_yaw]",
     "robot.yaml:14: sagittal_pairs[1]: joint 'r_yaw' is in two pairs"},
    {"SagittalWithItself", false, "[l_roll, r_roll]", "[l_roll, l_roll]",
     "robot.yaml:14: sagittal_pairs[1][1]: joint 'l_roll' is listed twice"},
    {"SagittalTypes", false, "[l_roll, r_roll], [l_slide, r_slide]", "[l_roll, r_slide]",
     "robot.yaml:14: sagittal_pairs[1]: expected two joints of one type"},
    {"IgnoredUnknownLink", false, "[l_thigh, r_thigh]", "[l_thigh, r_thig]",
     "robot.yaml:15: ignored_collisions[0][1]: unknown link 'r_thig' (did you mean 'r_thigh'?)"},
    {"PostureHeight", false, "root_height: 1,", "root_height: 0,",
     "robot.yaml:18: gaits[0].posture.root_height: expected a positive number, got 0"},
    {"PostureUnknownJoint", false, "{l_yaw: 10}", "{l_jaw: 10}",
     "robot.yaml:18: gaits[0].posture.joints_deg: unknown key 'l_jaw' (did you mean 'l_yaw'?)"},
    {"PostureOutsideLimits", false, "{l_yaw: 10}", "{l_yaw: 100}",
     "robot.yaml:18: gaits[0].posture.joints_deg.l_yaw: expected a value within the limits "
     "-57.2958 to 57.2958 of joint 'l_yaw', got 100"},
    {"PostureSlideOutsideLimits", false, "r_slide: 0.3}}", "r_slide: 1.3}}",
     "robot.yaml:25: gaits[1].posture.joints_deg.r_slide: expected a value within the limits -1 to "
     "1 of joint 'r_slide', got 1.3"},
    {"PostureOffTheGround", false, "root_height: 1,", "root_height: 1.01,",
     "robot.yaml:18: gaits[0].posture: contact 'left' is at height 0.010000 m in this posture, "
     "expected 0"},
    {"PostureUpsideDown", false, "root_pitch_deg: 0, joints_deg: {l_yaw",
     "root_pitch_deg: 80, joints_deg: {l_yaw",
     "robot.yaml:18: gaits[0].posture: contact 'left' is at height 0.826352 m in this posture, "
     "expected 0"},
    {"ContactFacesUp", false, "normal: [0, 0, -2]", "normal: [0, 0, 2]",
     "robot.yaml:18: gaits[0].posture: contact 'left' does not face the ground in this posture"},
    {"LimbJointCount", false, "{contact: left, hold_orientation: false",
     "{contact: left, hold_orientation: true",
     "robot.yaml:20: gaits[0].limbs[0].joints: expected 6 joints to hold a pose, got 3"},
    {"LimbBoolean", false, "{contact: left, hold_orientation: false",
     "{contact: left, hold_orientation: no",
     "robot.yaml:20: gaits[0].limbs[0].hold_orientation: expected true or false, got no"},
    {"LimbUnknownContact", false, "{contact: left, hold", "{contact: lft, hold",
     "robot.yaml:20: gaits[0].limbs[0].contact: unknown contact 'lft' (did you mean 'left'?)"},
    {"LimbForeignJoint", false, "joints: [l_yaw, l_roll, l_slide]",
     "joints: [l_yaw, l_roll, r_slide]",
     "robot.yaml:20: gaits[0].limbs[0].joints[2]: joint 'r_slide' does not move contact 'left'"},
    {"LimbContactTwice", false,
     "{contact: right, hold_orientation: false, joints: [r_yaw, r_roll, r_slide]}\n    parameters",
     "{contact: left, hold_orientation: false, joints: [l_yaw, l_roll, l_slide]}\n    parameters",
     "robot.yaml:21: gaits[0].limbs[1].contact: this contact already belongs to another limb of "
     "the gait"},
    {"OneLimb", false,
     "      - {contact: right, hold_orientation: false, joints: [r_yaw, r_roll, r_slide]}\n    "
     "parameters",
     "    parameters",
     "robot.yaml:20: gaits[0].limbs: expected at least two limbs, got a list of 1"},
    {"ParameterZero", false, "forward: 0.1", "forward: 0",
     "robot.yaml:22: gaits[0].parameters.forward: expected a positive number, got 0"},
    {"ParameterTurnNegative", false, "turn_deg: 10", "turn_deg: -10",
     "robot.yaml:22: gaits[0].parameters.turn_deg: expected a positive number, got -10"},
    {"ParameterMissing", false, "clearance: 0.05, ", "",
     "robot.yaml:22: gaits[0].parameters: the key 'clearance' is missing"},
    {"GaitNamedLikeATransition", false, "name: squat", "name: stand->squat",
     "robot.yaml:24: gaits[1].name: expected a name of at most 64 letters, digits, '_' and '-' "
     "that begins with a letter, got stand->squat"},
    {"GaitNameTaken", false, "name: squat", "name: stand",
     "robot.yaml:24: gaits[1].name: this name is already taken"},
    {"TransitionUnknownGait", false, "from: stand", "from: stan",
     "robot.yaml:32: transitions[0].from: unknown gait 'stan' (did you mean 'stand'?)"},
    {"TransitionToItself", false, "to: squat", "to: stand",
     "robot.yaml:33: transitions[0].to: expected another gait than 'from', got stand"},
    {"TransitionIsNotScripted", false, kTransition, kTransition + "\n    keyframes: []",
     "robot.yaml:34: transitions[0]: unknown key 'keyframes'"},
    {"TransitionTwice", false, kTransition, kTransition + "\n  - {from: squat, to: stand}",
     "robot.yaml:34: transitions[1]: these two gaits already have a transition (it is used in both "
     "directions)"},
    {"JumpUnknownGait", false, kTransition,
     kTransition + "\njumps:\n  - {name: leap, from: stan, to: squat}",
     "robot.yaml:35: jumps[0].from: unknown gait 'stan' (did you mean 'stand'?)"},
    {"JumpWithMarkup", false, kTransition,
     kTransition + "\njumps:\n  - {name: '<b>', from: stand, to: squat}",
     "robot.yaml:35: jumps[0].name: expected a name of at most 64 letters, digits, '_' and '-' "
     "that begins with a letter, got <b>"},
    {"JumpNamedLikeAGait", false, kTransition,
     kTransition + "\njumps:\n  - {name: squat, from: stand, to: squat}",
     "robot.yaml:35: jumps[0].name: this name is already that of a gait"},
    {"JumpNameTaken", false, kTransition,
     kTransition + "\njumps:\n  - {name: leap, from: stand, to: squat}\n"
                   "  - {name: leap, from: squat, to: stand}",
     "robot.yaml:36: jumps[1].name: this name is already taken"},
    {"JumpUnknownKey", false, kTransition,
     kTransition + "\njumps:\n  - {name: leap, from: stand, too: squat}",
     "robot.yaml:35: jumps[0]: unknown key 'too' (did you mean 'to'?)"},
};

std::string Nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += "<a>";
  return text;
}

std::string Links(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += "<link name=\"" + std::to_string(i) + "\"/>";
  return text;
}

const BadRobot kBadUrdf[] = {
    {"Empty", true, "", "", "robot.urdf: the file is empty, expected a URDF"},
    {"Blank", true, "", "  \n\n", "robot.urdf: the file is empty, expected a URDF"},
    {"NoText", true, "", std::string("<robot\0", 7),
     "robot.urdf: not a text file, expected a URDF"},
    {"NotXml", true, "", "hello",
     "robot.urdf:1: not a valid URDF: no XML (XML_ERROR_PARSING_TEXT)"},
    {"OtherRootElement", true, "", "<sdf></sdf>",
     "robot.urdf:1: not a valid URDF: expected a <robot> element"},
    {"NoLinks", true, "", "<robot name=\"a\"></robot>",
     "robot.urdf: not a valid URDF: No link elements found in urdf file"},
    {"Truncated", true, "</robot>\n", "", "robot.urdf:1: not a valid URDF: an element has no end"},
    {"DeeplyNested", true, "", Nested(1000000),
     "robot.urdf:1: not a valid URDF: elements are nested too deeply"},
    {"TooManyLinks", true, "</robot>", Links(2000) + "</robot>",
     "robot.urdf:35: expected at most 2000 links and joints"},
    {"PercentInANumber", true, "0.01 0.02 -0.03", "0%n 0.02 -0.03",
     "robot.urdf:3: <origin xyz='0%n 0.02 -0.03'>: expected no percent sign"},
    {"PercentInAType", true, kYawJoint, "<joint name=\"l_yaw\" type=\"%s%n\">",
     "robot.urdf:20: <joint type='%s%n'>: expected no percent sign"},
    {"PercentByReference", true, "value=\"2\"", "value=\"&#37;n\"",
     "robot.urdf:3: <mass value='%n'>: expected no percent sign"},
    {"PercentInALinkName", true, "<link name=\"l_hip\">", "<link name=\"%n%s\">",
     "robot.urdf: not a valid URDF: Failed to build tree: parent link [l_hip] of joint [l_roll] "
     "not "
     "found. This is not valid according to the URDF spec. Every link you refer to from a joint "
     "needs to be explicitly defined in the robot de..."},
    {"PercentInTheNameOfWhatIsMissing", true, "<parent link=\"l_hip\"/>", "<parent link=\"%n%s\"/>",
     "robot.urdf: not a valid URDF: Failed to build tree: parent link [%n%s] of joint [l_roll] not "
     "found. This is not valid according to the URDF spec. Every link you refer to from a joint "
     "needs to be explicitly defined in the robot des..."},
    {"ControlCharacter", true, "<link name=\"l_hip\">", "<link name=\"l\x1ahip\">",
     "robot.urdf:11: <link name='l hip'>: expected no control characters"},
    {"LinkWithoutInertia", true, "<link name=\"l_hip\">\n" + kInertial, "<link name=\"l_hip\">",
     "robot.urdf: link 'l_hip': expected an inertial (only links on fixed or lumped joints may go "
     "without)"},
    {"MassZero", true, "<mass value=\"2\"/>", "<mass value=\"0\"/>",
     "robot.urdf: link 'base': expected a positive mass, got 0"},
    {"MassNegative", true, "<mass value=\"2\"/>", "<mass value=\"-2\"/>",
     "robot.urdf: link 'base': expected a positive mass, got -2"},
    {"MassNaN", true, "<mass value=\"2\"/>", "<mass value=\"nan\"/>",
     "robot.urdf: not a valid URDF: Inertial: mass [nan] is not a float; Could not parse inertial "
     "element for Link [base]"},
    {"MassText", true, "<mass value=\"2\"/>", "<mass value=\"2kg\"/>",
     "robot.urdf: not a valid URDF: Inertial: mass [2kg] is not a float; Could not parse inertial "
     "element for Link [base]"},
    {"MassHuge", true, "<mass value=\"2\"/>", "<mass value=\"1e200\"/>",
     "robot.urdf: link 'base': inertial: expected numbers of at most 1e6 in magnitude, got 1e+200"},
    {"InertiaNotPositive", true, "ixx=\"0.02\"", "ixx=\"-0.02\"",
     "robot.urdf: link 'base': inertia is not positive definite (principal moments -0.02, 0.03, "
     "0.04 kg m^2)"},
    {"InertiaTriangle", true, "izz=\"0.04\"", "izz=\"0.06\"",
     "robot.urdf: link 'base': no body has this inertia: principal moment 0.06 exceeds the sum of "
     "the other two, 0.0199 and 0.0301 kg m^2"},
    {"InertiaNaN", true, "izz=\"0.04\"", "izz=\"nan\"",
     "robot.urdf: not a valid URDF: Inertial: inertia element izz is not a valid double; Could not "
     "parse inertial element for Link [base]"},
    {"OriginNaN", true, "0.01 0.02 -0.03", "0.01 nan -0.03",
     "robot.urdf: not a valid URDF: Unable to parse component [nan] to a double (while parsing a "
     "vector value); Could not parse inertial element for Link [base]"},
    {"OriginTwoNumbers", true, "0.01 0.02 -0.03", "0.01 0.02",
     "robot.urdf: not a valid URDF: Parser found 2 elements but 3 expected while parsing vector "
     "[0.01 0.02]; Could not parse inertial element for Link [base]"},
    {"OriginHuge", true, "0.01 0.02 -0.03", "0.01 0.02 1e300",
     "robot.urdf: link 'base': inertial: origin: expected numbers of at most 1e6 in magnitude, got "
     "1e+300"},
    {"ShapeHuge", true, "<box size=\"0.2 0.3 0.1\"/>", "<box size=\"0.2 300 0.1\"/>",
     "robot.yaml: link 'base': a collision shape reaches 150 m from the link's origin, expected at "
     "most 100 m (lengths are in metres)"},
    {"MeshMissing", true, "<box size=\"0.2 0.3 0.1\"/>", "<mesh filename=\"a.stl\"/>",
     "robot.urdf: link 'base': mesh: no such file: a.stl"},
    {"MeshOutside", true, "<box size=\"0.2 0.3 0.1\"/>", "<mesh filename=\"/etc/passwd\"/>",
     "robot.urdf: link 'base': mesh: '/etc/passwd' is outside of the URDF's folder, the one above "
     "and those under 'packages'"},
    {"MeshOfAnUnknownPackage", true, "<box size=\"0.2 0.3 0.1\"/>",
     "<mesh filename=\"package://no_such/a.stl\"/>",
     "robot.urdf: link 'base': mesh: no folder above the URDF holds the package 'no_such' of "
     "'package://no_such/a.stl': name one under 'packages'"},
    {"MeshWithoutAName", true, "<box size=\"0.2 0.3 0.1\"/>", "<mesh filename=\"\"/>",
     "robot.urdf:4: <mesh>: expected a filename"},
    {"MeshScaleZero", true, "<box size=\"0.2 0.3 0.1\"/>",
     "<mesh filename=\"a.stl\" scale=\"1 0 1\"/>",
     "robot.urdf: link 'base': collision: mesh scale: expected no zero"},
    {"MassAndInertiaZero", true, "<link name=\"l_hip\">\n" + kInertial,
     "<link name=\"l_hip\"><inertial><mass value=\"0\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" "
     "iyy=\"0\" iyz=\"0\" izz=\"0\"/></inertial>",
     "robot.urdf: link 'l_hip': expected an inertial (only links on fixed or lumped joints may go "
     "without)"},
    {"InertialOfAnUnknownLink", false, "pelvis_link: base",
     "pelvis_link: base\ninertials: [{link: l_hop, mass: 1, com: [0, 0, 0], moments: [1, 1, 1], "
     "products: [0, 0, 0], reason: a}]",
     "robot.yaml:5: inertials[0].link: unknown link 'l_hop' (did you mean 'l_hip'?)"},
    {"InertialOfNoBody", false, "pelvis_link: base",
     "pelvis_link: base\ninertials: [{link: l_hip, mass: 1, com: [0, 0, 0], moments: [1, 1, 3], "
     "products: [0, 0, 0], reason: a}]",
     "robot.urdf: link 'l_hip': no body has this inertia: principal moment 3 exceeds the sum of "
     "the other two, 1 and 1 kg m^2"},
    {"CapsuleZero", true, "<sphere radius=\"0.05\"/>", "<capsule radius=\"0\" length=\"1\"/>",
     "robot.urdf: link 'tool': collision: expected a positive capsule radius, got 0"},
    {"PackagesNoFolder", false, "pelvis_link: base", "pelvis_link: base\npackages: [robot.urdf]",
     "robot.yaml:5: packages[0]: expected a folder, got robot.urdf"},
    {"SpeedOfAnUnknownJoint", false,
     "effort:", "velocity:\n  - {joints: [l_jaw], limit: 3, reason: a}\neffort:",
     "robot.yaml:7: velocity[0].joints[0]: unknown joint 'l_jaw' (did you mean 'l_yaw'?)"},
    {"BoxNegative", true, "0.2 0.3 0.1", "0.2 -0.3 0.1",
     "robot.urdf: link 'base': collision: expected a positive box size, got -0.3"},
    {"SphereZero", true, "radius=\"0.05\"", "radius=\"0\"",
     "robot.urdf: link 'tool': collision: expected a positive sphere radius, got 0"},
    {"GeometryUnknown", true, "<box size=\"0.2 0.3 0.1\"/>", "<cone/>",
     "robot.urdf: not a valid URDF: Unknown geometry type 'cone'; Could not parse collision "
     "element for Link [base]"},
    {"LinkTwice", true, "<link name=\"tool\">", "<link name=\"base\">",
     "robot.urdf: not a valid URDF: link 'base' is not unique"},
    {"JointTwice", true, "<joint name=\"l_roll\"", "<joint name=\"l_yaw\"",
     "robot.urdf: not a valid URDF: joint 'l_yaw' is not unique"},
    {"ParentUnknown", true, "<parent link=\"l_hip\"/>", "<parent link=\"l_hop\"/>",
     "robot.urdf: not a valid URDF: Failed to build tree: parent link [l_hop] of joint [l_roll] "
     "not found. This is not valid according to the URDF spec. Every link you refer to from a "
     "joint needs to be explicitly defined in the robot de..."},
    {"ChildUnknown", true, "<child link=\"l_thigh\"/>", "<child link=\"l_tigh\"/>",
     "robot.urdf: not a valid URDF: Failed to build tree: child link [l_tigh] of joint [l_roll] "
     "not found"},
    {"TwoParents", true, "<child link=\"l_thigh\"/>", "<child link=\"r_thigh\"/>",
     "robot.urdf: not a valid URDF: Failed to find root link: Two root links found: [base] and "
     "[l_thigh]"},
    {"TwoRoots", true, "</robot>", "<link name=\"loose\"/></robot>",
     "robot.urdf: not a valid URDF: Failed to find root link: Two root links found: [base] and "
     "[loose]"},
    {"Cycle", true, "<parent link=\"l_hip\"/>", "<parent link=\"l_foot\"/>",
     "robot.urdf: link 'l_foot' is part of a cycle"},
    {"CycleThroughTheRoot", true, "</robot>",
     "<joint name=\"back\" type=\"fixed\"><parent link=\"tool\"/><child "
     "link=\"base\"/></joint></robot>",
     "robot.urdf: not a valid URDF: Failed to find root link: No root link found. The robot xml is "
     "not a valid tree"},
    {"LowerAboveUpper", true, "lower=\"-1\"", "lower=\"2\"",
     "robot.urdf: joint 'l_yaw': expected lower < upper, got 2 and 1"},
    {"LimitNaN", true, "lower=\"-1\"", "lower=\"nan\"",
     "robot.urdf: not a valid URDF: lower value (nan) is not a valid float; Could not parse limit "
     "element for joint [l_yaw]"},
    {"LimitInfinite", true, "upper=\"1\"", "upper=\"inf\"",
     "robot.urdf: not a valid URDF: upper value (inf) is not a valid float; Could not parse limit "
     "element for joint [l_yaw]"},
    {"NoLimit", true, kYawLimit, "",
     "robot.urdf: not a valid URDF: Joint [l_yaw] is of type REVOLUTE but it does not specify "
     "limits; joint xml is not initialized correctly"},
    {"NoVelocityLimit", true, "velocity=\"5\"", "",
     "robot.urdf: not a valid URDF: joint limit: no velocity; Could not parse limit element for "
     "joint [l_yaw]"},
    {"VelocityZero", true, "velocity=\"5\"", "velocity=\"0\"",
     "robot.urdf: joint 'l_yaw': expected a positive velocity limit, got 0"},
    {"ZeroAxis", true, kYawAxis, "<axis xyz=\"0 0 0\"/>",
     "robot.urdf: joint 'l_yaw': the axis is zero"},
    {"AxisNaN", true, kYawAxis, "<axis xyz=\"0 0 nan\"/>",
     "robot.urdf: not a valid URDF: Malformed axis element for joint [l_yaw]: Unable to parse "
     "component [nan] to a double (while parsing a vector value); joint xml is not initialized "
     "correctly"},
    {"Floating", true, kYawJoint, "<joint name=\"l_yaw\" type=\"floating\">",
     "robot.urdf: joint 'l_yaw': floating joints are not supported, expected fixed, revolute, "
     "continuous or prismatic"},
    {"Planar", true, kYawJoint, "<joint name=\"l_yaw\" type=\"planar\">",
     "robot.urdf: joint 'l_yaw': planar joints are not supported, expected fixed, revolute, "
     "continuous or prismatic"},
    {"UnknownJointType", true, kYawJoint, "<joint name=\"l_yaw\" type=\"screw\">",
     "robot.urdf: not a valid URDF: Joint [l_yaw] has no known type [screw]; joint xml is not "
     "initialized correctly"},
    {"EffortOfAMimic", true, kYawLimit, kYawLimit + "<mimic joint=\"r_yaw\"/>",
     "robot.yaml:7: effort[0].joints: joint 'l_yaw' mimics 'r_yaw', whose limit counts for both"},
    {"LimbOfAMimic", true, "<axis xyz=\"1 0 0\"/>" + kYawLimit,
     "<axis xyz=\"1 0 0\"/>" + kYawLimit + "<mimic joint=\"r_roll\"/>",
     "robot.yaml:20: gaits[0].limbs[0].joints[1]: joint 'l_roll' mimics 'r_roll', expected an "
     "uncoupled joint"},
    {"ChildOfTwoJoints", true, "</robot>",
     "<joint name=\"again\" type=\"fixed\"><parent link=\"base\"/><child "
     "link=\"l_foot\"/></joint></robot>",
     "robot.urdf: link 'l_foot' is the child of two joints, 'again' and 'l_slide'"},
    {"ContinuousWithoutLimit", true, "type=\"revolute\">" + kYawRest + kYawLimit,
     "type=\"continuous\">" + kYawRest,
     "robot.urdf: joint 'l_yaw': expected a <limit> with velocity and effort"},
    {"EffortZero", true, "<axis xyz=\"1 0 0\"/>" + kYawLimit,
     "<axis xyz=\"1 0 0\"/><limit lower=\"-1\" upper=\"1\" velocity=\"5\" effort=\"0\"/>",
     "robot.yaml:1: joint 'l_roll' has no effort limit: expected a positive one in the URDF or "
     "under 'effort'"},
};

INSTANTIATE_TEST_SUITE_P(Yaml, RobotErrors, ::testing::ValuesIn(kBadYaml),
                         [](const auto& info) { return info.param.what; });
INSTANTIATE_TEST_SUITE_P(Urdf, RobotErrors, ::testing::ValuesIn(kBadUrdf),
                         [](const auto& info) { return info.param.what; });

}  // namespace
}  // namespace possibility::models
