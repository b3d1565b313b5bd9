#include "dynamics/robot_rollout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include "dynamics/bearing_points.h"
#include "dynamics/contact_patches.h"

namespace possibility::dynamics {

namespace {

using Eigen::Matrix3Xd;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// m/s: slower points do not hit the ground but rest on it.
constexpr double kAtRest = 1e-7;

// m: a free point that is not higher than this cannot be told from one on its plane; it comes down
// when it has sunk by this. A fall from there ends below RobotRolloutSettings::rest_speed.
constexpr double kSlack = 1e-8;

[[noreturn]] void Reject(const std::string& what) {
  throw std::invalid_argument("RobotSimulator: " + what);
}

bool Contains(const std::vector<int>& indices, int index) {
  return std::binary_search(indices.begin(), indices.end(), index);
}

std::vector<int> Without(const std::vector<int>& indices, const std::vector<int>& removed) {
  std::vector<int> rest;
  std::set_difference(indices.begin(), indices.end(), removed.begin(), removed.end(),
                      std::back_inserter(rest));
  return rest;
}

std::vector<int> Picked(const std::vector<int>& indices, const std::vector<int>& picks) {
  std::vector<int> picked;
  for (const int pick : picks) picked.push_back(indices[pick]);
  return picked;
}

void CheckContact(const RolloutContact& contact, const MultibodyModel& model) {
  const auto fail = [&contact](const std::string& what) {
    Reject(fmt::format("contact '{}' {}", contact.name, what));
  };
  if (contact.point.link < 0 || contact.point.link >= model.tree().num_links()) {
    fail(fmt::format("is on link {}, expected 0 to {}", contact.point.link,
                     model.tree().num_links() - 1));
  }
  if (!contact.point.p_L.allFinite()) fail("is at a point that is not finite");
  if (!(std::abs(contact.point.normal_W.norm() - 1) < 1e-6)) fail("has a normal that is no unit");
  if (!std::isfinite(contact.offset)) fail("has a plane whose offset is not finite");
  if (!(contact.friction > 0) || !std::isfinite(contact.friction)) {
    fail(fmt::format("has friction {}, expected a positive number", contact.friction));
  }
}

/// What is constant while the same points are held.
struct Stance {
  std::vector<int> held;                     ///< contacts, ascending
  std::vector<int> jammed;                   ///< those of them that friction jams
  std::vector<HeldPoint> points;             ///< by `held`
  std::vector<ContactPatchBalance> patches;  ///< of those; indices into `points`
  std::vector<int> free;                     ///< the other contacts
  bool has_landed = false;                   ///< some contact has been held by now
  /// By contact, m: 0, or, for a free one so near to its plane that rounding decides on which side
  /// it is, how far below the plane it comes down, until it has been above by kSlack.
  std::vector<double> slack;
  std::optional<double> calm_since;  ///< s: kinetic energy below the bound since
};

/// What a guard of a mode stands for.
struct GuardMeaning {
  enum class Kind {
    kTouchdown,
    kClearing,
    kTipping,
    kUnjamming,
    kSlip,
    kCalm,
    kRest
  } kind = Kind::kTouchdown;
  int contact = -1;
  int patch = -1;
  int edge = -1;
};

}  // namespace

RobotRolloutSettings::RobotRolloutSettings() {
  // Feedback on light links is stiff (docs/dynamics.md has what was measured).
  hybrid.integration.method = OdeMethod::kBdf;
  hybrid.integration.relative_tolerance = 1e-8;
  hybrid.integration.absolute_tolerance = 1e-8;
  hybrid.integration.max_step = 0.02;
}

VectorXd RobotRollout::Configuration(double t) const {
  VectorXd q = hybrid.State(t).head(nq);
  if (q.size() - (hybrid.state.size() - nq) == 1) q.head<4>().normalize();
  return q;
}

VectorXd RobotRollout::Velocity(double t) const {
  const VectorXd state = hybrid.State(t);
  return state.tail(state.size() - nq);
}

class RobotSimulator::Impl {
 public:
  Impl(std::shared_ptr<const MultibodyModel> model, std::vector<RolloutContact> contacts,
       JointControl control, const RobotRolloutSettings& settings)
      : forward_(std::move(model), settings.dynamics),
        torques_(forward_.model(), std::move(control)),
        contacts_(std::move(contacts)),
        settings_(settings) {
    for (const RolloutContact& contact : contacts_) CheckContact(contact, forward_.model());
    if (!(settings.touching >= 0)) Reject("`touching` must not be negative");
    if (!(settings.rest_speed >= 0)) Reject("`rest_speed` must not be negative");
    if (!(settings.rest_energy >= 0)) Reject("`rest_energy` must not be negative");
    if (!(settings.rest_time > 0)) Reject("`rest_time` must be positive");
    generalised_.setZero(forward_.model().nv());
  }

  RobotRollout Run(const Eigen::Ref<const VectorXd>& q, const Eigen::Ref<const VectorXd>& v,
                   double start_time, double end_time) {
    CheckState(q, v);
    rollout_ = {};
    rollout_.nq = nq();
    rollout_.friction_utilisation = VectorXd::Zero(contacts_.size());
    rollout_.torque_utilisation = VectorXd::Zero(forward_.model().num_joints());
    stances_.clear();
    end_ = RobotRolloutEnd::kTime;

    VectorXd state(nq() + nv());
    state << q, v;
    SetState(state);
    CheckDepths();
    Stance stance = FirstStance(start_time, &state);
    const auto mode = ModeOf(std::move(stance));
    if (end_ == RobotRolloutEnd::kSlip) {
      rollout_.hybrid.end = HybridEnd::kReset;
      rollout_.hybrid.reason = reason_;
      rollout_.hybrid.time = start_time;
      rollout_.hybrid.state = state;
      rollout_.hybrid.segments = {{mode, OdeTrajectory(start_time, state)}};
      Conclude();
      return std::exchange(rollout_, {});
    }
    rollout_.hybrid = RollOut(mode, state, start_time, end_time, settings_.hybrid);
    Conclude();
    return std::exchange(rollout_, {});
  }

  RobotMotion MotionAt(const RobotRollout& rollout, double t) {
    return Motion(t, rollout.hybrid.State(t), StanceOf(rollout.hybrid.SegmentAt(t)));
  }

 private:
  const Stance& StanceOf(const HybridSegment& segment) const {
    const auto known = std::find_if(stances_.begin(), stances_.end(), [&](const auto& entry) {
      return entry.first == segment.mode.get();
    });
    if (known == stances_.end()) Reject("MotionAt: this is not the last rollout");
    return *known->second;
  }

  int nq() const { return forward_.model().nq(); }
  int nv() const { return forward_.model().nv(); }
  MultibodyDynamics* dynamics() { return forward_.dynamics(); }

  void CheckState(const Eigen::Ref<const VectorXd>& q, const Eigen::Ref<const VectorXd>& v) const {
    if (q.size() != nq() || v.size() != nv()) {
      Reject(fmt::format("q and v have {} and {} elements, expected {} and {}", q.size(), v.size(),
                         nq(), nv()));
    }
    if (!q.allFinite() || !v.allFinite()) Reject("the state is not finite");
  }

  void CheckDepths() {
    for (const RolloutContact& contact : contacts_) {
      const double gap = Gap(contact);
      if (gap >= -settings_.touching || contact.lands) continue;
      Reject(fmt::format("contact '{}' starts {:.3g} m below the ground", contact.name, -gap));
    }
  }

  bool Lands(int contact, const VectorXd& state) const {
    return !contacts_[contact].lands || contacts_[contact].lands(state.head(nq()));
  }

  double Gap(const RolloutContact& contact) {
    return contact.point.normal_W.dot(dynamics()->Position(contact.point)) - contact.offset;
  }

  void SetState(const Eigen::Ref<const VectorXd>& state) {
    forward_.SetState(state.head(nq()), state.tail(nv()));
  }

  /// Generalised forces of the joints at the state set; nv.
  const VectorXd& JointForces(double t, const Eigen::Ref<const VectorXd>& state, bool has_landed) {
    generalised_.tail(forward_.model().num_joints()) =
        torques_.Evaluate(t, state.head(nq()), state.tail(nv()), has_landed, dynamics());
    return generalised_;
  }

  /// Acceleration at a state of a stance. `forces` may be null.
  VectorXd Accelerate(double t, const Eigen::Ref<const VectorXd>& state, const Stance& stance,
                      Matrix3Xd* forces) {
    SetState(state);
    const VectorXd& joint_forces = JointForces(t, state, stance.has_landed);
    if (forces != nullptr) forces->setZero(3, stance.points.size());
    if (stance.points.empty()) return forward_.Free(joint_forces);
    const ConstrainedMotion& motion = forward_.Held(joint_forces, stance.points);
    if (forces != nullptr) *forces = motion.forces;
    return motion.acceleration;
  }

  RobotMotion Motion(double t, const VectorXd& state, const Stance& stance) {
    RobotMotion motion;
    Matrix3Xd forces;
    motion.a = Accelerate(t, state, stance, &forces);
    motion.q = state.head(nq());
    motion.v = state.tail(nv());
    motion.torques = generalised_.tail(forward_.model().num_joints());
    motion.forces.setZero(3, contacts_.size());
    for (size_t i = 0; i < stance.held.size(); ++i)
      motion.forces.col(stance.held[i]) = forces.col(i);
    return motion;
  }

  double KineticEnergy(const Eigen::Ref<const VectorXd>& v) {
    return 0.5 * v.dot(dynamics()->MassMatrix() * v);
  }

  std::vector<HeldPoint> HeldWhereTheyAre(const std::vector<int>& held) {
    std::vector<HeldPoint> points;
    for (const int contact : held) {
      const ContactPoint& point = contacts_[contact].point;
      points.push_back({point, dynamics()->Position(point)});
    }
    return points;
  }

  // ---- Events ----

  Stance FirstStance(double time, VectorXd* state) {
    std::vector<int> touching;
    for (int i = 0; i < num_contacts(); ++i) {
      const RolloutContact& contact = contacts_[i];
      if (std::abs(Gap(contact)) > settings_.touching) continue;
      if (Lands(i, *state)) touching.push_back(i);
    }
    Stance stance = PassContactEvent(time, {}, touching, {}, state);
    CheckSlip(time, *state, stance);
    if (KineticEnergy(state->tail(nv())) < settings_.rest_energy) stance.calm_since = time;
    return stance;
  }

  /// Impact of what has come down, then who bears: returns the stance from now on. `held` before,
  /// `leaving` points do not bear.
  Stance PassContactEvent(double time, const std::vector<int>& held,
                          const std::vector<int>& touched, const std::vector<int>& leaving,
                          VectorXd* state) {
    std::vector<int> touching;
    std::set_union(held.begin(), held.end(), touched.begin(), touched.end(),
                   std::back_inserter(touching));
    if (touching.empty()) return MakeStance({}, {});
    RobotContactEvent event;
    event.time = time;
    event.touched = touched;
    event.v_before = state->tail(nv());
    event.impulses.setZero(3, num_contacts());
    touching = PassImpact(Without(touching, leaving), &event, state);
    SelectHeld(touching, *state, &event);
    event.released = Without(held, event.held);
    event.v_after = state->tail(nv());
    rollout_.events.push_back(event);
    return MakeStance(event.held, event.jammed);
  }

  /// Returns the points that are at rest afterwards.
  std::vector<int> PassImpact(const std::vector<int>& touching, RobotContactEvent* event,
                              VectorXd* state) {
    UnilateralContacts contacts = Unilateral(touching, Velocities(touching));
    contacts.staying = settings_.rest_speed;
    if (contacts.unconstrained.size() == 0 ||
        contacts.unconstrained.lpNorm<Eigen::Infinity>() <= kAtRest) {
      return touching;
    }
    const std::vector<int> bearing = Picked(touching, SelectBearingPoints(contacts).points);
    std::vector<ContactPoint> points;
    for (const int contact : bearing) points.push_back(contacts_[contact].point);
    const Impact& impact = forward_.Hit(points);
    event->energy_lost = impact.energy_lost;
    for (size_t i = 0; i < bearing.size(); ++i) {
      event->impulses.col(bearing[i]) = impact.impulses.col(i);
    }
    for (const ContactPatchBalance& patch : PatchesOf(bearing)) {
      const double friction = contacts_[bearing[patch.points.front()]].friction;
      const double utilisation = patch.FrictionUtilisation(impact.impulses, friction);
      event->friction_utilisation = std::max(event->friction_utilisation, utilisation);
      if (utilisation > 1 && settings_.ends_at_slip) {
        EndWith(RobotRolloutEnd::kSlip,
                fmt::format("'{}' slips when it hits the ground: {:.3g} of its friction is needed",
                            contacts_[bearing[patch.points.front()]].name, utilisation));
      }
    }
    const VectorXd after = impact.velocity;
    state->tail(nv()) = after;
    SetState(*state);
    return bearing;
  }

  void SelectHeld(const std::vector<int>& touching, const VectorXd& state,
                  RobotContactEvent* event) {
    if (touching.empty()) return;
    const VectorXd forces = JointForces(event->time, state, true);
    const VectorXd free = forward_.Free(forces);
    dynamics()->SetAcceleration(free);
    VectorXd accelerations(3 * touching.size());
    for (size_t i = 0; i < touching.size(); ++i) {
      accelerations.segment<3>(3 * i) = dynamics()->Acceleration(contacts_[touching[i]].point);
    }
    const BearingPoints bearing = SelectBearingPoints(Unilateral(touching, accelerations));
    event->held = Picked(touching, bearing.points);
    event->jammed = Picked(touching, bearing.jammed);
  }

  VectorXd Velocities(const std::vector<int>& contacts) {
    VectorXd velocities(3 * contacts.size());
    for (size_t i = 0; i < contacts.size(); ++i) {
      velocities.segment<3>(3 * i) = dynamics()->Velocity(contacts_[contacts[i]].point);
    }
    return velocities;
  }

  UnilateralContacts Unilateral(const std::vector<int>& contacts, VectorXd unconstrained) {
    UnilateralContacts unilateral;
    unilateral.mass = dynamics()->MassMatrix();
    unilateral.unconstrained = std::move(unconstrained);
    unilateral.jacobian.resize(3 * contacts.size(), nv());
    for (size_t i = 0; i < contacts.size(); ++i) {
      const ContactPoint& point = contacts_[contacts[i]].point;
      dynamics()->Jacobian(point, unilateral.jacobian.middleRows<3>(3 * i));
      unilateral.normals.push_back(point.normal_W);
    }
    return unilateral;
  }

  std::vector<ContactPatchBalance> PatchesOf(const std::vector<int>& held) {
    std::vector<PatchPoint> points;
    for (const int contact : held) {
      const ContactPoint& point = contacts_[contact].point;
      points.push_back({point.link, dynamics()->Position(point), point.normal_W});
    }
    return MakePatches(points);
  }

  Stance MakeStance(const std::vector<int>& held, const std::vector<int>& jammed) {
    Stance stance;
    stance.held = held;
    stance.jammed = jammed;
    stance.has_landed = !rollout_.events.empty();
    stance.points = HeldWhereTheyAre(held);
    stance.patches = PatchesOf(held);
    stance.slack.assign(num_contacts(), 0.0);
    for (int i = 0; i < num_contacts(); ++i) {
      if (Contains(held, i)) continue;
      stance.free.push_back(i);
      const double gap = Gap(contacts_[i]);
      if (contacts_[i].lands || gap > kSlack) continue;
      stance.slack[i] = kSlack + std::max(0.0, -gap);
    }
    return stance;
  }

  // ---- Modes ----

  std::shared_ptr<const HybridMode> ModeOf(Stance made) {
    const auto stance = std::make_shared<const Stance>(std::move(made));
    const auto meanings = std::make_shared<const std::vector<GuardMeaning>>(Meanings(*stance));
    auto mode = std::make_shared<HybridMode>();
    mode->name = Describe(stance->held);
    mode->rate = [this, stance](double t, const auto& state, auto rate) {
      rate.tail(nv()) = Accelerate(t, state, *stance, nullptr);
      rate.head(nq()) = forward_.model().ConfigurationRate(state.head(nq()), state.tail(nv()));
    };
    for (const GuardMeaning& meaning : *meanings) {
      const bool passes = meaning.kind == GuardMeaning::Kind::kTouchdown &&
                          contacts_[meaning.contact].lands != nullptr;
      const bool rises = meaning.kind == GuardMeaning::Kind::kUnjamming ||
                         meaning.kind == GuardMeaning::Kind::kClearing ||
                         (meaning.kind == GuardMeaning::Kind::kCalm && stance->calm_since);
      mode->guards.push_back({rises ? GuardDirection::kRising : GuardDirection::kFalling, !passes});
      mode->guard_names.push_back(NameOf(meaning, *stance));
    }
    mode->guard_values = [this, stance, meanings](double t, const auto& state, auto values) {
      EvaluateGuards(t, state, *stance, *meanings, values);
    };
    const std::weak_ptr<const HybridMode> self = mode;
    mode->reset = [this, self, stance, meanings](const HybridEvent& event) {
      return Reset(event, self.lock(), *stance, *meanings);
    };
    stances_.emplace_back(mode.get(), stance);
    return mode;
  }

  std::vector<GuardMeaning> Meanings(const Stance& stance) const {
    using Kind = GuardMeaning::Kind;
    std::vector<GuardMeaning> meanings;
    for (const int contact : stance.free) {
      meanings.push_back({Kind::kTouchdown, contact, -1, -1});
      if (stance.slack[contact] > 0) meanings.push_back({Kind::kClearing, contact, -1, -1});
    }
    for (int patch = 0; patch < static_cast<int>(stance.patches.size()); ++patch) {
      const int edges = static_cast<int>(stance.patches[patch].edges.size());
      for (int edge = 0; edge < edges; ++edge) {
        meanings.push_back({Kind::kTipping, -1, patch, edge});
      }
      if (settings_.ends_at_slip) meanings.push_back({Kind::kSlip, -1, patch, -1});
    }
    for (const int contact : stance.jammed) {
      meanings.push_back({Kind::kUnjamming, contact, -1, -1});
    }
    if (settings_.rest_energy > 0) {
      meanings.push_back({Kind::kCalm, -1, -1, -1});
      if (stance.calm_since) meanings.push_back({Kind::kRest, -1, -1, -1});
    }
    return meanings;
  }

  void EvaluateGuards(double t, const Eigen::Ref<const VectorXd>& state, const Stance& stance,
                      const std::vector<GuardMeaning>& meanings, Eigen::Ref<VectorXd> values) {
    Matrix3Xd forces;
    if (stance.points.empty()) {
      SetState(state);
    } else {
      Accelerate(t, state, stance, &forces);
    }
    for (size_t i = 0; i < meanings.size(); ++i) {
      values[i] = GuardValue(t, state, stance, forces, meanings[i]);
    }
  }

  double GuardValue(double t, const Eigen::Ref<const VectorXd>& state, const Stance& stance,
                    const Matrix3Xd& forces, const GuardMeaning& meaning) {
    switch (meaning.kind) {
      case GuardMeaning::Kind::kTouchdown:
        return Gap(contacts_[meaning.contact]) + stance.slack[meaning.contact];
      case GuardMeaning::Kind::kClearing:
        return Gap(contacts_[meaning.contact]) - kSlack;
      case GuardMeaning::Kind::kTipping: {
        const ContactPatchBalance& patch = stance.patches[meaning.patch];
        return patch.Moment(patch.edges[meaning.edge], forces);
      }
      case GuardMeaning::Kind::kUnjamming:
        return AccelerationIfLetGo(stance, meaning.contact);
      case GuardMeaning::Kind::kSlip: {
        const ContactPatchBalance& patch = stance.patches[meaning.patch];
        const Vector3d force = patch.Resultant(forces);
        const double normal = patch.normal_W.dot(force);
        return PatchContact(stance, meaning.patch).friction * normal -
               (force - normal * patch.normal_W).norm();
      }
      case GuardMeaning::Kind::kCalm:
        return KineticEnergy(state.tail(nv())) - settings_.rest_energy;
      case GuardMeaning::Kind::kRest:
        break;
    }
    return *stance.calm_since + settings_.rest_time - t;
  }

  /// Along the normal of a jammed contact while all but it are held. Under the joint torques of the
  /// stance at the state set.
  double AccelerationIfLetGo(const Stance& stance, int contact) {
    std::vector<HeldPoint> others;
    for (size_t i = 0; i < stance.held.size(); ++i) {
      if (stance.held[i] != contact) others.push_back(stance.points[i]);
    }
    const VectorXd acceleration = others.empty() ? forward_.Free(generalised_)
                                                 : forward_.Held(generalised_, others).acceleration;
    dynamics()->SetAcceleration(acceleration);
    const ContactPoint& point = contacts_[contact].point;
    return point.normal_W.dot(dynamics()->Acceleration(point));
  }

  HybridTransition Reset(const HybridEvent& event, const std::shared_ptr<const HybridMode>& mode,
                         const Stance& stance, const std::vector<GuardMeaning>& meanings) {
    std::vector<int> touched, leaving;
    std::optional<Stance> next;
    for (const int guard : event.guards) {
      const GuardMeaning& meaning = meanings[guard];
      switch (meaning.kind) {
        case GuardMeaning::Kind::kTouchdown:
          if (Lands(meaning.contact, event.before)) touched.push_back(meaning.contact);
          break;
        case GuardMeaning::Kind::kClearing:
          if (!next) next = stance;
          next->slack[meaning.contact] = 0;
          break;
        case GuardMeaning::Kind::kTipping:
          AddTipping(stance, meaning, &leaving);
          break;
        case GuardMeaning::Kind::kUnjamming:
          leaving.push_back(meaning.contact);
          break;
        case GuardMeaning::Kind::kSlip:
          EndWith(RobotRolloutEnd::kSlip,
                  fmt::format("the patch of '{}' slips", PatchContact(stance, meaning.patch).name));
          break;
        case GuardMeaning::Kind::kCalm:
          if (!next) next = stance;
          next->calm_since = stance.calm_since ? std::nullopt : std::optional(event.time);
          break;
        case GuardMeaning::Kind::kRest:
          EndWith(RobotRolloutEnd::kAtRest,
                  fmt::format("kinetic energy below {:.3g} J for {:.3g} s", settings_.rest_energy,
                              settings_.rest_time));
          break;
      }
    }
    HybridTransition transition;
    transition.state = event.before;
    const bool contacts_change = !touched.empty() || !leaving.empty();
    if (end_ == RobotRolloutEnd::kTime && contacts_change) {
      NormaliseOrientation(&transition.state);
      next = PassContacts(event.time, stance, touched, leaving, &transition.state);
    }
    if (end_ == RobotRolloutEnd::kTime) {
      transition.mode = next ? ModeOf(std::move(*next)) : mode;
    } else {
      transition.reason = reason_;
    }
    return transition;
  }

  Stance PassContacts(double time, const Stance& stance, std::vector<int> touched,
                      std::vector<int> leaving, VectorXd* state) {
    SetState(*state);
    for (const int contact : stance.held) {
      if (!touched.empty() && !Lands(contact, *state)) leaving.push_back(contact);
    }
    std::sort(touched.begin(), touched.end());
    std::sort(leaving.begin(), leaving.end());
    leaving.erase(std::unique(leaving.begin(), leaving.end()), leaving.end());
    Stance next = PassContactEvent(time, stance.held, touched, leaving, state);
    CheckSlip(time, *state, next);
    if (KineticEnergy(state->tail(nv())) < settings_.rest_energy) {
      next.calm_since = stance.calm_since.value_or(time);
    }
    return next;
  }

  void CheckSlip(double time, const VectorXd& state, const Stance& stance) {
    if (!settings_.ends_at_slip || stance.held.empty()) return;
    Matrix3Xd forces;
    Accelerate(time, state, stance, &forces);
    for (size_t i = 0; i < stance.patches.size(); ++i) {
      const RolloutContact& contact = PatchContact(stance, i);
      const double utilisation = stance.patches[i].FrictionUtilisation(forces, contact.friction);
      if (utilisation <= 1) continue;
      EndWith(RobotRolloutEnd::kSlip,
              fmt::format("the patch of '{}' slips: {:.3g} of its friction is needed", contact.name,
                          utilisation));
    }
  }

  void AddTipping(const Stance& stance, const GuardMeaning& meaning, std::vector<int>* tipping) {
    const ContactPatchBalance& patch = stance.patches[meaning.patch];
    const VectorXd& levers = patch.edges[meaning.edge].levers;
    for (size_t i = 0; i < patch.points.size(); ++i) {
      if (levers[i] > 0) tipping->push_back(stance.held[patch.points[i]]);
    }
  }

  void NormaliseOrientation(VectorXd* state) const {
    if (forward_.model().base() == Base::kFloating) state->head<4>().normalize();
  }

  void EndWith(RobotRolloutEnd end, std::string reason) {
    if (end_ != RobotRolloutEnd::kTime) return;
    end_ = end;
    reason_ = std::move(reason);
  }

  // ---- Words ----

  const RolloutContact& PatchContact(const Stance& stance, size_t patch) const {
    return contacts_[stance.held[stance.patches[patch].points.front()]];
  }

  std::string Describe(const std::vector<int>& held) const {
    if (held.empty()) return "flight";
    std::string names;
    for (const int contact : held) names += (names.empty() ? "" : ", ") + contacts_[contact].name;
    return names + " held";
  }

  std::string NameOf(const GuardMeaning& meaning, const Stance& stance) const {
    switch (meaning.kind) {
      case GuardMeaning::Kind::kTouchdown:
        return fmt::format("touchdown of '{}'", contacts_[meaning.contact].name);
      case GuardMeaning::Kind::kClearing:
        return fmt::format("'{}' clear of the ground", contacts_[meaning.contact].name);
      case GuardMeaning::Kind::kTipping:
        return fmt::format("tipping of the patch of '{}'",
                           PatchContact(stance, meaning.patch).name);
      case GuardMeaning::Kind::kUnjamming:
        return fmt::format("release of the jammed '{}'", contacts_[meaning.contact].name);
      case GuardMeaning::Kind::kSlip:
        return fmt::format("slip of the patch of '{}'", PatchContact(stance, meaning.patch).name);
      case GuardMeaning::Kind::kCalm:
        return "kinetic energy at its bound";
      case GuardMeaning::Kind::kRest:
        break;
    }
    return "at rest";
  }

  // ---- Results ----

  void Conclude() {
    HybridRollout& hybrid = rollout_.hybrid;
    NormaliseOrientation(&hybrid.state);
    rollout_.time = hybrid.time;
    rollout_.q = hybrid.state.head(nq());
    rollout_.v = hybrid.state.tail(nv());
    rollout_.reason = hybrid.reason;
    rollout_.end = hybrid.end == HybridEnd::kStopped ? RobotRolloutEnd::kStopped
                   : hybrid.end == HybridEnd::kZeno  ? RobotRolloutEnd::kZeno
                                                     : end_;
    for (size_t i = 0; i < hybrid.segments.size(); ++i) {
      const OdeTrajectory& trajectory = hybrid.segments[i].trajectory;
      const std::vector<double> times = trajectory.StepTimes();
      for (const double t : times) {
        RecordUtilisation(t, trajectory.State(t), StanceOf(hybrid.segments[i]));
      }
    }
  }

  void RecordUtilisation(double t, const VectorXd& state, const Stance& stance) {
    Matrix3Xd forces;
    Accelerate(t, state, stance, &forces);
    const VectorXd& limits = forward_.model().effort();
    for (int i = 0; i < limits.size(); ++i) {
      if (!(limits[i] > 0) || !std::isfinite(limits[i])) continue;
      const double torque = generalised_[forward_.model().num_base_velocities() + i];
      double& greatest = rollout_.torque_utilisation[i];
      greatest = std::max(greatest, std::abs(torque) / limits[i]);
    }
    for (const ContactPatchBalance& patch : stance.patches) {
      const double friction = contacts_[stance.held[patch.points.front()]].friction;
      const double utilisation = patch.FrictionUtilisation(forces, friction);
      for (const int point : patch.points) {
        double& greatest = rollout_.friction_utilisation[stance.held[point]];
        greatest = std::max(greatest, utilisation);
      }
    }
  }

  int num_contacts() const { return static_cast<int>(contacts_.size()); }

  ForwardDynamics forward_;
  JointTorques torques_;
  std::vector<RolloutContact> contacts_;
  RobotRolloutSettings settings_;
  VectorXd generalised_;
  /// Of the modes of the last rollout.
  std::vector<std::pair<const HybridMode*, std::shared_ptr<const Stance>>> stances_;
  RobotRolloutEnd end_ = RobotRolloutEnd::kTime;
  std::string reason_;
  RobotRollout rollout_;
};

RobotSimulator::RobotSimulator(std::shared_ptr<const MultibodyModel> model,
                               std::vector<RolloutContact> contacts, JointControl control,
                               const RobotRolloutSettings& settings) {
  if (!model) Reject("no model");
  impl_ =
      std::make_unique<Impl>(std::move(model), std::move(contacts), std::move(control), settings);
}

RobotSimulator::~RobotSimulator() = default;
RobotSimulator::RobotSimulator(RobotSimulator&&) noexcept = default;

RobotRollout RobotSimulator::Run(const Eigen::Ref<const VectorXd>& q,
                                 const Eigen::Ref<const VectorXd>& v, double start_time,
                                 double end_time) {
  return impl_->Run(q, v, start_time, end_time);
}

RobotMotion RobotSimulator::MotionAt(const RobotRollout& rollout, double t) {
  return impl_->MotionAt(rollout, t);
}

}  // namespace possibility::dynamics
