#include "actions/refinement/momentum_motion.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "actions/plan/interpolation.h"
#include "actions/refinement/unsupported_motion.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions {
namespace {

constexpr int kMostHalvings = 4;      // of the interval between two knots
constexpr int kSubsteps = 8;          // of the integration between two knots
constexpr double kUnsupplied = 2e-7;  // of the weight: leaves room for rounding below 1e-6
constexpr double kTestedPlaces[] = {0.25, 0.5, 0.75};

}  // namespace

/// The plan between two knots or a part of it, at the beginnings, middles and ends of substeps.
struct MomentumMotion::Course {
  double step() const { return (end - begin) / kSubsteps; }
  /// `half_steps`: 0 to 2 x kSubsteps.
  Knot At(int half_steps) const {
    if (half_steps == 2 * kSubsteps) return plan->At(end);
    return plan->At(begin + (end - begin) * half_steps / (2 * kSubsteps));
  }

  const KnotInterpolant* plan;
  double begin;  ///< s
  double end;    ///< s
};

MomentumMotion::MomentumMotion(const models::RobotModel& robot)
    : robot_(robot), evaluator_(robot) {}

bool MomentumMotion::IsNeeded(const Phase& phase) {
  const std::vector<BearingPoint> points = BearingPoints(robot_, phase);
  return UnsupportedMotions(evaluator_.Evaluate(phase.knots.front()), points).cols() > 0;
}

/// The offset's acceleration with which nothing is left along the unsupported motions.
Vector6d MomentumMotion::Acceleration(const Knot& plan, const RootOffset& offset) {
  RootOffset at_rest = offset;
  at_rest.acceleration.setZero();
  const VerifierState state = evaluator_.Evaluate(Moved(plan, at_rest));
  const auto motions = UnsupportedMotions(state, points_);
  const Eigen::VectorXd left = UnsupportedForces(motions, state, evaluator_.dynamics());
  const Eigen::Matrix<double, 6, 6> inertia =
      evaluator_.dynamics().MassMatrix().topLeftCorner<6, 6>();
  const Eigen::MatrixXd along = motions.transpose() * inertia * motions;
  return OffsetAcceleration(offset, -motions * along.llt().solve(left));
}

/// Runge-Kutta, fourth order. `offsets`: at the ends of all substeps, the beginning first.
void MomentumMotion::Integrate(const Course& course, const RootOffset& begin,
                               std::vector<RootOffset>* offsets) {
  const double h = course.step();
  offsets->assign(1, begin);
  offsets->back().acceleration = Acceleration(course.At(0), begin);
  for (int i = 0; i < kSubsteps; ++i) {
    const RootOffset& x = offsets->back();
    const Knot middle = course.At(2 * i + 1);
    const Knot end = course.At(2 * i + 2);
    const Vector6d r1 = x.rate;
    const Vector6d a1 = x.acceleration;
    const Vector6d r2 = x.rate + h / 2 * a1;
    const Vector6d a2 = Acceleration(middle, {x.value + h / 2 * r1, r2, {}});
    const Vector6d r3 = x.rate + h / 2 * a2;
    const Vector6d a3 = Acceleration(middle, {x.value + h / 2 * r2, r3, {}});
    const Vector6d r4 = x.rate + h * a3;
    const Vector6d a4 = Acceleration(end, {x.value + h * r3, r4, {}});
    RootOffset next;
    next.value = x.value + h / 6 * (r1 + 2 * r2 + 2 * r3 + r4);
    next.rate = x.rate + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    next.acceleration = Acceleration(end, next);
    offsets->push_back(next);
  }
}

bool MomentumMotion::IsExact(const Knot& k0, const Knot& k1) {
  const KnotInterpolant interpolant(k0, k1);
  const double weight = robot_.TotalMass() * dynamics::kGravity;
  return std::all_of(std::begin(kTestedPlaces), std::end(kTestedPlaces), [&](double s) {
    const VerifierState state =
        evaluator_.Evaluate(interpolant.At(k0.t + s * interpolant.duration()));
    const Eigen::VectorXd left =
        UnsupportedForces(UnsupportedMotions(state, points_), state, evaluator_.dynamics());
    return left.norm() <= kUnsupplied * weight;
  });
}

/// Appends as few of the substeps' ends as are needed; false if all of them are too few.
bool MomentumMotion::AddKnots(const Course& course, const std::vector<RootOffset>& offsets,
                              std::vector<Knot>* knots) {
  for (int stride = kSubsteps; stride >= 1; stride /= 2) {
    std::vector<Knot> chosen = {knots->back()};
    for (int i = stride; i <= kSubsteps; i += stride) {
      chosen.push_back(Moved(course.At(2 * i), offsets[i]));
    }
    bool is_exact = true;
    for (std::size_t i = 1; i < chosen.size() && is_exact; ++i) {
      is_exact = IsExact(chosen[i - 1], chosen[i]);
    }
    if (!is_exact) continue;
    knots->insert(knots->end(), chosen.begin() + 1, chosen.end());
    return true;
  }
  return false;
}

/// Appends the knots after the first. The offset at the end.
RootOffset MomentumMotion::FollowCourse(const Course& course, const RootOffset& begin, int halvings,
                                        std::vector<Knot>* knots) {
  std::vector<RootOffset> offsets;
  Integrate(course, begin, &offsets);
  if (knots->empty()) knots->push_back(Moved(course.At(0), offsets.front()));
  if (AddKnots(course, offsets, knots)) return offsets.back();
  if (halvings == 0 || is_hopeless_) {
    is_hopeless_ = true;
    knots->push_back(Moved(course.At(2 * kSubsteps), offsets.back()));  // the verifier decides
    return offsets.back();
  }
  const double middle = (course.begin + course.end) / 2;
  const RootOffset half =
      FollowCourse({course.plan, course.begin, middle}, begin, halvings - 1, knots);
  return FollowCourse({course.plan, middle, course.end}, half, halvings - 1, knots);
}

void MomentumMotion::Follow(const RootOffset& offset, Phase* phase) {
  points_ = BearingPoints(robot_, *phase);
  is_hopeless_ = false;
  std::vector<Knot> knots;
  RootOffset last = offset;
  for (std::size_t k = 0; k + 1 < phase->knots.size(); ++k) {
    const KnotInterpolant plan(phase->knots[k], phase->knots[k + 1]);
    last = FollowCourse({&plan, phase->knots[k].t, phase->knots[k + 1].t}, last, kMostHalvings,
                        &knots);
  }
  phase->knots = std::move(knots);
}

}  // namespace possibility::actions
