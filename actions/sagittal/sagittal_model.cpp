#include "actions/sagittal/sagittal_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "dynamics/tree/multibody_dynamics.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using dynamics::ContactPoint;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::set<int> JointsOfLimbs(const models::Gait& gait) {
  std::set<int> joints;
  for (const models::GaitLimb& limb : gait.limbs)
    joints.insert(limb.joints.begin(), limb.joints.end());
  return joints;
}

/// `launch` with every joint outside the limbs of both gaits as in `landing`.
VectorXd Ready(const NominalStance& launch, const NominalStance& landing) {
  std::set<int> moved = JointsOfLimbs(*launch.gait);
  moved.merge(JointsOfLimbs(*landing.gait));
  VectorXd q = launch.q;
  for (int joint = 0; joint < q.size() - 7; ++joint) {
    if (!moved.contains(joint)) q[7 + joint] = landing.q[7 + joint];
  }
  return q;
}

bool Bears(const models::Gait& gait, const std::string& patch, const models::RobotModel& robot) {
  return std::any_of(gait.limbs.begin(), gait.limbs.end(), [&](const models::GaitLimb& limb) {
    return robot.contacts[limb.contact].name == patch;
  });
}

Eigen::AlignedBox3d BoundsOf(const models::Link& link) {
  Eigen::AlignedBox3d box;
  for (const models::PosedShape& posed : link.shapes) box.extend(posed.shape.Bounds(posed.X_PS));
  return box;
}

/// The links that a joint carries, and those that carry it, including the root.
std::set<int> LimbOf(const models::RobotModel& robot, int joint) {
  std::set<int> limb = {0};
  for (int link = joint + 1; link > 0; link = robot.joints[link - 1].parent) limb.insert(link);
  for (int carried = joint + 2; carried < robot.num_links(); ++carried) {
    for (int link = carried; link > 0; link = robot.joints[link - 1].parent) {
      if (link == joint + 1) limb.insert(carried);
    }
  }
  return limb;
}

/// Radius of a link's shapes around a joint, at the end of the link.
double HousingRadius(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return 0;
  const double x = std::max(std::abs(box.min().x()), std::abs(box.max().x()));
  const double z = std::min(std::abs(box.min().z()), std::abs(box.max().z()));
  return std::hypot(x, z);
}

}  // namespace

SagittalModel::SagittalModel(const models::RobotModel& robot, const NominalStance& launch,
                             const NominalStance& landing)
    : reduction_(robot, VectorXd(landing.q.tail(robot.num_joints()))) {
  // Stances are symmetric up to the error of their solver.
  constexpr double kSymmetry = 1e-6;
  ready_ = reduction_.ReduceConfiguration(Ready(launch, landing), kSymmetry);
  landed_ = reduction_.ReduceConfiguration(landing.q, kSymmetry);
  FindContacts(robot, *launch.gait, *landing.gait);
  leg_ = LimbTo({heel_.link, Vector3d::Zero()});
  for (const ContactPoint& hand : hands_) {
    arms_.push_back(LimbTo(hand));
    peg_ends_.push_back(PegEnd(hand));
  }
  FindGuards();
  FindSeparations();
  FindFreeRanges(robot);
}

Vector2d SagittalModel::Position(const ContactPoint& point, const VectorXd& q) const {
  dynamics::MultibodyDynamics dynamics(planar());
  dynamics.SetState(q, VectorXd::Zero(planar()->nv()));
  const Vector3d p = dynamics.Position(point);
  return {p.x(), p.z()};
}

void SagittalModel::FindContacts(const models::RobotModel& robot, const models::Gait& launch,
                                 const models::Gait& landing) {
  std::vector<ContactPoint> feet;
  for (const models::ContactPatch& patch : planar()->tree().contacts) {
    const bool launches = Bears(launch, patch.name, robot);
    if (launches && !Bears(landing, patch.name, robot)) {
      throw InputError(fmt::format("{}: gaits: a jump from {} to {} must land on {}, too",
                                   robot.file.string(), launch.name, landing.name, patch.name));
    }
    if (!launches && !Bears(landing, patch.name, robot)) continue;
    for (const Vector3d& p_L : patch.points) {
      (launches ? feet : hands_).push_back({patch.link, p_L});
    }
  }
  if (feet.size() != 2) {
    throw InputError(
        fmt::format("{}: gaits: a jump from {} needs one pair of flat feet, which bear on a line "
                    "from heel to toe in the sagittal plane",
                    robot.file.string(), launch.name));
  }
  std::sort(feet.begin(), feet.end(), [this](const ContactPoint& a, const ContactPoint& b) {
    return Position(a, ready_).x() < Position(b, ready_).x();
  });
  heel_ = feet[0];
  toe_ = feet[1];
}

SagittalModel::Ball SagittalModel::PegEnd(const ContactPoint& hand) const {
  constexpr double kSame = 1e-3;  // m
  for (const models::PosedShape& posed : planar()->tree().links[hand.link].shapes) {
    if (posed.shape.type != models::ShapeType::kCapsule) continue;
    for (const double end : {-posed.shape.length / 2, posed.shape.length / 2}) {
      const Vector3d centre = posed.X_PS * Vector3d(0, 0, end);
      const Eigen::Vector2d reach(hand.p_L.x() - centre.x(), hand.p_L.z() - centre.z());
      if (std::abs(reach.norm() - posed.shape.radius) < kSame) {
        return {{hand.link, {centre.x(), 0, centre.z()}}, posed.shape.radius};
      }
    }
  }
  return {hand, 0};
}

SagittalModel::Limb SagittalModel::LimbTo(const ContactPoint& tip) const {
  const models::RobotModel& tree = planar()->tree();
  Limb limb;
  limb.tip = tip;
  limb.length = tip.p_L.norm();
  for (int link = tip.link; link > 0; link = tree.joints[link - 1].parent) {
    limb.root = {link, Vector3d::Zero()};
    const models::Joint& joint = tree.joints[link - 1];
    if (joint.parent > 0) limb.length += joint.X_PJ.translation().norm();
  }
  return limb;
}

void SagittalModel::FindSeparations() {
  constexpr double kMargin = 0.015;  // m
  const models::RobotModel& tree = planar()->tree();
  const auto bounds = [&tree](int link) {
    Eigen::AlignedBox3d box;
    for (const models::PosedShape& posed : tree.links[link].shapes) {
      box.extend(posed.shape.Bounds(posed.X_PS));
    }
    return box;
  };
  const Eigen::AlignedBox3d trunk = bounds(0);
  const Eigen::AlignedBox3d foot = bounds(heel_.link);
  if (trunk.isEmpty() || foot.isEmpty()) return;
  // Balls as thick as the trunk fill it from the root up; a ball about the ankle contains the foot.
  const double radius = trunk.sizes().x() / 2;
  const double distance = radius + foot.sizes().x() / 2 + kMargin;
  const double top = trunk.max().z() - radius;
  const int count = 2 + static_cast<int>(std::max(top, 0.0) / radius);
  for (int i = 0; i < count; ++i) {
    const Vector3d centre(trunk.center().x(), 0, top * i / (count - 1));
    separations_.push_back({{0, centre}, {heel_.link, Vector3d::Zero()}, distance});
  }
}

void SagittalModel::FindFreeRanges(const models::RobotModel& robot) {
  const SelfClearance clearance(
      robot, {reduction_.ExpandConfiguration(ready_), reduction_.ExpandConfiguration(landed_)});
  lower_ = planar()->lower();
  upper_ = planar()->upper();
  for (int joint = 0; joint < planar()->num_joints(); ++joint) {
    for (const VectorXd& stance : {ready_, landed_}) {
      lower_[joint] =
          std::max(lower_[joint], FreeLimit(clearance, stance, joint, planar()->lower()[joint]));
      upper_[joint] =
          std::min(upper_[joint], FreeLimit(clearance, stance, joint, planar()->upper()[joint]));
    }
  }
}

/// Position that `joint` can reach from `q` towards `limit`.
double SagittalModel::FreeLimit(const SelfClearance& clearance, const VectorXd& q, int joint,
                                double limit) const {
  constexpr double kStep = 0.05;        // rad
  constexpr double kResolution = 1e-3;  // rad
  const models::RobotModel& robot = reduction_.full();
  const std::set<int> limb = LimbOf(robot, reduction_.joints()[joint].left);
  const auto is_free = [&](double position) {
    VectorXd moved = q;
    moved[3 + joint] = position;
    const auto faults = clearance.Faults(reduction_.ExpandConfiguration(moved), kSelfClearance);
    return std::none_of(faults.begin(), faults.end(), [&limb](const SelfClearance::Fault& fault) {
      return limb.contains(fault.pair.link) && limb.contains(fault.pair.other);
    });
  };
  double reached = q[3 + joint];
  double step = std::copysign(kStep, limit - reached);
  while (std::abs(step) >= kResolution && reached != limit) {
    const double next = std::abs(limit - reached) > std::abs(step) ? reached + step : limit;
    if (is_free(next)) {
      reached = next;
    } else {
      step /= 2;
    }
  }
  return reached;
}

void SagittalModel::FindGuards() {
  const models::RobotModel& tree = planar()->tree();
  const std::set<int> bearing = [this] {
    std::set<int> links = {heel_.link};
    for (const ContactPoint& hand : hands_) links.insert(hand.link);
    return links;
  }();
  const auto guard_corners = [this, &tree](int link) {
    const Eigen::AlignedBox3d box = BoundsOf(tree.links[link]);
    if (box.isEmpty()) return;
    for (const double x : {box.min().x(), box.max().x()}) {
      for (const double z : {box.min().z(), box.max().z()}) {
        guards_.push_back({{link, {x, 0, z}}, 0});
      }
    }
  };
  std::set<int> carrying;
  for (const models::Joint& joint : tree.joints) carrying.insert(joint.parent);
  guard_corners(0);
  for (int link = 1; link < tree.num_links(); ++link) {
    if (bearing.contains(link)) continue;
    guards_.push_back({{link, Vector3d::Zero()}, HousingRadius(BoundsOf(tree.links[link]))});
    // The end of a limb that does not bear, such as the hand of a robot that lands on its feet.
    if (!carrying.contains(link)) guard_corners(link);
  }
  // Guards the end of the forearm (the hand's origin) and the side of the hand opposite its peg.
  for (const ContactPoint& hand : hands_) {
    const Eigen::AlignedBox3d box = BoundsOf(tree.links[hand.link]);
    guards_.push_back({{hand.link, Vector3d::Zero()}, 0});
    if (box.isEmpty()) continue;
    const double thickness = std::max(-box.min().x(), box.max().x());
    guards_.back().radius = thickness;
    const double far = hand.p_L.z() > 0 ? box.min().z() : box.max().z();
    guards_.push_back({{hand.link, {box.center().x(), 0, far}}, thickness});
    middle_guards_.push_back({{hand.link, {box.center().x(), 0, far / 2}}, thickness});
    const models::Joint& wrist = tree.joints[hand.link - 1];
    if (wrist.parent == 0) continue;
    const Vector3d half = wrist.X_PJ.translation() / 2;
    middle_guards_.push_back(
        {{wrist.parent, half}, HousingRadius(BoundsOf(tree.links[wrist.parent]))});
  }
}

}  // namespace possibility::actions
