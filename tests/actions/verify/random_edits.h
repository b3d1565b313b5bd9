#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "actions/checks/forces_check.h"
#include "actions/plan/contact_name.h"
#include "actions/plan/interpolation.h"
#include "tests/actions/plan_mutations.h"

namespace possibility::actions::testing {

/// Random changes of a plan, from ones that leave it valid to ones that no robot can follow. Half
/// of the plans get the torques and forces of the new motion, as a forger would.
class RandomEdits {
 public:
  explicit RandomEdits(unsigned seed) : generator_(seed) {}

  /// Changes the subject in one to three ways and returns their names.
  std::string Apply(VerifierSubject* subject) {
    std::string names;
    const int edits = 1 + static_cast<int>(Below(3));
    for (int i = 0; i < edits; ++i) names += ApplyOne(subject) + " ";
    if (Below(2) == 0) {
      Repair(subject);
      names += "repaired";
    }
    return names;
  }

 private:
  using Edit = std::pair<const char*, void (RandomEdits::*)(VerifierSubject*)>;

  std::string ApplyOne(VerifierSubject* subject) {
    static const std::vector<Edit> edits = {
        {"RemoveKnots", &RandomEdits::RemoveKnots},
        {"KeepEnds", &RandomEdits::KeepEnds},
        {"AddKnot", &RandomEdits::AddKnot},
        {"Squeeze", &RandomEdits::Squeeze},
        {"ScaleTime", &RandomEdits::ScaleTime},
        {"ScaleTimesAlone", &RandomEdits::ScaleTimesAlone},
        {"MoveCoordinate", &RandomEdits::MoveCoordinate},
        {"MovePhase", &RandomEdits::MovePhase},
        {"Creep", &RandomEdits::Creep},
        {"Glide", &RandomEdits::Glide},
        {"ChangeRate", &RandomEdits::ChangeRate},
        {"ChangeAcceleration", &RandomEdits::ChangeAcceleration},
        {"ChangeForce", &RandomEdits::ChangeForce},
        {"ChangeContacts", &RandomEdits::ChangeContacts},
        {"ChangeImpulses", &RandomEdits::ChangeImpulses},
        {"SplitPhase", &RandomEdits::SplitPhase},
        {"CutSegment", &RandomEdits::CutSegment},
        {"MergePhases", &RandomEdits::MergePhases},
    };
    const Edit& edit = edits[Below(edits.size())];
    (this->*edit.second)(subject);
    return edit.first;
  }

  std::size_t Below(std::size_t n) { return generator_() % n; }

  /// A number of either sign, from far below every tolerance to far beyond.
  double Magnitude(double least, double most) {
    std::uniform_real_distribution<double> exponent(std::log(least), std::log(most));
    const double magnitude = std::exp(exponent(generator_));
    return Below(2) == 0 ? magnitude : -magnitude;
  }

  Phase& AnyPhase(VerifierSubject* subject) {
    const std::vector<Phase*> phases = PhasesOf(&subject->plan);
    return *phases[Below(phases.size())];
  }

  Knot& AnyKnot(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    return phase.knots[Below(phase.knots.size())];
  }

  void RemoveKnots(VerifierSubject* subject) {
    std::vector<Knot>& knots = AnyPhase(subject).knots;
    const std::size_t first = 1 + Below(knots.size());
    const std::size_t last = std::min(first + 1 + Below(6), knots.size() - 1);
    if (first < last) {
      knots.erase(knots.begin() + static_cast<long>(first),
                  knots.begin() + static_cast<long>(last));
    }
  }

  /// Keeps only the ends of a phase and gives it a random duration.
  void KeepEnds(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    phase.knots = {phase.knots.front(), phase.knots.back()};
    Retime(&phase, std::abs(Magnitude(1e-6, 0.5)), subject);
  }

  void AddKnot(VerifierSubject* subject) {
    std::vector<Knot>& knots = AnyPhase(subject).knots;
    const std::size_t i = Below(knots.size() - 1);
    const double s = std::uniform_real_distribution<double>(0.001, 0.999)(generator_);
    const Knot knot =
        Interpolate(knots[i], knots[i + 1], (1 - s) * knots[i].t + s * knots[i + 1].t);
    if (knot.t > knots[i].t && knot.t < knots[i + 1].t) {
      knots.insert(knots.begin() + static_cast<long>(i) + 1, knot);
    }
  }

  /// Changes the duration of one phase and shifts the later ones. Nothing else is adapted.
  static void Retime(Phase* phase, double duration, VerifierSubject* subject) {
    const double start = phase->knots.front().t;
    const double before = phase->knots.back().t - start;
    bool follows = false;
    for (Phase* other : PhasesOf(&subject->plan)) {
      for (Knot& knot : other->knots) {
        if (other == phase) knot.t = start + (knot.t - start) * duration / before;
        if (follows) knot.t += duration - before;
      }
      follows = follows || other == phase;
    }
  }

  void ScaleTimesAlone(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    const double duration = phase.knots.back().t - phase.knots.front().t;
    Retime(&phase, duration * std::exp(Magnitude(1e-9, 3)), subject);
  }

  void ScaleTime(VerifierSubject* subject) {
    SpeedUp(std::exp(Magnitude(1e-9, 2)), &subject->plan);
  }

  /// Shortens the time between two knots, possibly to nearly nothing.
  void Squeeze(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    const std::size_t i = Below(phase.knots.size() - 1);
    const double gap = phase.knots[i + 1].t - phase.knots[i].t;
    const double change = std::min(std::abs(Magnitude(1e-5, 0.01)), gap) - gap;
    bool follows = false;
    for (Knot* knot : KnotsOf(&subject->plan)) {
      follows = follows || knot == &phase.knots[i + 1];
      if (follows) knot->t += change;
    }
  }

  void MoveCoordinate(VerifierSubject* subject) {
    Knot& knot = AnyKnot(subject);
    knot.q[4 + static_cast<Eigen::Index>(Below(knot.q.size() - 4))] += Magnitude(1e-10, 1);
  }

  void MovePhase(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    const auto at = static_cast<Eigen::Index>(4 + Below(phase.knots.front().q.size() - 4));
    const double offset = Magnitude(1e-10, 0.1);
    for (Knot& knot : phase.knots) knot.q[at] += offset;
  }

  /// Shifts every phase a little farther than the one before it.
  void Creep(VerifierSubject* subject) {
    const double step = Magnitude(1e-9, 1e-5);
    double shift = 0;
    for (Phase* phase : PhasesOf(&subject->plan)) {
      for (Knot& knot : phase->knots) knot.q[4] += shift;
      shift += step;
    }
  }

  void Glide(VerifierSubject* subject) {
    const double speed = Magnitude(1e-6, 1e-2);
    for (Knot* knot : KnotsOf(&subject->plan)) {
      knot->q[5] += speed * knot->t;
      knot->v[4] += speed;
    }
    const double duration = subject->plan.duration();
    subject->scenario.goals[0].y += speed * duration;
    // The motion is still at rest at both ends.
    KnotsOf(&subject->plan).front()->v[4] -= speed;
    KnotsOf(&subject->plan).back()->v[4] -= speed;
  }

  void ChangeRate(VerifierSubject* subject) {
    Knot& knot = AnyKnot(subject);
    knot.v[static_cast<Eigen::Index>(Below(knot.v.size()))] += Magnitude(1e-9, 10);
  }

  void ChangeAcceleration(VerifierSubject* subject) {
    Knot& knot = AnyKnot(subject);
    knot.a[static_cast<Eigen::Index>(Below(knot.a.size()))] += Magnitude(1e-9, 1000);
  }

  void ChangeForce(VerifierSubject* subject) {
    Knot& knot = AnyKnot(subject);
    if (knot.forces.size() == 0) return;
    knot.forces(static_cast<Eigen::Index>(Below(3)),
                static_cast<Eigen::Index>(Below(knot.forces.cols()))) += Magnitude(1e-6, 300);
  }

  /// Lets a patch bear with some of its points.
  void ChangeContacts(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    if (phase.contacts.empty()) return;
    const std::vector<BearingPatch> patches = BearingPatches(subject->robot, phase);
    const std::size_t which = Below(patches.size());
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < which; ++i) {
      column += static_cast<Eigen::Index>(patches[i].points.size());
    }
    const auto count = static_cast<Eigen::Index>(patches[which].points.size());
    if (count < 2) return;
    const auto drop = static_cast<Eigen::Index>(Below(count));
    std::string name = subject->robot.contacts[patches[which].patch].name + "[";
    for (Eigen::Index i = 0; i < count; ++i) {
      if (i == drop) continue;
      name += (name.back() == '[' ? "" : ",") + std::to_string(patches[which].points[i]);
    }
    phase.contacts[which] = name + "]";
    const auto without = [&](const Eigen::Matrix3Xd& all) {
      Eigen::Matrix3Xd some(3, all.cols() - 1);
      some << all.leftCols(column + drop), all.rightCols(all.cols() - column - drop - 1);
      return some;
    };
    if (phase.impulses.cols() > 0) phase.impulses = without(phase.impulses);
    for (Knot& knot : phase.knots) knot.forces = without(knot.forces);
  }

  void ChangeImpulses(VerifierSubject* subject) {
    Phase& phase = AnyPhase(subject);
    const Eigen::Index points = phase.knots.front().forces.cols();
    if (points == 0) return;
    if (phase.impulses.cols() == 0) phase.impulses = Eigen::Matrix3Xd::Zero(3, points);
    phase.impulses(static_cast<Eigen::Index>(Below(3)), static_cast<Eigen::Index>(Below(points))) +=
        Magnitude(1e-8, 1);
  }

  static Phase SplitOff(Phase* phase, std::size_t middle) {
    Phase second = *phase;
    phase->knots.resize(middle + 1);
    second.knots.erase(second.knots.begin(), second.knots.begin() + static_cast<long>(middle));
    second.impulses.resize(3, 0);
    return second;
  }

  void SplitPhase(VerifierSubject* subject) {
    Segment& segment = subject->plan.segments[Below(subject->plan.segments.size())];
    const std::size_t at = Below(segment.phases.size());
    if (segment.phases[at].knots.size() < 3) return;
    Phase second = SplitOff(&segment.phases[at], 1 + Below(segment.phases[at].knots.size() - 2));
    segment.phases.insert(segment.phases.begin() + static_cast<long>(at) + 1, std::move(second));
  }

  void CutSegment(VerifierSubject* subject) {
    std::vector<Segment>& segments = subject->plan.segments;
    const std::size_t at = Below(segments.size());
    SplitPhase(subject);
    if (segments[at].phases.size() < 2) return;
    const auto cut = static_cast<long>(1 + Below(segments[at].phases.size() - 1));
    Segment rest{segments[at].action, {}};
    rest.phases.assign(segments[at].phases.begin() + cut, segments[at].phases.end());
    segments[at].phases.resize(static_cast<std::size_t>(cut));
    segments.insert(segments.begin() + static_cast<long>(at) + 1, rest);
  }

  void MergePhases(VerifierSubject* subject) {
    Segment& segment = subject->plan.segments[Below(subject->plan.segments.size())];
    for (std::size_t i = 0; i + 1 < segment.phases.size(); ++i) {
      Phase& phase = segment.phases[i];
      const Phase& next = segment.phases[i + 1];
      if (phase.contacts != next.contacts) continue;
      phase.knots.insert(phase.knots.end(), next.knots.begin() + 1, next.knots.end());
      segment.phases.erase(segment.phases.begin() + static_cast<long>(i) + 1);
      return;
    }
  }

  /// Sets forces and torques of every knot to those that realise its motion.
  static void Repair(VerifierSubject* subject) {
    StateEvaluator evaluator(subject->robot);
    for (Phase* phase : PhasesOf(&subject->plan)) {
      const std::vector<BearingPoint> points = BearingPoints(subject->robot, *phase);
      for (Knot& knot : phase->knots) {
        const VerifierState state = evaluator.Evaluate(knot);
        const RealisedForces realised =
            RealiseForces(state, points, subject->robot, evaluator.dynamics());
        knot.forces = realised.forces;
        knot.tau = realised.torques;
      }
    }
  }

  std::mt19937 generator_;
};

}  // namespace possibility::actions::testing
