#include "models/robot/shape_reach.h"

#include <fmt/format.h>

#include "models/input/input_error.h"

namespace possibility::models {

void RequireShapesInReach(const std::filesystem::path& file, const RobotModel& robot) {
  for (const Link& link : robot.links) {
    for (const PosedShape& posed : link.shapes) {
      const Eigen::AlignedBox3d bounds = posed.shape.Bounds(posed.X_PS);
      const double reach = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs()).maxCoeff();
      if (reach <= kFarthestOfShapes) continue;
      throw InputError(
          fmt::format("{}: link '{}': a collision shape reaches {:.4g} m from the link's origin, "
                      "expected at most {:.0f} m (lengths are in metres)",
                      file.string(), link.name, reach, kFarthestOfShapes));
    }
  }
}

}  // namespace possibility::models
