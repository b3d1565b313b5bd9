#include "actions/conditions/motion_job.h"

#include <utility>

#include "actions/wholebody/motion_collision.h"
#include "actions/wholebody/motion_error.h"
#include "common/cancellation_token.h"

namespace possibility::actions {

MotionJob::MotionJob(const Manoeuvre& manoeuvre,
                     std::shared_ptr<const models::CollisionChecker> checker, graph::Edge edge)
    : manoeuvre_(manoeuvre), checker_(std::move(checker)), edge_(std::move(edge)) {}

graph::JobVerdict MotionJob::Run(graph::JobControl* control) {
  const CancellationToken cancellation = control->token();
  std::vector<Phase> motion;
  try {
    if (!manoeuvre_.Prepare(edge_, control)) return graph::JobVerdict::kUndecided;
    motion = manoeuvre_.Motion(edge_, cancellation);
  } catch (const Cancelled&) {
    return graph::JobVerdict::kUndecided;
  } catch (const MotionError& error) {
    return Decide(error.what());
  }
  if (manoeuvre_.TestsItsMotions()) return Decide({});
  const models::RobotModel& robot = *manoeuvre_.model().robot;
  std::string hit = FirstSelfHit(robot, *checker_, motion, cancellation);
  if (hit.empty()) {
    hit = FirstHit(robot, *manoeuvre_.world().environment, *checker_, motion, cancellation);
  }
  return cancellation.Proceed() ? Decide(hit) : graph::JobVerdict::kUndecided;
}

graph::JobVerdict MotionJob::Decide(const std::string& fault) {
  reason_ = fault;
  return fault.empty() ? graph::JobVerdict::kConfirmed : graph::JobVerdict::kRefuted;
}

}  // namespace possibility::actions
