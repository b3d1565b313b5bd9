#include "actions/conditions/searched_manoeuvre.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <numbers>
#include <utility>

#include "actions/conditions/exploration_pose.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using graph::Edge;
using graph::Point;

std::string Describe(const Point& v) {
  return fmt::format("the pelvis at ({:.3f}, {:.3f}, {:.3f}) heading {:.1f} deg", v.x(), v.y(),
                     v.z(), Heading(ToPose(v).linear()) * 180 / std::numbers::pi);
}

std::string Describe(const Edge& edge) {
  return fmt::format("the edge from {} to {}", Describe(edge.from), Describe(edge.to));
}

std::string OneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

/// Runs a job and records its verdict.
class RecordedJob : public graph::ConfirmationJob {
 public:
  RecordedJob(std::unique_ptr<graph::ConfirmationJob> job, Edge edge, EdgeVerdicts* verdicts)
      : job_(std::move(job)), edge_(std::move(edge)), verdicts_(verdicts) {}

  graph::JobVerdict Run(graph::JobControl* control) override {
    const graph::JobVerdict verdict = job_->Run(control);
    if (verdict != graph::JobVerdict::kUndecided) {
      verdicts_->Record(edge_, verdict == graph::JobVerdict::kConfirmed, job_->reason());
    }
    return verdict;
  }
  double work_of_checkpoint() const override { return job_->work_of_checkpoint(); }
  bool bounds_its_effort() const override { return job_->bounds_its_effort(); }
  std::string reason() const override { return job_->reason(); }

 private:
  std::unique_ptr<graph::ConfirmationJob> job_;
  Edge edge_;
  EdgeVerdicts* verdicts_;
};

}  // namespace

SearchedManoeuvre::SearchedManoeuvre(std::shared_ptr<Manoeuvre> manoeuvre, std::string where)
    : manoeuvre_(std::move(manoeuvre)), where_(std::move(where)) {}

bool SearchedManoeuvre::CN(const Point& v) const {
  return Guard("CN", v, [&] { return manoeuvre_->CN(v); });
}

bool SearchedManoeuvre::CN(const Edge& edge) const {
  return Guard("CN", edge, [&] { return manoeuvre_->CN(edge); });
}

bool SearchedManoeuvre::CS(const Point& v) const {
  return Guard("CS", v, [&] { return manoeuvre_->CS(v); });
}

bool SearchedManoeuvre::CS(const Edge& edge) const {
  const std::optional<bool> possible = verdicts_.On(edge);
  if (possible) return *possible && Explorable(edge);
  return Guard("CS", edge, [&] { return manoeuvre_->CS(edge); });
}

bool SearchedManoeuvre::Explorable(const Point& v) const {
  return Guard("Explorable", v, [&] { return manoeuvre_->Explorable(v); });
}

bool SearchedManoeuvre::Explorable(const Edge& edge) const {
  if (!verdicts_.On(edge).value_or(true)) return false;
  return Guard("Explorable", edge, [&] { return manoeuvre_->Explorable(edge); });
}

Point SearchedManoeuvre::ExtendTowards(const Point& v0, const Point& v1) const {
  return Guard("ExtendTowards", v0, [&] { return manoeuvre_->ExtendTowards(v0, v1); });
}

Point SearchedManoeuvre::ReverseExtend(const Point& v0, const Point& v1) const {
  return Guard("ReverseExtend", v0, [&] { return manoeuvre_->ReverseExtend(v0, v1); });
}

std::optional<Point> SearchedManoeuvre::FindLaunchPoint(const Point& v, const Point& v1) const {
  return Guard("FindLaunchPoint", v, [&] { return manoeuvre_->FindLaunchPoint(v, v1); });
}

std::optional<Point> SearchedManoeuvre::FindLandingPoint(const Point& v, const Point& v1) const {
  return Guard("FindLandingPoint", v, [&] { return manoeuvre_->FindLandingPoint(v, v1); });
}

std::vector<Point> SearchedManoeuvre::TransitionFrom(const Point& v) const {
  return Guard("TransitionFrom", v, [&] { return manoeuvre_->TransitionFrom(v); });
}

double SearchedManoeuvre::ExpectedDuration(const Edge& edge) const {
  return Guard("ExpectedDuration", edge, [&] { return manoeuvre_->ExpectedDuration(edge); });
}

std::unique_ptr<graph::ConfirmationJob> SearchedManoeuvre::SpawnConfirmationJob(
    const Edge& edge) const {
  auto job =
      Guard("SpawnConfirmationJob", edge, [&] { return manoeuvre_->SpawnConfirmationJob(edge); });
  if (!job) return nullptr;
  return std::make_unique<RecordedJob>(std::move(job), edge, &verdicts_);
}

void SearchedManoeuvre::Forbid(const Edge& edge, const std::string& reason, bool everywhere) {
  verdicts_.Record(edge, false, reason);
  if (everywhere) manoeuvre_->RefuteEverywhere(edge);
}

void SearchedManoeuvre::Forget(const Edge& edge) { verdicts_.Forget(edge); }

template <typename At, typename Call>
std::invoke_result_t<Call> SearchedManoeuvre::Guard(const char* function, const At& at,
                                                    const Call& call) const {
  try {
    return call();
  } catch (const Cancelled&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: action '{}': {} failed for {}: {}", where_, name(), function,
                                 Describe(at), OneLine(error.what())));
  } catch (...) {
    throw InputError(fmt::format("{}: action '{}': {} failed for {}, expected no exception", where_,
                                 name(), function, Describe(at)));
  }
}

}  // namespace possibility::actions
