#include "actions/conditions/guarded_manoeuvre.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <numbers>
#include <type_traits>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using graph::Point;
using graph::PointPair;

std::string Describe(const Point& v) {
  return fmt::format("the pelvis at ({:.3f}, {:.3f}, {:.3f}) heading {:.1f} deg", v.x(), v.y(),
                     v.z(), Heading(ToPose(v).linear()) * 180 / std::numbers::pi);
}

std::string Describe(const PointPair& edge) {
  return fmt::format("the edge from {} to {}", Describe(edge.from), Describe(edge.to));
}

std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

class GuardedManoeuvre : public Manoeuvre {
 public:
  GuardedManoeuvre(const PlanningContext& context, std::shared_ptr<Manoeuvre> manoeuvre,
                   std::string where)
      : Manoeuvre(context, manoeuvre->name(), manoeuvre->from(), manoeuvre->to()),
        manoeuvre_(std::move(manoeuvre)),
        where_(std::move(where)) {}

  bool CN(const Point& v) const override {
    return Guard("CN", v, [&] { return manoeuvre_->CN(v); });
  }
  bool CN(const PointPair& edge) const override {
    return Guard("CN", edge, [&] { return manoeuvre_->CN(edge); });
  }
  bool CS(const Point& v) const override {
    return Guard("CS", v, [&] { return manoeuvre_->CS(v); });
  }
  bool CS(const PointPair& edge) const override {
    return Guard("CS", edge, [&] { return manoeuvre_->CS(edge); });
  }
  bool Explorable(const Point& v) const override {
    return Guard("Explorable", v, [&] { return manoeuvre_->Explorable(v); });
  }
  bool Explorable(const PointPair& edge) const override {
    return Guard("Explorable", edge, [&] { return manoeuvre_->Explorable(edge); });
  }
  Point ExtendTowards(const Point& v0, const Point& v1) const override {
    return Guard("ExtendTowards", v0, [&] { return manoeuvre_->ExtendTowards(v0, v1); });
  }
  Point ReverseExtend(const Point& v0, const Point& v1) const override {
    return Guard("ReverseExtend", v0, [&] { return manoeuvre_->ReverseExtend(v0, v1); });
  }
  std::optional<Point> FindLaunchPoint(const Point& v, const Point& v1) const override {
    return Guard("FindLaunchPoint", v, [&] { return manoeuvre_->FindLaunchPoint(v, v1); });
  }
  std::optional<Point> FindLandingPoint(const Point& v, const Point& v1) const override {
    return Guard("FindLandingPoint", v, [&] { return manoeuvre_->FindLandingPoint(v, v1); });
  }
  std::vector<Point> TransitionFrom(const Point& v) const override {
    return Guard("TransitionFrom", v, [&] { return manoeuvre_->TransitionFrom(v); });
  }
  bool IsReversible() const override { return manoeuvre_->IsReversible(); }
  double ExpectedDuration(const PointPair& edge) const override {
    return Guard("ExpectedDuration", edge, [&] { return manoeuvre_->ExpectedDuration(edge); });
  }
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const PointPair& edge) const override {
    return Guard("SpawnConfirmationJob", edge,
                 [&] { return manoeuvre_->SpawnConfirmationJob(edge); });
  }
  std::vector<Phase> Motion(const PointPair& edge,
                            const std::function<bool()>& keep_going) const override {
    return manoeuvre_->Motion(edge, keep_going);
  }
  ManoeuvreBounds Bounds() const override { return manoeuvre_->Bounds(); }
  bool ReplaceGuesses(const std::function<bool()>& keep_going) override {
    return manoeuvre_->ReplaceGuesses(keep_going);
  }
  double skip_growth() const override { return manoeuvre_->skip_growth(); }
  void Forbid(const PointPair& edge, const std::string& reason, bool anywhere) override {
    manoeuvre_->Forbid(edge, reason, anywhere);
  }

 private:
  template <typename At, typename Call>
  std::invoke_result_t<Call> Guard(const char* function, const At& at, const Call& call) const {
    try {
      return call();
    } catch (const Abandoned&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(fmt::format("{}: action '{}': {} failed for {}: {}", where_, name(),
                                   function, Describe(at), OneLine(error.what())));
    } catch (...) {
      throw InputError(fmt::format("{}: action '{}': {} failed for {}, expected no exception",
                                   where_, name(), function, Describe(at)));
    }
  }

  std::shared_ptr<Manoeuvre> manoeuvre_;
  std::string where_;
};

}  // namespace

std::shared_ptr<Manoeuvre> Guarded(const PlanningContext& context,
                                   std::shared_ptr<Manoeuvre> manoeuvre, std::string where) {
  return std::make_shared<GuardedManoeuvre>(context, std::move(manoeuvre), std::move(where));
}

}  // namespace possibility::actions
