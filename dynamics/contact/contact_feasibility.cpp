#include "dynamics/contact/contact_feasibility.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "dynamics/contact/cone_forces.h"
#include "dynamics/contact/quadratic_program.h"

namespace possibility::dynamics {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kConeEdges = 32;
// Directions of the Jacobian below this fraction of the largest one count as rounding.
constexpr double kRank = 1e-10;
// A larger friction coefficient counts as a pull.
constexpr double kMostFriction = 1e3;
// Cost of an impulse relative to that of a pull.
constexpr double kImpulseWeight = 1e-6;
// Fraction of the greatest impulse; a smaller pull is rounding.
constexpr double kPull = 1e-9;

/// The least t in (lower, upper] for which `attempt` succeeds, to kMarginPrecision. It must succeed
/// at `upper`. Where it succeeds, it returns the fraction that would have been enough.
template <typename Attempt>
double LeastFraction(double lower, double upper, const Attempt& attempt) {
  while (upper - lower > kMarginPrecision * std::max(1.0, upper)) {
    const double middle = (lower + upper) / 2;
    if (const std::optional<double> enough = attempt(middle)) {
      upper = std::min(middle, *enough);
      lower = std::min(lower, upper);
    } else {
      lower = middle;
    }
  }
  return upper;
}

/// All impulses with the same effect on the robot as the given ones, as fractions of their size.
class ImpulseProblem {
 public:
  ImpulseProblem(const Eigen::Ref<const MatrixXd>& jacobian,
                 const Eigen::Ref<const Eigen::Matrix3Xd>& impulses,
                 const std::vector<ContactPoint>& points, double friction)
      : points_(points), friction_(friction), unit_(impulses.cwiseAbs().maxCoeff()) {
    if (!(unit_ > 0)) unit_ = 1;
    // J'x = J'x0 means that x and x0 agree in the range of J; Q is an orthonormal basis of that
    // range.
    Eigen::ColPivHouseholderQR<MatrixXd> factors;
    factors.setThreshold(kRank);
    factors.compute(jacobian);
    const MatrixXd Q = factors.householderQ() * MatrixXd::Identity(jacobian.rows(), factors.rank());
    const MatrixXd scaled = impulses / unit_;
    problem_.balance_loads = Q.transpose();
    problem_.balance_required =
        problem_.balance_loads * Eigen::Map<const VectorXd>(scaled.data(), scaled.size());
    problem_.bounded_loads.resize(0, jacobian.rows());
    problem_.cone_edges = kConeEdges;
    for (const ContactPoint& point : points) problem_.normals.push_back(point.normal_W);
    problem_.slopes.resize(points.size());
  }

  ImpulseFeasibility Solution() {
    ImpulseFeasibility result;
    double failed = 0;
    double fraction = 1;
    std::optional<double> enough = Attempt(fraction);
    while (!enough && friction_ * fraction < kMostFriction && friction_ > 0) {
      failed = fraction;
      fraction *= 4;
      enough = Attempt(fraction);
    }
    if (!enough) return WithLeastPull();
    result.friction_fraction = LeastFraction(failed, std::max(failed, std::min(fraction, *enough)),
                                             [this](double middle) { return Attempt(middle); });
    result.feasible = result.friction_fraction <= 1;
    result.impulses = unit_ * Reshaped(best_);
    return result;
  }

 private:
  double FrictionAt(const ContactPoint& point) const { return std::min(friction_, point.friction); }

  static Eigen::Matrix3Xd Reshaped(const VectorXd& x) {
    return Eigen::Map<const Eigen::Matrix3Xd>(x.data(), 3, x.size() / 3);
  }

  /// Keeps the impulses found and returns the fraction that they use.
  std::optional<double> Attempt(double fraction) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      problem_.slopes[i] = FrictionAt(points_[i]) * fraction;
    }
    const std::optional<VectorXd> x = SolveConeForces(problem_);
    if (!x) return std::nullopt;
    best_ = *x;
    double used = 0;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const double friction = FrictionAt(points_[i]);
      if (!(friction > 0)) return 0;
      used = std::max(used, FrictionUsed(points_[i], x->segment<3>(3 * i)) / friction);
    }
    return std::min(fraction, used);
  }

  /// Least squares of the pulls p, with n'x + p >= 0, p >= 0.
  ImpulseFeasibility WithLeastPull() const {
    const Index count = static_cast<Index>(points_.size());
    const Index n = 4 * count;
    QuadraticProgram program;
    program.H.setIdentity(n, n);
    program.H.topLeftCorner(3 * count, 3 * count) *= kImpulseWeight;
    program.g.setZero(n);
    program.E.setZero(problem_.balance_loads.rows(), n);
    program.E.leftCols(3 * count) = problem_.balance_loads;
    program.e = problem_.balance_required;
    program.C.setZero(2 * count, n);
    program.d.setZero(2 * count);
    for (Index i = 0; i < count; ++i) {
      program.C.block<1, 3>(i, 3 * i) = -points_[i].normal_W.transpose();
      program.C(i, 3 * count + i) = -1;
      program.C(count + i, 3 * count + i) = -1;
    }
    const QuadraticProgramSolution solution = Solve(program);
    ImpulseFeasibility result;
    result.friction_fraction = std::numeric_limits<double>::infinity();
    result.impulses = unit_ * Reshaped(solution.x.head(3 * count));
    Index hardest = 0;
    if (solution.x.tail(count).maxCoeff(&hardest) > kPull) {
      result.pulling_point = static_cast<int>(hardest);
    }
    return result;
  }

  const std::vector<ContactPoint>& points_;
  double friction_;
  double unit_;
  ConeForceProblem problem_;
  VectorXd best_;
};

}  // namespace

ImpulseFeasibility CheckImpulses(const Eigen::Ref<const MatrixXd>& jacobian,
                                 const Eigen::Ref<const Eigen::Matrix3Xd>& impulses,
                                 const std::vector<ContactPoint>& points, double friction) {
  const auto count = static_cast<Index>(points.size());
  const auto fail = [](const std::string& what) {
    throw std::invalid_argument("CheckImpulses: " + what);
  };
  if (jacobian.rows() != 3 * count || impulses.cols() != count) {
    fail(fmt::format("{} points, but a jacobian of {} rows and {} impulses", count, jacobian.rows(),
                     impulses.cols()));
  }
  if (!std::isfinite(jacobian.squaredNorm()))
    fail("the jacobian is not finite or so large that its square is not");
  if (!std::isfinite(impulses.squaredNorm()))
    fail("the impulses are not finite or so large that their square is not");
  if (!(friction >= 0 && std::isfinite(friction))) {
    fail(fmt::format("friction is {}, expected a number of at least 0", friction));
  }
  CheckContactPoints("CheckImpulses", std::numeric_limits<int>::max(), points);
  if (count == 0) return {true, 0, Eigen::Matrix3Xd(3, 0), std::nullopt};
  return ImpulseProblem(jacobian, impulses, points, friction).Solution();
}

ImpulseFeasibility CheckImpact(ForwardDynamics* dynamics, const Impact& impact,
                               const std::vector<ContactPoint>& points, double friction) {
  const MultibodyModel& model = dynamics->model();
  CheckContactPoints("CheckImpact", model.tree().num_links(), points);
  MatrixXd jacobian(3 * points.size(), model.nv());
  for (std::size_t i = 0; i < points.size(); ++i) {
    dynamics->dynamics()->Jacobian(points[i], jacobian.middleRows<3>(3 * i));
  }
  return CheckImpulses(jacobian, impact.impulses, points, friction);
}

std::optional<ContactMargins> ComputeContactMargins(MultibodyDynamics* dynamics,
                                                    const std::vector<ContactPoint>& points,
                                                    const ContactForceSettings& settings) {
  const std::optional<ContactForces> forces = DistributeContactForces(dynamics, points, settings);
  if (!forces) return std::nullopt;
  ContactMargins margins;
  ContactForceSettings tried = settings;
  margins.friction_fraction =
      LeastFraction(0, forces->friction_utilisation, [&](double fraction) -> std::optional<double> {
        tried.friction_margin = fraction;
        const auto found = DistributeContactForces(dynamics, points, tried);
        if (!found) return std::nullopt;
        return found->friction_utilisation;
      });
  tried = settings;
  margins.effort_fraction =
      LeastFraction(0, forces->torque_utilisation, [&](double fraction) -> std::optional<double> {
        tried.torque_margin = fraction;
        const auto found = DistributeContactForces(dynamics, points, tried);
        if (!found) return std::nullopt;
        return found->torque_utilisation;
      });
  return margins;
}

}  // namespace possibility::dynamics
