#include "actions/refinement/plan_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "actions/checks/forces_check.h"
#include "actions/evidence/verifier_state.h"
#include "actions/plan/packed_phase.h"
#include "actions/refinement/momentum_motion.h"
#include "actions/refinement/root_offset.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

// Of accelerations. On the ground 1e-3 m/s^2, for which the contact forces make up; in flight
// 3.8e-6 m/s^2, since nothing does.
constexpr int kBitsOnTheGround = 10;
constexpr int kBitsInFlight = 18;
constexpr double kForceStep = 2e-7;  // of the weight
constexpr double kSamePlace = 1e-7;  // m, rad: phases follow each other
constexpr double kSameRate = 1e-6;   // m/s, rad/s

/// Bits of the largest power of two that is at most kForceStep of the weight.
int ForceBits(const models::RobotModel& robot) {
  const double weight = robot.TotalMass() * dynamics::kGravity;
  const int bits = static_cast<int>(std::ceil(-std::log2(kForceStep * weight)));
  return std::clamp(bits, kFewestPackedBits, kMostPackedBits);
}

template <typename Numbers>
void RoundToBits(int bits, Numbers* numbers) {
  for (double& number : numbers->reshaped()) {
    // Not -0, which the integers of a file do not have.
    number = std::ldexp(std::nearbyint(std::ldexp(number, bits)), -bits) + 0.0;
  }
}

bool IsSameState(const Knot& k0, const Knot& k1) {
  return k0.q.size() == k1.q.size() && k0.v.size() == k1.v.size() &&
         (k0.q - k1.q).cwiseAbs().maxCoeff() <= kSamePlace &&
         (k0.v - k1.v).cwiseAbs().maxCoeff() <= kSameRate;
}

class Refinement {
 public:
  Refinement(const models::RobotModel& robot, int force_bits)
      : robot_(robot), force_bits_(force_bits), momentum_(robot), evaluator_(robot) {}

  /// Refines the phases of a plan, in their order.
  void Refine(Phase* phase) {
    CheckSizes(*phase);
    const Knot last_as_planned = phase->knots.back();
    const bool is_unsupported = momentum_.IsNeeded(*phase);
    const RootOffset offset = Continue(phase);
    if (is_unsupported) {
      momentum_.Follow(offset, phase);
    } else if (was_unsupported_) {
      LeadBack(offset, phase);
    }
    phase->acceleration_bits = is_unsupported ? kBitsInFlight : kBitsOnTheGround;
    const std::vector<Knot> guide = phase->knots;
    for (Knot& knot : phase->knots) knot.tau.setZero(robot_.num_joints());
    RoundToPackedSteps(force_bits_, before_ ? &*before_ : nullptr, phase);
    for (std::size_t k = 0; k < guide.size(); ++k) {
      phase->knots[k].forces = guide[k].forces;
    }
    SetForces(phase);
    Remember(*phase, last_as_planned);
    was_unsupported_ = is_unsupported;
  }

 private:
  void CheckSizes(const Phase& phase) const {
    const auto points = static_cast<Eigen::Index>(BearingPoints(robot_, phase).size());
    const bool fits = phase.knots.size() >= 2 &&
                      std::all_of(phase.knots.begin(), phase.knots.end(), [&](const Knot& knot) {
                        return knot.q.size() == robot_.nq() && knot.v.size() == robot_.nv() &&
                               knot.a.size() == robot_.nv() && knot.forces.cols() == points;
                      });
    if (!fits) throw std::invalid_argument("the knots of a phase do not fit the robot");
  }

  /// Lets the phase begin where the one before ends now. The offset of its root from the plan.
  RootOffset Continue(Phase* phase) const {
    if (!before_) return {};
    Knot& first = phase->knots.front();
    const Knot& before = before_->knots.back();
    Knot joined = first;
    joined.v = as_planned_.v;
    if (!IsSameState(joined, as_planned_)) return {};
    const RootOffset offset = OffsetBetween(as_planned_, before);
    const bool is_continuous = IsSameState(first, as_planned_);
    if (!was_unsupported_ && is_continuous) {
      first.q = before.q;
      first.v = before.v;
      return {};
    }
    // Only the joints: the root follows by the offset.
    const Eigen::Index n = robot_.num_joints();
    first.q.tail(n) += before.q.tail(n) - as_planned_.q.tail(n);
    first.v.tail(n) += before.v.tail(n) - as_planned_.v.tail(n);
    return offset;
  }

  static void LeadBack(const RootOffset& offset, Phase* phase) {
    const double start = phase->knots.front().t;
    const double duration = phase->knots.back().t - start;
    for (Knot& knot : phase->knots) {
      knot = Moved(knot, Faded(offset, duration, (knot.t - start) / duration));
    }
  }

  void SetForces(Phase* phase) {
    const std::vector<BearingPoint> points = BearingPoints(robot_, *phase);
    for (Knot& knot : phase->knots) {
      VerifierState state = evaluator_.Evaluate(knot);
      knot.forces = RealiseForces(state, points, robot_, evaluator_.dynamics()).forces;
      RoundToBits(force_bits_, &knot.forces);
      state.knot.forces = knot.forces;
      knot.tau = RealiseForces(state, points, robot_, evaluator_.dynamics()).torques;
    }
  }

  void Remember(const Phase& phase, const Knot& last_as_planned) {
    before_.emplace();
    before_->knots.assign(phase.knots.end() - 2, phase.knots.end());
    before_->acceleration_bits = phase.acceleration_bits;
    as_planned_ = last_as_planned;
  }

  const models::RobotModel& robot_;
  int force_bits_;
  MomentumMotion momentum_;
  StateEvaluator evaluator_;
  std::optional<Phase> before_;  ///< its last two knots, refined
  Knot as_planned_;              ///< its last knot in the plan
  bool was_unsupported_ = false;
};

}  // namespace

Plan RefinedPlan(const Plan& plan, const models::RobotModel& robot) {
  if (plan.version == 2) return plan;
  Plan refined = plan;
  refined.version = 2;
  refined.force_bits = ForceBits(robot);
  Refinement refinement(robot, refined.force_bits);
  for (Segment& segment : refined.segments) {
    for (Phase& phase : segment.phases) refinement.Refine(&phase);
  }
  return refined;
}

}  // namespace possibility::actions
