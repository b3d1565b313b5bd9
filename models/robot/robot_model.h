#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/robot/actuator.h"
#include "models/shapes/shape.h"

namespace possibility::models {

enum class JointType { kRevolute, kContinuous, kPrismatic };

/// Mass properties of one link, including everything fixed to it.
struct Inertial {
  double mass = 0;                                 ///< kg
  Eigen::Vector3d p_LC = Eigen::Vector3d::Zero();  ///< centre of mass in the link frame, m
  Eigen::Matrix3d I_LC = Eigen::Matrix3d::Zero();  ///< about the com, link axes, kg m^2
};

struct Link {
  std::string name;
  Inertial inertial;
  std::vector<PosedShape> shapes;  ///< collision shapes, posed in the link frame
};

/// Couples a joint to another one: q = multiplier * q[joint] + offset. The master is never a mimic
/// itself: chains are composed when the robot is read.
struct Mimic {
  int joint = 0;          ///< index of the master; may be higher than the mimic's
  double multiplier = 1;  ///< finite, not 0; units of this joint per unit of the master
  double offset = 0;      ///< rad or m
};

/// Joint i moves link i + 1; link 0 is the root and floats freely.
struct Joint {
  std::string name;
  JointType type = JointType::kRevolute;
  int parent = 0;                                          ///< link index, < i + 1
  Eigen::Isometry3d X_PJ = Eigen::Isometry3d::Identity();  ///< child frame in parent at q = 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();         ///< unit, in the child frame
  double lower = 0;                                        ///< rad or m; -inf if continuous
  double upper = 0;
  double velocity = 0;  ///< rad/s or m/s
  double effort = 0;    ///< N m or N; infinite for a mimic joint, whose master's limit counts
  std::optional<Mimic> mimic;
  Actuator actuator = {};  ///< of the motor; a mimic joint has none
};

/// A part of the robot that may bear on the ground: the corner points of a sole, or the tip of a
/// peg. Forces act at the points; the outward normal (from the robot into the ground) is
/// `normal_L`.
struct ContactPatch {
  std::string name;
  int link = 0;
  std::vector<Eigen::Vector3d> points;                   ///< in the link frame, m
  Eigen::Vector3d normal_L = -Eigen::Vector3d::UnitZ();  ///< unit, link frame, into the ground
  Eigen::Vector3d Centre() const;                        ///< mean of the points, link frame
  /// Pose in the link frame: origin at the centre, z against the normal, x along the link's x, or
  /// along its y if the normal is close to x.
  Eigen::Isometry3d Frame() const;
};

/// A named whole-body posture above flat ground at z = 0 with the root at x = y = yaw = 0.
struct Posture {
  double root_height = 0;  ///< m, origin of the root link above the ground
  double root_pitch = 0;   ///< rad about +y; negative tips backward
  Eigen::VectorXd joints;  ///< num_joints, rad or m
};

/// How one limb takes part in a gait: the joints that move it and what its contact holds fixed.
struct GaitLimb {
  int contact = 0;               ///< index into RobotModel::contacts
  bool hold_orientation = true;  ///< true: pose of the patch (6 rows); false: its centre (3 rows)
  std::vector<int> joints;       ///< as many as rows; every other joint keeps its nominal value
};

/// Bounds of one stride: each limb swings once, from one nominal stance to the next. A displacement
/// (dx, dy, dyaw) in the frame of the stance is allowed while |dx|/forward + |dy|/lateral +
/// |dyaw|/turn <= 1.
struct GaitParameters {
  double forward = 0;           ///< m
  double lateral = 0;           ///< m
  double turn = 0;              ///< rad
  double clearance = 0;         ///< m, height of the swing above the ground at mid-swing
  double com_margin = 0;        ///< m, desired distance of the com from the support polygon's edge
  double swing_time = 0;        ///< s, duration of one limb's swing
  double com_acceleration = 0;  ///< m/s^2, peak; sets the duration of weight shifts
  double minimum_shift_time = 0;  ///< s
  /// rad: roll of the root over the limbs that bear while another one swings, in strides from rest
  /// to rest.
  double sway = 0;
};

/// A quasi-static gait: posture, limbs in the order in which they swing, and bounds.
struct Gait {
  std::string name;  ///< the action it belongs to: "walk", "crawl"
  Posture posture;
  std::vector<GaitLimb> limbs;
  GaitParameters parameters;
};

/// A transition between the nominal stances of two gaits. Patches that both gaits use do not move,
/// and `to` bears on every patch that `from` bears on. The reverse transition is the same motion
/// backwards in time.
struct Transition {
  std::string from;
  std::string to;
};

/// A standing long jump from the nominal stance of one gait to that of another, straight ahead.
struct Jump {
  std::string name;  ///< the action's name: "jump"
  std::string from;
  std::string to;
};

/// Immutable description of a robot: URDF + robot YAML (docs/file_formats.md).
///
/// Mimic joints have entries in q, v, a and torques like all other joints. Their q, v and a follow
/// from their masters'. Their torques act through the master: its effort limit applies to its own
/// torque plus the sum of multiplier * torque over its mimics.
///
/// Configuration q (nq = 7 + num_joints): root orientation quaternion (w, x, y, z), root position
/// (m, world), joints. Velocity v (nv = 6 + num_joints): root angular velocity, root linear
/// velocity (both expressed in the world), joint rates. Acceleration a = dv/dt.
struct RobotModel {
  std::string name;
  std::filesystem::path file;  ///< the YAML
  std::string content_hash;    ///< of the YAML and URDF bytes
  std::vector<Link> links;     ///< links[0] is the root
  std::vector<Joint> joints;   ///< parents before children
  std::vector<ContactPatch> contacts;
  std::vector<std::pair<int, int>> sagittal_pairs;      ///< joints: left, right
  std::vector<std::pair<int, int>> ignored_collisions;  ///< links, besides parent and child
  double friction = 0;
  std::vector<Gait> gaits;
  std::vector<Transition> transitions;
  std::vector<Jump> jumps;
  int pelvis_shape_link = 0;  ///< the link whose shapes alone form C_N's collision geometry

  int num_joints() const { return static_cast<int>(joints.size()); }
  int num_links() const { return static_cast<int>(links.size()); }
  int nq() const { return 7 + num_joints(); }
  int nv() const { return 6 + num_joints(); }
  double TotalMass() const;
  /// Whether the joint mimics another one or is mimicked.
  bool IsCoupled(int joint) const;
  /// The joints of the limbs of the first gait, without mimic joints, in the tree's order.
  std::vector<int> LegJoints() const;
  /// Index by name. @throws InputError naming the nearest known name.
  int LinkIndex(const std::string& name) const;
  int JointIndex(const std::string& name) const;
  int ContactIndex(const std::string& name) const;
  const Gait& GaitNamed(const std::string& name) const;
  /// q of a posture with the root at (x, y, yaw) over ground at height z.
  Eigen::VectorXd Configuration(const Posture& posture, double x = 0, double y = 0, double yaw = 0,
                                double z = 0) const;
};

}  // namespace possibility::models
