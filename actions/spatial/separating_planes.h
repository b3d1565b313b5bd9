#pragma once

#include <Eigen/Core>
#include <vector>

#include "collocation/robot/contact_sequence.h"
#include "models/robot/robot_model.h"

namespace possibility::actions {

/// Planes that keep two links apart: for each pair of their shapes that is closer than `within` (m)
/// at q, the plane between them there. It moves with the shape of more corners; all corners of the
/// other one stay `clearance` (m) beyond it. That is sufficient at any other q, too, though not
/// necessary. `q`: nq. Links and points are those of MultibodyModel::OnJoints.
std::vector<collocation::Separation> SeparatingPlanes(const models::RobotModel& robot,
                                                      const Eigen::VectorXd& q, int link, int other,
                                                      double within, double clearance,
                                                      int interval);

}  // namespace possibility::actions
