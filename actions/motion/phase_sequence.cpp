#include "actions/motion/phase_sequence.h"

#include <utility>

namespace possibility::actions {

void ShiftTime(double offset, std::vector<Phase>* phases) {
  for (Phase& phase : *phases) {
    for (Knot& knot : phase.knots) knot.t += offset;
  }
}

void Append(Phase phase, std::vector<Phase>* motion) {
  std::vector<Phase> one = {std::move(phase)};
  if (!motion->empty()) ShiftTime(motion->back().knots.back().t, &one);
  motion->push_back(std::move(one.front()));
}

std::vector<Phase> Placed(std::vector<Phase> phases, const PlanarPose& stance, double z) {
  const Eigen::Isometry3d X = stance.At(z);
  const Eigen::Quaterniond turn(X.linear());
  for (Phase& phase : phases) {
    phase.impulses = X.linear() * phase.impulses;
    for (Knot& knot : phase.knots) {
      const Eigen::Quaterniond R =
          turn * Eigen::Quaterniond(knot.q[0], knot.q[1], knot.q[2], knot.q[3]);
      knot.q.head<4>() << R.w(), R.vec();
      knot.q.segment<3>(4) = X * Eigen::Vector3d(knot.q.segment<3>(4));
      for (const int i : {0, 3}) {
        knot.v.segment<3>(i) = X.linear() * knot.v.segment<3>(i).eval();
        knot.a.segment<3>(i) = X.linear() * knot.a.segment<3>(i).eval();
      }
      knot.forces = X.linear() * knot.forces;
    }
  }
  return phases;
}

}  // namespace possibility::actions
