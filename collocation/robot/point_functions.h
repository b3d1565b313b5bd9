#pragma once

#include "collocation/robot/multibody_functions.h"

namespace possibility::collocation {

/// Components of points. Inputs: q.
std::shared_ptr<Function> PointPositions(const RobotSystem& model,
                                         const std::vector<PointComponent>& components);
/// Of all components of each point: x, z in the plane, x, y, z in space. The same below.
std::shared_ptr<Function> PointPositions(const RobotSystem& model,
                                         const std::vector<dynamics::ContactPoint>& points);

/// The squared distance of two points of the system, m^2. Inputs: q.
std::shared_ptr<Function> SquaredDistance(const RobotSystem& model,
                                          const dynamics::ContactPoint& from,
                                          const dynamics::ContactPoint& to);

/// A point, and a plane that moves with another link.
struct PointOverPlane {
  dynamics::ContactPoint point;
  dynamics::ContactPoint origin;                        ///< on the plane
  Eigen::Vector3d normal_L = Eigen::Vector3d::UnitZ();  ///< unit, frame of the plane's link
};

/// Height of each point over its plane, m. Inputs: q.
std::shared_ptr<Function> HeightsOverPlanes(const RobotSystem& model,
                                            const std::vector<PointOverPlane>& pairs);

/// Components of velocities. Inputs: q, v.
std::shared_ptr<Function> PointVelocities(const RobotSystem& model,
                                          const std::vector<PointComponent>& components);
std::shared_ptr<Function> PointVelocities(const RobotSystem& model,
                                          const std::vector<dynamics::ContactPoint>& points);

/// Components of accelerations. Inputs: q, v, a.
std::shared_ptr<Function> PointAccelerations(const RobotSystem& model,
                                             const std::vector<PointComponent>& components);
std::shared_ptr<Function> PointAccelerations(const RobotSystem& model,
                                             const std::vector<dynamics::ContactPoint>& points);

}  // namespace possibility::collocation
