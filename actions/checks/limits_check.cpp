#include "actions/checks/limits_check.h"

#include <algorithm>
#include <cmath>

#include "actions/evidence/bounded_maximum.h"
#include "models/robot/mimic_joints.h"
#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

constexpr double kPositionTolerance = 1e-6;        // rad or m
constexpr double kSpeedTolerance = 1e-6;           // rad/s or m/s
constexpr double kRelativeTorqueTolerance = 1e-6;  // of the limit
constexpr double kAccuracy = 1e-10;                // of extrema, relative if above 1
constexpr double kRootAccuracy = 1e-6;             // of the root's speeds, likewise

// The effect of rounded positions grows with the inverse square of the time between knots, at least
// 1 ms.
constexpr double kAccelerationTolerance = 1e-3;  // rad/s^2 or m/s^2

struct Units {
  const char* position;
  const char* speed;
  const char* acceleration;
  const char* torque;
};

Units UnitsOf(const models::Joint& joint) {
  if (joint.type == models::JointType::kPrismatic) return {"m", "m/s", "m/s^2", "N"};
  return {"rad", "rad/s", "rad/s^2", "N m"};
}

/// One polynomial.
template <int Columns>
struct SignedRow {
  ControlPolygon<1, Columns> polygon;

  double Front() const { return polygon.points[0]; }
  double Back() const { return polygon.points[Columns - 1]; }
  double Bound() const { return polygon.points.maxCoeff(); }
  void Halve(SignedRow* first, SignedRow* second) const {
    polygon.Halve(&first->polygon, &second->polygon);
  }
};

/// The length of a vector.
template <int Columns>
struct Length {
  ControlPolygon<3, Columns> polygon;

  double Front() const { return polygon.front().norm(); }
  double Back() const { return polygon.back().norm(); }
  double Bound() const { return polygon.points.colwise().norm().maxCoeff(); }
  void Halve(Length* first, Length* second) const {
    polygon.Halve(&first->polygon, &second->polygon);
  }
};

/// The angular speed |J(phi) phi-dot|. J changes by at most half of the change of phi, since it is
/// the mean of exp(s [phi]) over s from 0 to 1.
struct AngularSpeed {
  ControlPolygon<3, 6> phi;
  ControlPolygon<3, 5> rate;

  double Front() const { return (models::LeftJacobian(phi.front()) * rate.front()).norm(); }
  double Back() const { return (models::LeftJacobian(phi.back()) * rate.back()).norm(); }
  double Bound() const {
    const double longest = rate.points.colwise().norm().maxCoeff();
    const Eigen::Vector3d middle = (phi.front() + phi.back()) / 2;
    const double strays = (phi.points.colwise() - middle).colwise().norm().maxCoeff();
    const double turned = (models::LeftJacobian(middle) * rate.points).colwise().norm().maxCoeff();
    return std::min(longest, turned + strays * longest / 2);
  }
  void Halve(AngularSpeed* first, AngularSpeed* second) const {
    phi.Halve(&first->phi, &second->phi);
    rate.Halve(&first->rate, &second->rate);
  }
};

/// Checks of one interval between two knots.
class IntervalCheck {
 public:
  IntervalCheck(const KnotInterpolant& interpolant, int segment, ViolationLog* log)
      : interpolant_(interpolant), segment_(segment), log_(log) {
    position_.points = interpolant.ControlPoints();
    velocity_ = position_.Rate(interpolant.duration());
  }

  const ControlPolygon<Eigen::Dynamic, 6>& position() const { return position_; }
  const ControlPolygon<Eigen::Dynamic, 5>& velocity() const { return velocity_; }
  ControlPolygon<Eigen::Dynamic, 4> Acceleration() const {
    return velocity_.Rate(interpolant_.duration());
  }

  template <typename Piece, typename Name>
  bool RequireAtMost(ViolationKind kind, const Piece& piece, double accuracy, double limit,
                     double tolerance, const char* unit, Name&& name) const {
    const Maximum most = BoundedMaximum<Piece>(piece, limit + tolerance, accuracy).best();
    return log_->RequireAtMost(kind, At(most), most.value, limit, tolerance, unit,
                               std::forward<Name>(name));
  }

  /// Requires a row to be at most `limit`.
  template <int Columns, typename Name>
  bool RequireRow(ViolationKind kind, const Eigen::Matrix<double, 1, Columns>& row, double limit,
                  double tolerance, const char* unit, Name&& name) const {
    if (row.maxCoeff() <= limit + tolerance) return true;
    return RequireAtMost(kind, SignedRow<Columns>{{row}}, kAccuracy, limit, tolerance, unit,
                         std::forward<Name>(name));
  }

  /// The same for the magnitude of a row.
  template <int Columns, typename Name>
  bool RequireMagnitude(ViolationKind kind, const Eigen::Matrix<double, 1, Columns>& row,
                        double limit, double tolerance, const char* unit, Name&& name) const {
    const bool above = RequireRow<Columns>(kind, row, limit, tolerance, unit, name);
    const bool below = RequireRow<Columns>(kind, -row, limit, tolerance, unit, name);
    return above && below;
  }

  /// Requires a row to be at least `limit`.
  template <typename Name>
  void RequireAtLeast(ViolationKind kind, const Eigen::Matrix<double, 1, 6>& row, double limit,
                      double tolerance, const char* unit, Name&& name) const {
    if (row.minCoeff() >= limit - tolerance) return;
    const Maximum least =
        BoundedMaximum<SignedRow<6>>({{-row}}, tolerance - limit, kAccuracy).best();
    log_->RequireAtLeast(kind, At(least), -least.value, limit, tolerance, unit,
                         std::forward<Name>(name));
  }

 private:
  Instant At(const Maximum& maximum) const {
    return {segment_, interpolant_.start() + maximum.place * interpolant_.duration()};
  }

  const KnotInterpolant& interpolant_;
  int segment_;
  ViolationLog* log_;
  ControlPolygon<Eigen::Dynamic, 6> position_;
  ControlPolygon<Eigen::Dynamic, 5> velocity_;
};

bool CheckRootSpeed(const IntervalCheck& check) {
  AngularSpeed turning;
  turning.phi.points = check.position().points.topRows<3>();
  turning.rate.points = check.velocity().points.topRows<3>();
  Length<5> moving;
  moving.polygon.points = check.velocity().points.middleRows<3>(3);
  const bool turns = check.RequireAtMost(ViolationKind::kJointSpeed, turning, kRootAccuracy,
                                         kLargestRootSpeed, kSpeedTolerance, "rad/s",
                                         [] { return std::string("root angular speed"); });
  const bool moves =
      check.RequireAtMost(ViolationKind::kJointSpeed, moving, kRootAccuracy, kLargestRootSpeed,
                          kSpeedTolerance, "m/s", [] { return std::string("root speed"); });
  return turns && moves;
}

}  // namespace

bool CheckJointLimits(const KnotInterpolant& interpolant, const models::RobotModel& robot,
                      int segment, ViolationLog* log) {
  const IntervalCheck check(interpolant, segment, log);
  bool slow = CheckRootSpeed(check);
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    const Units units = UnitsOf(joint);
    const Eigen::Matrix<double, 1, 6> q = check.position().points.row(6 + j);
    check.RequireRow<6>(ViolationKind::kJointPosition, q, joint.upper, kPositionTolerance,
                        units.position, [&] { return joint.name + " above its upper limit"; });
    check.RequireAtLeast(ViolationKind::kJointPosition, q, joint.lower, kPositionTolerance,
                         units.position, [&] { return joint.name + " below its lower limit"; });
    slow = check.RequireMagnitude<5>(ViolationKind::kJointSpeed, check.velocity().points.row(6 + j),
                                     joint.velocity, kSpeedTolerance, units.speed,
                                     [&] { return joint.name + " speed"; }) &&
           slow;
  }
  return slow;
}

void CheckJointCouplings(const KnotInterpolant& interpolant, const models::RobotModel& robot,
                         int segment, ViolationLog* log) {
  const bool any = std::any_of(robot.joints.begin(), robot.joints.end(),
                               [](const models::Joint& joint) { return joint.mimic.has_value(); });
  if (!any) return;
  const IntervalCheck check(interpolant, segment, log);
  const auto acceleration = check.Acceleration();
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    if (!joint.mimic) continue;
    const int master = joint.mimic->joint;
    const double multiplier = joint.mimic->multiplier;
    const double scale = std::max(1.0, std::abs(multiplier));
    const Units units = UnitsOf(joint);
    const auto require = [&]<int Columns>(const ControlPolygon<Eigen::Dynamic, Columns>& polygon,
                                          double offset, double tolerance, const char* unit,
                                          const char* what) {
      const Eigen::Matrix<double, 1, Columns> row =
          (polygon.points.row(6 + j) - multiplier * polygon.points.row(6 + master)).array() -
          offset;
      check.RequireMagnitude<Columns>(
          ViolationKind::kJointCoupling, row, 0, scale * tolerance, unit,
          [&] { return joint.name + what + " off that of " + robot.joints[master].name; });
    };
    require(check.position(), joint.mimic->offset, kPositionTolerance, units.position, " position");
    require(check.velocity(), 0, kSpeedTolerance, units.speed, " speed");
    require(acceleration, 0, kAccelerationTolerance, units.acceleration, " acceleration");
  }
}

void CheckTorqueLimits(const Eigen::VectorXd& tau, const Eigen::VectorXd& v,
                       const models::RobotModel& robot, const Instant& at, ViolationLog* log) {
  const Eigen::VectorXd borne = models::MotorTorques(robot, tau);
  for (int j = 0; j < robot.num_joints(); ++j) {
    const models::Joint& joint = robot.joints[j];
    if (joint.mimic) continue;
    const double tolerance = kRelativeTorqueTolerance * std::max(joint.effort, 1.0);
    const double limit = joint.actuator.Limit(joint.effort, borne[j], v[6 + j]);
    log->RequireAtMost(ViolationKind::kJointTorque, at, std::abs(borne[j]), limit, tolerance,
                       UnitsOf(joint).torque, [&] { return joint.name + " torque"; });
  }
}

}  // namespace possibility::actions
