#include "actions/spatial/separating_planes.h"

#include "actions/spatial/core_corners.h"
#include "dynamics/tree/base_joints.h"
#include "dynamics/tree/tree_kinematics.h"
#include "models/shapes/signed_distance.h"

namespace possibility::actions {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using models::PosedShape;
using models::PreparedShape;

/// A shape of a link: corners (of the core, link frame) swept with a ball.
struct Body {
  Body(const PosedShape& posed, int on_link) : shape(posed.shape), X_LS(posed.X_PS), link(on_link) {
    for (const Vector3d& corner : CoreCorners(posed.shape)) corners.push_back(posed.X_PS * corner);
  }

  PreparedShape shape;
  Isometry3d X_LS;
  int link = 0;
  std::vector<Vector3d> corners;
};

/// The farthest of the body's corners along `n_L`, without the ball.
Vector3d Support(const Body& body, const Vector3d& n_L) {
  Vector3d best = body.corners.front();
  for (const Vector3d& corner : body.corners) {
    if (n_L.dot(corner) > n_L.dot(best)) best = corner;
  }
  return best;
}

dynamics::ContactPoint PointOn(const Body& body, const Vector3d& p_L) {
  return {body.link + dynamics::kNumBaseJoints, p_L};
}

}  // namespace

std::vector<collocation::Separation> SeparatingPlanes(const models::RobotModel& robot,
                                                      const Eigen::VectorXd& q, int link, int other,
                                                      double within, double clearance,
                                                      int interval) {
  dynamics::TreeKinematics kinematics(robot);
  kinematics.SetPosition(q);
  std::vector<collocation::Separation> separations;
  for (const PosedShape& first : robot.links[link].shapes) {
    for (const PosedShape& second : robot.links[other].shapes) {
      Body carrier(first, link);
      Body kept(second, other);
      if (carrier.corners.size() < kept.corners.size()) std::swap(carrier, kept);
      const auto pose = [&](const Body& body) {
        return body.shape.CorePose(kinematics.X_WL()[body.link] * body.X_LS);
      };
      const models::SeparatingPlane plane =
          Separate(carrier.shape, pose(carrier), kept.shape, pose(kept));
      if (plane.distance >= within) continue;
      const Vector3d normal_L = carrier.X_LS.linear() * plane.normal_A;
      const Vector3d origin = Support(carrier, normal_L);
      const double height = carrier.shape.radius() + kept.shape.radius() + clearance;
      for (const Vector3d& corner : kept.corners) {
        separations.push_back(
            {{PointOn(kept, corner), PointOn(carrier, origin), normal_L}, height, interval});
      }
    }
  }
  return separations;
}

}  // namespace possibility::actions
