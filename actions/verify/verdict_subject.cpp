#include "actions/verify/verdict_subject.h"

#include "models/input/byte_text.h"

namespace possibility::actions {
namespace {

using models::ByteText;

void AddKnot(const Knot& knot, ByteText* text) {
  text->Add(knot.t).Add(knot.q).Add(knot.v).Add(knot.a).Add(knot.tau).Add(knot.forces);
}

void AddPhase(const Phase& phase, ByteText* text) {
  text->Add(phase.contacts.size());
  for (const std::string& contact : phase.contacts) text->Add(std::string_view(contact));
  text->Add(phase.impulses).Add(phase.knots.size());
  for (const Knot& knot : phase.knots) AddKnot(knot, text);
}

void AddContacts(const PhaseContacts& contacts, ByteText* text) {
  text->Add(contacts.points.size());
  for (const BearingPoint& point : contacts.points) {
    text->Add(point.patch).Add(point.index).Add(point.link).Add(point.p_L);
  }
  text->Add(contacts.anchors).Add(contacts.normals).Add(contacts.friction).Add(contacts.lands);
}

void AddFlight(const std::optional<Flight>& flight, ByteText* text) {
  text->Add(flight.has_value());
  if (!flight) return;
  text->Add(flight->start).Add(flight->position).Add(flight->velocity);
  text->Add(flight->angular_momentum);
}

}  // namespace

std::string SubjectOf(const KnotRun& run, const models::RobotModel& robot, double resolution,
                      int plan_version) {
  ByteText text;
  text.Add(std::string_view(robot.content_hash)).Add(resolution).Add(plan_version);
  AddContacts(run.contacts, &text);
  AddFlight(run.flight, &text);
  for (std::size_t i = run.begin; i <= run.end; ++i) AddKnot(run.phase.knots[i], &text);
  return text.Take();
}

std::string SubjectOf(const DynamicStretch& stretch, const models::RobotModel& robot) {
  ByteText text;
  text.Add(std::string_view(robot.content_hash)).Add(stretch.motion.phases.size());
  for (const Phase& phase : stretch.motion.phases) AddPhase(phase, &text);
  return text.Take();
}

std::string SubjectOf(const Phase& phase, const models::RobotModel& robot) {
  ByteText text;
  text.Add(std::string_view(robot.content_hash));
  AddPhase(phase, &text);
  return text.Take();
}

}  // namespace possibility::actions
