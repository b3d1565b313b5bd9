#pragma once

#include <cstddef>
#include <vector>

#include "actions/plan.h"
#include "models/robot_model.h"

namespace possibility::experiments {

/// Of the knots listed (ascending), those that a picture needs: whatever lies between two of them
/// is within a millimetre of the root's position, two milliradians of a joint and a hundredth of
/// the limits of speed and torque (a two-hundredth of the weight, of forces) of the line between
/// the two. The first and last one are always among them.
std::vector<std::size_t> KnotsToDraw(const models::RobotModel& robot, const actions::Phase& phase,
                                     const std::vector<std::size_t>& knots);

}  // namespace possibility::experiments
