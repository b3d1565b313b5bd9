#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "actions/motion/motion_schedule.h"
#include "actions/verify/verifier.h"
#include "dynamics/tree/tree_kinematics.h"

namespace possibility::actions::testing {

/// The plan that the verifier checks, with its robot and scenario.
struct VerifierSubject {
  Plan plan;
  models::RobotModel robot;
  models::Scenario scenario;
};

inline VerificationReport Verified(const VerifierSubject& subject,
                                   const VerifierSettings& settings = {}) {
  return Verify(subject.plan, subject.robot, subject.scenario, settings);
}

/// The first violation of a kind; null if there is none.
inline const Violation* Find(const VerificationReport& report, ViolationKind kind) {
  for (const Violation& violation : report.violations) {
    if (violation.kind == kind) return &violation;
  }
  return nullptr;
}

/// A change that makes any valid plan invalid, and the violation that the verifier must find.
struct PlanMutation {
  std::string name;
  std::function<void(VerifierSubject*)> apply;
  ViolationKind expected;
};

inline void PrintTo(const PlanMutation& mutation, std::ostream* stream) {
  *stream << mutation.name;
}

inline std::vector<Phase*> PhasesOf(Plan* plan) {
  std::vector<Phase*> phases;
  for (Segment& segment : plan->segments) {
    for (Phase& phase : segment.phases) phases.push_back(&phase);
  }
  return phases;
}

inline std::vector<Knot*> KnotsOf(Plan* plan) {
  std::vector<Knot*> knots;
  for (Phase* phase : PhasesOf(plan)) {
    for (Knot& knot : phase->knots) knots.push_back(&knot);
  }
  return knots;
}

inline Phase& FirstPhase(VerifierSubject* subject) {
  return subject->plan.segments.front().phases.front();
}

inline Knot& MiddleKnot(Phase* phase) { return phase->knots[phase->knots.size() / 2]; }

inline void ShiftTimes(double offset, std::size_t first_phase, Plan* plan) {
  const std::vector<Phase*> phases = PhasesOf(plan);
  for (std::size_t i = first_phase; i < phases.size(); ++i) {
    for (Knot& knot : phases[i]->knots) knot.t += offset;
  }
}

/// Leaves the path as it is and executes it `factor` times as fast.
inline void SpeedUp(double factor, Plan* plan) {
  for (Knot* knot : KnotsOf(plan)) {
    knot->t /= factor;
    knot->v *= factor;
    knot->a *= factor * factor;
  }
}

/// A change of the contact schedule that the motion follows.
inline std::function<void(VerifierSubject*)> Scheduled(
    const std::function<void(models::ContactSchedule*)>& change) {
  return [change](VerifierSubject* subject) {
    subject->plan.schedule = ScheduleOfMotion(subject->robot, subject->plan.segments);
    change(&*subject->plan.schedule);
  };
}

/// The first contact bears where it bears at first until it swings.
inline void MoveAlong(models::ContactSchedule* schedule) {
  const auto& first = schedule->intervals.front().bearing.front();
  for (models::ContactInterval& interval : schedule->intervals) {
    if (!interval.bearing.front()) return;
    interval.bearing.front() = first;
  }
}

/// The joint for which `use(knot, j)` is greatest over the plan, and that value.
inline std::pair<int, double> MostUsed(VerifierSubject* subject,
                                       const std::function<double(const Knot&, int)>& use) {
  std::pair<int, double> most(0, -std::numeric_limits<double>::infinity());
  for (const Knot* knot : KnotsOf(&subject->plan)) {
    for (int j = 0; j < subject->robot.num_joints(); ++j) {
      if (use(*knot, j) > most.second) most = {j, use(*knot, j)};
    }
  }
  return most;
}

inline double LargestFrictionUsed(VerifierSubject* subject) {
  double most = 0;
  for (const Knot* knot : KnotsOf(&subject->plan)) {
    for (Eigen::Index i = 0; i < knot->forces.cols(); ++i) {
      const Eigen::Vector3d force = knot->forces.col(i);
      if (force.z() > 10) most = std::max(most, force.head<2>().norm() / force.z());
    }
  }
  return most;
}

/// A cube of 2 cm at the middle of the root link, where that is half-way through the first phase.
inline void AddBar(VerifierSubject* subject) {
  dynamics::TreeKinematics kinematics(subject->robot);
  kinematics.SetPosition(MiddleKnot(&FirstPhase(subject)).q);
  const models::PosedShape& shape = subject->robot.links.front().shapes.front();
  models::Obstacle bar;
  bar.name = "bar";
  bar.shape = models::Shape::Box(Eigen::Vector3d::Constant(0.02));
  bar.X_WO.translation() = kinematics.Position(0, shape.X_PS.translation());
  subject->scenario.environment.obstacles.push_back(bar);
}

/// Turns the first joint between the root and the first patch at one knot. The patch slides by
/// millimetres and back.
inline void SlideContact(VerifierSubject* subject) {
  Phase& phase = FirstPhase(subject);
  const int patch = subject->robot.ContactIndex(phase.contacts.front());
  int link = subject->robot.contacts[patch].link;
  while (subject->robot.joints[link - 1].parent != 0) {
    link = subject->robot.joints[link - 1].parent;
  }
  MiddleKnot(&phase).q[6 + link] += 0.05;
}

inline void DropPatch(VerifierSubject* subject) {
  Phase& phase = FirstPhase(subject);
  const int patch = subject->robot.ContactIndex(phase.contacts.front());
  const auto num_points = static_cast<Eigen::Index>(subject->robot.contacts[patch].points.size());
  phase.contacts.erase(phase.contacts.begin());
  for (Knot& knot : phase.knots) {
    knot.forces = knot.forces.rightCols(knot.forces.cols() - num_points).eval();
  }
}

/// Two corners of a sole pull and two push as much more. The wrench stays the same, but the ground
/// cannot pull.
inline void MakeCornersPull(VerifierSubject* subject) {
  Phase& phase = FirstPhase(subject);
  for (Knot& knot : phase.knots) {
    const double extra = knot.forces.row(2).leftCols<4>().maxCoeff() + 1;
    for (int i = 0; i < 4; ++i) knot.forces(2, i) += i % 2 == 0 ? extra : -extra;
  }
}

inline void GrowHand(VerifierSubject* subject) {
  models::PosedShape ball;
  ball.shape = models::Shape::Sphere(0.5);
  subject->robot.links.back().shapes.push_back(ball);
}

inline void MoveGround(const Eigen::Vector3d& offset, VerifierSubject* subject) {
  for (models::Obstacle& obstacle : subject->scenario.environment.obstacles) {
    if (obstacle.is_ground) obstacle.X_WO.translation() += offset;
  }
}

inline void RemoveFirstSegment(VerifierSubject* subject) {
  Plan& plan = subject->plan;
  plan.segments.erase(plan.segments.begin());
  ShiftTimes(-plan.segments.front().phases.front().knots.front().t, 0, &plan);
}

inline void LimitJointPosition(VerifierSubject* subject) {
  const auto [joint, largest] =
      MostUsed(subject, [](const Knot& knot, int j) { return knot.q[7 + j]; });
  subject->robot.joints[joint].upper = largest - 1e-5;
}

inline void ExceedSpeed(VerifierSubject* subject) {
  const models::RobotModel& robot = subject->robot;
  const double used = MostUsed(subject, [&](const Knot& knot, int j) {
                        return std::abs(knot.v[6 + j]) / robot.joints[j].velocity;
                      }).second;
  SpeedUp(1.01 / used, &subject->plan);
}

inline void WeakenJoint(VerifierSubject* subject) {
  const auto [joint, largest] =
      MostUsed(subject, [](const Knot& knot, int j) { return std::abs(knot.tau[j]); });
  subject->robot.joints[joint].effort = 0.999 * largest;
}

/// Makes the last joint a mimic of the one before it. The plan obeys the coupling.
inline void CoupleLastJoint(VerifierSubject* subject) {
  const int mimic = subject->robot.num_joints() - 1;
  subject->robot.joints[mimic].mimic = models::Mimic{mimic - 1, -0.5, 0.1};
  for (Knot* knot : KnotsOf(&subject->plan)) {
    knot->q[7 + mimic] = 0.1 - 0.5 * knot->q[6 + mimic];
    knot->v[6 + mimic] = -0.5 * knot->v[5 + mimic];
    knot->a[6 + mimic] = -0.5 * knot->a[5 + mimic];
  }
}

/// Makes the last joint a mimic that strays from its master at one knot.
inline std::function<void(VerifierSubject*)> Uncouple(double dq, double dv, double da) {
  return [=](VerifierSubject* subject) {
    CoupleLastJoint(subject);
    Knot& knot = MiddleKnot(&FirstPhase(subject));
    knot.q[knot.q.size() - 1] += dq;
    knot.v[knot.v.size() - 1] += dv;
    knot.a[knot.a.size() - 1] += da;
  };
}

/// The plan must have at least two segments. Its first phase must have two bearing patches, the
/// first of them a rectangle. Robot and scenario are those of the plan.
inline std::vector<PlanMutation> PlanMutations() {
  using Subject = VerifierSubject;
  using Kind = ViolationKind;
  return {
      {"OtherRobot", [](Subject* s) { s->robot.content_hash += "0"; }, Kind::kFileMismatch},
      {"OtherScenario", [](Subject* s) { s->scenario.content_hash += "0"; }, Kind::kFileMismatch},

      {"ScenarioOfAnotherRobot", [](Subject* s) { s->scenario.robot_hash = "another"; },
       Kind::kFileMismatch},

      {"Levitates", [](Subject* s) { s->plan.segments.back().action = "levitate"; }, Kind::kAction},
      {"NameWithMarkup", [](Subject* s) { s->plan.segments.front().action = "<b>"; },
       Kind::kAction},
      {"NameIsAPath", [](Subject* s) { s->plan.segments.front().action = "../../walk"; },
       Kind::kAction},
      {"NameWithAZero",
       [](Subject* s) { s->plan.segments.front().action = std::string("walk\0", 5); },
       Kind::kAction},
      {"ActionNotAllowed",
       [](Subject* s) {
         s->scenario.actions = {"crawl", "jump"};
       },
       Kind::kAction},
      {"TransitionTheRobotHasNot",
       [](Subject* s) { s->plan.segments.back().action = "walk->walk"; }, Kind::kAction},
      {"BoundsTooNarrow",
       [](Subject* s) { s->scenario.environment.bounds.max().x() = s->scenario.start.x - 0.16; },
       Kind::kBounds},

      {"NoSegments", [](Subject* s) { s->plan.segments.clear(); }, Kind::kStructure},
      {"EmptySegment", [](Subject* s) { s->plan.segments.back().phases.clear(); },
       Kind::kStructure},
      {"SingleKnot", [](Subject* s) { FirstPhase(s).knots.resize(1); }, Kind::kStructure},
      {"UnknownContact", [](Subject* s) { FirstPhase(s).contacts[0] = "tail"; }, Kind::kStructure},
      {"ContactTwice", [](Subject* s) { FirstPhase(s).contacts[0] = FirstPhase(s).contacts[1]; },
       Kind::kStructure},
      {"ForceMissing",
       [](Subject* s) { MiddleKnot(&FirstPhase(s)).forces.conservativeResize(3, 1); },
       Kind::kStructure},
      {"NotFinite", [](Subject* s) { MiddleKnot(&FirstPhase(s)).a[3] = std::nan(""); },
       Kind::kStructure},
      {"TimeReversed",
       [](Subject* s) { std::reverse(FirstPhase(s).knots.begin(), FirstPhase(s).knots.end()); },
       Kind::kStructure},
      {"TimeGap", [](Subject* s) { ShiftTimes(1e-6, 1, &s->plan); }, Kind::kStructure},
      {"TimeStartsLate", [](Subject* s) { ShiftTimes(0.1, 0, &s->plan); }, Kind::kStructure},
      {"SegmentCutOut", [](Subject* s) { s->plan.segments.erase(s->plan.segments.begin()); },
       Kind::kStructure},
      {"OtherJoints", [](Subject* s) { std::swap(s->plan.joints[0], s->plan.joints[1]); },
       Kind::kStructure},
      {"QuaternionTooLong", [](Subject* s) { FirstPhase(s).knots[1].q.head<4>() *= 1.001; },
       Kind::kStructure},

      {"StartElsewhere", [](Subject* s) { s->scenario.start.x += 0.002; }, Kind::kStart},
      {"StartTurned", [](Subject* s) { s->scenario.start.yaw += 0.002; }, Kind::kStart},
      {"StartHigher", [](Subject* s) { s->scenario.start.z += 0.002; }, Kind::kStart},
      {"StartMoving", [](Subject* s) { FirstPhase(s).knots.front().v[4] += 1e-4; }, Kind::kStart},
      {"StartByOtherGait", [](Subject* s) { s->scenario.start.action = "crawl"; }, Kind::kStart},
      {"FirstSegmentLost", RemoveFirstSegment, Kind::kStart},
      {"GoalElsewhere", [](Subject* s) { s->scenario.goals[s->plan.goal].y += 0.002; },
       Kind::kGoal},
      {"GoalTurned", [](Subject* s) { s->scenario.goals[s->plan.goal].yaw -= 0.002; }, Kind::kGoal},
      {"NoSuchGoal", [](Subject* s) { s->plan.goal = 7; }, Kind::kGoal},
      {"GoalTruncated", [](Subject* s) { s->plan.segments.back().phases.back().knots.pop_back(); },
       Kind::kGoal},

      {"PositionJumps",
       [](Subject* s) {
         for (Knot& knot : PhasesOf(&s->plan)[1]->knots) knot.q[7] += 1e-5;
       },
       Kind::kPositionContinuity},
      {"RootJumps",
       [](Subject* s) {
         for (Knot& knot : PhasesOf(&s->plan)[1]->knots) knot.q[5] += 1e-5;
       },
       Kind::kPositionContinuity},
      {"VelocityJumps", [](Subject* s) { PhasesOf(&s->plan)[1]->knots.front().v[6] += 1e-4; },
       Kind::kVelocityContinuity},

      {"JointBeyondLimit", LimitJointPosition, Kind::kJointPosition},
      {"JointSpiked", [](Subject* s) { MiddleKnot(&FirstPhase(s)).q[7] += 4; },
       Kind::kJointPosition},
      {"TooFast", ExceedSpeed, Kind::kJointSpeed},
      {"TooWeak", WeakenJoint, Kind::kJointTorque},

      {"MimicMisplaced", Uncouple(1e-5, 0, 0), Kind::kJointCoupling},
      {"MimicTooFast", Uncouple(0, 1e-5, 0), Kind::kJointCoupling},
      {"MimicPushed", Uncouple(0, 0, 1e-2), Kind::kJointCoupling},

      {"FootSlides", SlideContact, Kind::kContactMotion},
      {"ScheduleOfOtherPlaces", Scheduled([](models::ContactSchedule* schedule) {
         schedule->intervals.front().bearing.front()->translation().x() += 0.002;
         MoveAlong(schedule);
       }),
       Kind::kSchedule},
      {"ScheduleOfOtherHeadings", Scheduled([](models::ContactSchedule* schedule) {
         schedule->intervals.front().bearing.front()->rotate(
             Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitZ()));
         MoveAlong(schedule);
       }),
       Kind::kSchedule},
      {"ScheduleOfOtherTimes", Scheduled([](models::ContactSchedule* schedule) {
         schedule->intervals.front().duration += 0.01;
       }),
       Kind::kSchedule},
      {"ScheduleOfFewerContacts", Scheduled([](models::ContactSchedule* schedule) {
         for (models::ContactInterval& interval : schedule->intervals)
           interval.bearing.front().reset();
       }),
       Kind::kSchedule},
      {"ScheduleOfNothing",
       Scheduled([](models::ContactSchedule* schedule) { schedule->intervals.clear(); }),
       Kind::kSchedule},
      {"GroundSunk",
       [](Subject* s) {
         MoveGround({0, 0, -0.005}, s);
       },
       Kind::kContactGround},
      {"GroundGone",
       [](Subject* s) {
         MoveGround({1000, 0, 0}, s);
       },
       Kind::kContactGround},
      {"GroundRaised",
       [](Subject* s) {
         MoveGround({0, 0, 0.005}, s);
       },
       Kind::kPenetration},
      {"ThroughABar", AddBar, Kind::kPenetration},
      {"HandInBody", GrowHand, Kind::kSelfCollision},

      {"TorqueScaled", [](Subject* s) { MiddleKnot(&FirstPhase(s)).tau *= 1.001; },
       Kind::kDynamics},
      {"ForcesScaled", [](Subject* s) { MiddleKnot(&FirstPhase(s)).forces *= 1.001; },
       Kind::kDynamics},
      {"AccelerationOff", [](Subject* s) { MiddleKnot(&FirstPhase(s)).a[5] += 0.01; },
       Kind::kDynamics},
      {"PatchUnlisted", DropPatch, Kind::kDynamics},
      {"Heavier", [](Subject* s) { s->robot.links[0].inertial.mass += 0.1; }, Kind::kDynamics},
      {"Slippery", [](Subject* s) { s->robot.friction = 0.5 * LargestFrictionUsed(s); },
       Kind::kFriction},
      {"CornersPull", MakeCornersPull, Kind::kFriction},
  };
}

}  // namespace possibility::actions::testing
