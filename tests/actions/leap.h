#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "actions/conditions/exploration_pose.h"
#include "actions/conditions/manoeuvre.h"
#include "actions/wholebody/signal.h"
#include "models/world/ground_map.h"
#include "models/world/scenario.h"
#include "tests/actions/drchubo1.h"

namespace possibility::actions {

/// Two floors with a pit between, a leap's length wide at y = 0, and a bridge far to the side.
inline models::Scenario PitScene(bool with_bridge) {
  models::Scenario scenario;
  scenario.name = "pit";
  scenario.file = "pit.yaml";
  scenario.robot_file = DrcHubo1().file;
  scenario.actions = {"walk", "vault"};
  scenario.start = {"walk", -1.2, 0, 0, 0};
  scenario.goals = {{"walk", 1.2, 0, 0, 0}};
  scenario.environment.bounds = Eigen::AlignedBox2d(Eigen::Vector2d(-2, -1), Eigen::Vector2d(2, 3));
  const auto add = [&](const std::string& name, double x0, double x1, double y0, double y1) {
    models::Obstacle floor;
    floor.name = name;
    floor.shape = models::Shape::Box({x1 - x0, y1 - y0, 0.5});
    floor.X_WO.translation() << (x0 + x1) / 2, (y0 + y1) / 2, -0.25;
    floor.is_ground = true;
    scenario.environment.obstacles.push_back(floor);
  };
  add("near", -3, -0.2, -2, 4);
  add("far", 0.2, 3, -2, 4);
  if (with_bridge) add("bridge", -0.2, 0.2, 0.8, 4);
  return scenario;
}

/// What the planner would give to a manoeuvre, for tests that run no planner.
class Context {
 public:
  explicit Context(models::Environment environment)
      : environment_(std::move(environment)), ground_(environment_) {
    context_.model = &DrcHubo1Locomotion();
    context_.world = {&environment_, &ground_};
    context_.space =
        std::make_shared<PelvisPoseSpace>(environment_.bounds, ground_.levels(), 0.137);
    for (int gait = 0; gait < 2; ++gait) {
      context_.gaits.push_back(std::make_shared<QuasiStaticAction>(
          *context_.model, gait, context_.world, context_.space, 0.25));
    }
  }
  const PlanningContext& operator*() const { return context_; }

 private:
  models::Environment environment_;
  models::GroundMap ground_;
  PlanningContext context_;
};

/// A manoeuvre with one edge, across the pit at y = 0, that no robot could execute. The test
/// decides what its jobs and its motion do.
class Leap : public Manoeuvre {
 public:
  using RunJob = std::function<graph::JobVerdict(graph::JobControl*)>;
  using MakeMotion = std::function<std::vector<Phase>(const Leap&)>;
  /// Called with the name of each condition or extension that is asked for.
  using OnAsked = std::function<void(const std::string&)>;
  static constexpr double kHalf = 0.6;  ///< m, of its length

  Leap(
      const PlanningContext& context, RunJob run_job, MakeMotion make_motion,
      OnAsked on_asked = [](const std::string&) {})
      : Manoeuvre(context, "vault", context.model->GaitIndex("walk"),
                  context.model->GaitIndex("walk")),
        run_job_(std::move(run_job)),
        make_motion_(std::move(make_motion)),
        on_asked_(std::move(on_asked)),
        edge_{At(-kHalf), At(kHalf)} {}

  using Manoeuvre::CN;
  using Manoeuvre::Explorable;
  bool CN(const graph::Edge& edge) const override {
    on_asked_("CN");
    return edge.from.isApprox(edge_.from, 1e-9) && edge.to.isApprox(edge_.to, 1e-9);
  }
  bool Explorable(const graph::Edge& edge) const override {
    on_asked_("Explorable");
    return Manoeuvre::Explorable(edge);
  }
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point&) const override {
    on_asked_("ExtendTowards");
    return v0.isApprox(edge_.from, 1e-9) ? edge_.to : v0;
  }
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point&) const override {
    return v0.isApprox(edge_.to, 1e-9) ? edge_.from : v0;
  }
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point&) const override {
    on_asked_("FindLaunchPoint");
    return v.x() < 0 ? std::optional(edge_.from) : std::nullopt;
  }
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point&) const override {
    on_asked_("FindLandingPoint");
    return v.x() > 0 ? std::optional(edge_.to) : std::nullopt;
  }
  double ExpectedDuration(const graph::Edge&) const override {
    on_asked_("ExpectedDuration");
    return 1;
  }
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(const graph::Edge&) const override {
    on_asked_("SpawnConfirmationJob");
    return std::make_unique<Job>(*this);
  }
  std::vector<Phase> Motion(const graph::Edge&, const CancellationToken&) const override {
    return make_motion_(*this);
  }

  /// The robot slides from one stance in its walking posture, `distance` (m) far, without any
  /// force.
  std::vector<Phase> Slide(double distance) const {
    constexpr double kDuration = 2;
    const models::RobotModel& robot = *model().robot;
    Phase phase;
    phase.contacts = {"left_sole", "right_sole"};
    for (int i = 0; i <= 20; ++i) {
      Knot knot;
      knot.t = kDuration * i / 20;
      const ScalarSignal s = RestToRest(knot.t, kDuration);
      knot.q = model().gaits[from()]->stance.q;
      knot.q[4] += -kHalf + distance * s.value;
      knot.v.setZero(robot.nv());
      knot.v[3] = distance * s.rate;
      knot.a.setZero(robot.nv());
      knot.a[3] = distance * s.acceleration;
      knot.tau.setZero(robot.num_joints());
      knot.forces.setZero(3, 8);
      phase.knots.push_back(knot);
    }
    return {phase};
  }
  std::vector<Phase> Slide() const { return Slide(2 * kHalf); }

 private:
  class Job : public graph::ConfirmationJob {
   public:
    explicit Job(const Leap& leap) : leap_(leap) {}
    graph::JobVerdict Run(graph::JobControl* control) override { return leap_.run_job_(control); }

   private:
    const Leap& leap_;
  };

  graph::Point At(double x) const { return PointOf({from(), {x, 0, 0}, 0}); }

  RunJob run_job_;
  MakeMotion make_motion_;
  OnAsked on_asked_;
  graph::Edge edge_;
};

/// A job that takes this long (s) and then confirms. It ends at once when it is cancelled.
inline Leap::RunJob Sleeps(double seconds) {
  return [seconds](graph::JobControl* control) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      if (!control->Checkpoint()) return graph::JobVerdict::kUndecided;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return graph::JobVerdict::kConfirmed;
  };
}

inline ManoeuvreFactory LeapFactory(const Leap::RunJob& run_job,
                                    const Leap::MakeMotion& make_motion) {
  return {"vault", [=](const PlanningContext& context) {
            return std::make_shared<Leap>(context, run_job, make_motion);
          }};
}

/// Jobs and motions for leaps.
inline graph::JobVerdict Confirms(graph::JobControl*) { return graph::JobVerdict::kConfirmed; }
inline graph::JobVerdict Refutes(graph::JobControl*) { return graph::JobVerdict::kRefuted; }
inline std::vector<Phase> Slides(const Leap& leap) { return leap.Slide(); }

}  // namespace possibility::actions
