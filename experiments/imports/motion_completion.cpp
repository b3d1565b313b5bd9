#include "experiments/imports/motion_completion.h"

#include <fmt/format.h>

#include <algorithm>

#include "actions/plan/contact_name.h"
#include "experiments/imports/knot_completion.h"
#include "experiments/imports/sample_rates.h"
#include "experiments/samples/quantities.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using dynamics::ContactPoint;
using Eigen::VectorXd;

constexpr double kOnGround = 1e-3;    // m, as the verifier tolerates
constexpr double kLeastShare = 0.05;  // of the force of a point that lifts or has just come down
constexpr double kExactJump = 1e-6;   // likewise, of velocities that the file has
constexpr double kLargestRate = 1e6;

class MotionCompletion {
 public:
  MotionCompletion(const ImportedTrajectory& trajectory, const models::RobotModel& robot,
                   const models::GroundMap& ground)
      : trajectory_(trajectory),
        robot_(robot),
        ground_(ground),
        all_points_(AllContactPoints(robot)),
        kinematics_(robot),
        completion_(robot),
        phases_(CutIntoPhases(trajectory)),
        rates_(RatesOf(trajectory)),
        impulses_(phases_.size(), Eigen::Matrix3Xd(3, 0)) {}

  std::vector<actions::Segment> Complete(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < phases_.size(); ++i) JoinVelocities(i);
    if (!trajectory_.has_velocities()) LetPointsRest();
    std::vector<actions::Segment> segments;
    int segment = -1;
    for (std::size_t i = 0; i < phases_.size(); ++i) {
      if (phases_[i].segment != segment) {
        segment = phases_[i].segment;
        segments.push_back({names[segment], {}});
      }
      segments.back().phases.push_back(CompletePhase(i));
    }
    return segments;
  }

 private:
  const ImportedSample& Sample(int i) const { return trajectory_.samples[i]; }

  std::vector<ContactPoint> Points(const std::vector<bool>& bears, const VectorXd& q) {
    kinematics_.SetPosition(q);
    std::vector<ContactPoint> points;
    for (std::size_t i = 0; i < all_points_.size(); ++i) {
      if (!bears[i]) continue;
      const actions::BearingPoint& point = all_points_[i];
      const models::GroundPlane ground = GroundAt(kinematics_.Position(point.link, point.p_L));
      points.push_back({point.link, point.p_L, ground.normal, ground.friction});
    }
    return points;
  }

  /// The ground at a point; level where there is none.
  models::GroundPlane GroundAt(const Eigen::Vector3d& p) const {
    const std::vector<int> planes =
        ground_.PlanesAt(p.head<2>(), p.z() - kOnGround, p.z() + kOnGround);
    return planes.empty() ? models::GroundPlane() : ground_.planes()[planes.front()];
  }

  /// Whether a point bears in phase `i` that did not in the phase before.
  bool TouchesDown(std::size_t i) const {
    for (std::size_t k = 0; k < all_points_.size(); ++k) {
      if (phases_[i].bears[k] && !phases_[i - 1].bears[k]) return true;
    }
    return false;
  }

  /// Where phase `i` begins with a sample of its own at the time at which the phase before ends:
  /// one velocity for both, or an impact.
  void JoinVelocities(std::size_t i) {
    if (i == 0) return;
    const int before = phases_[i - 1].samples.back();
    const int after = phases_[i].samples.front();
    if (before == after) return;
    const bool is_given = trajectory_.has_velocities();
    const double jump = (rates_.v[after] - rates_.v[before]).cwiseAbs().maxCoeff();
    const auto points = Points(phases_[i].bears, Sample(after).q);
    // Differences of coarse samples jump without an impact; only landings from flight are sure.
    const bool may_hit = is_given ? jump > kExactJump : !phases_[i - 1].AnyBears();
    if (may_hit && TouchesDown(i)) {
      if (is_given) {
        impulses_[i] =
            completion_.Impulses(Sample(after).q, rates_.v[before], rates_.v[after], points);
      } else {
        const auto landing = completion_.Land(Sample(after).q, rates_.v[before], points);
        rates_.v[after] = landing.velocity;
        impulses_[i] = landing.impulses;
      }
    } else if (!is_given) {
      rates_.v[before] = rates_.v[after] = 0.5 * (rates_.v[before] + rates_.v[after]);
    }
  }

  /// The velocities nearest to the differences at which all points rest that bear at a sample, in
  /// either phase. Where phases meet without an impact the velocity stays one.
  void LetPointsRest() {
    std::vector<std::vector<bool>> bears(trajectory_.samples.size(),
                                         std::vector<bool>(all_points_.size(), false));
    const auto add = [](const std::vector<bool>& more, std::vector<bool>* all) {
      for (std::size_t k = 0; k < more.size(); ++k) (*all)[k] = (*all)[k] || more[k];
    };
    for (const ImportedPhase& phase : phases_) {
      for (const int k : phase.samples) add(phase.bears, &bears[k]);
    }
    for (std::size_t i = 1; i < phases_.size(); ++i) {
      const int before = phases_[i - 1].samples.back();
      const int after = phases_[i].samples.front();
      if (before == after || impulses_[i].cols() > 0) continue;
      add(bears[before], &bears[after]);
      bears[before] = bears[after];
    }
    for (std::size_t k = 0; k < bears.size(); ++k) {
      rates_.v[k] = completion_.Resting(Sample(k).q, rates_.v[k], Points(bears[k], Sample(k).q));
    }
  }

  actions::Phase CompletePhase(std::size_t index) {
    const ImportedPhase& phase = phases_[index];
    actions::Phase result;
    result.contacts = ContactNames(phase.bears);
    result.impulses = impulses_[index];
    for (const int k : phase.samples) {
      actions::Knot knot;
      knot.t = Sample(k).t;
      knot.q = Sample(k).q;
      knot.v = rates_.v[k];
      const auto points = Points(phase.bears, knot.q);
      RequireRates(knot.t, knot.v, rates_.a[k]);
      knot.a = completion_.Feasible(knot.q, knot.v, rates_.a[k], points);
      RequireRates(knot.t, knot.v, knot.a);
      completion_.SetForces(points, Shares(index, knot.t), &knot);
      result.knots.push_back(std::move(knot));
    }
    // Samples may be closer in time than phases that meet tell apart.
    if (index > 0) result.knots.front().t = Sample(phases_[index - 1].samples.back()).t;
    return result;
  }

  std::vector<std::string> ContactNames(const std::vector<bool>& bears) const {
    std::vector<std::string> names;
    std::size_t k = 0;
    for (const models::ContactPatch& patch : robot_.contacts) {
      std::vector<int> points;
      for (std::size_t i = 0; i < patch.points.size(); ++i) {
        if (bears[k++]) points.push_back(static_cast<int>(i));
      }
      if (points.empty()) continue;
      const bool is_whole = points.size() == patch.points.size();
      names.push_back(is_whole ? patch.name : actions::FormatContactName(patch.name, points));
    }
    return names;
  }

  /// Points that come down take up their load over the phase, points that will lift give it up.
  std::vector<double> Shares(std::size_t index, double t) const {
    const ImportedPhase& phase = phases_[index];
    const double begin = Sample(phase.samples.front()).t;
    const double s = (t - begin) / (Sample(phase.samples.back()).t - begin);
    const double passed = s * s * (3 - 2 * s);
    std::vector<double> shares;
    for (std::size_t k = 0; k < all_points_.size(); ++k) {
      if (!phase.bears[k]) continue;
      double share = 1;
      if (index > 0 && !phases_[index - 1].bears[k]) share = passed;
      if (index + 1 < phases_.size() && !phases_[index + 1].bears[k]) share *= 1 - passed;
      shares.push_back(std::clamp(share, kLeastShare, 1.0));
    }
    return shares;
  }

  void RequireRates(double t, const VectorXd& v, const VectorXd& a) const {
    if ((v.array().abs() <= kLargestRate).all() && (a.array().abs() <= kLargestRate).all()) return;
    throw InputError(fmt::format("{}: at {} s the motion is faster than 1e6 in SI units",
                                 trajectory_.file.string(), t));
  }

  const ImportedTrajectory& trajectory_;
  const models::RobotModel& robot_;
  const models::GroundMap& ground_;
  const std::vector<actions::BearingPoint> all_points_;
  dynamics::TreeKinematics kinematics_;
  KnotCompletion completion_;
  std::vector<ImportedPhase> phases_;
  SampleRates rates_;
  std::vector<Eigen::Matrix3Xd> impulses_;  // by phase
};

}  // namespace

std::vector<actions::Segment> CompleteMotion(const ImportedTrajectory& trajectory,
                                             const std::vector<std::string>& actions,
                                             const models::RobotModel& robot,
                                             const models::GroundMap& ground) {
  return MotionCompletion(trajectory, robot, ground).Complete(actions);
}

}  // namespace possibility::experiments
