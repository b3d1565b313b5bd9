#pragma once

#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "actions/conditions/edge_verdicts.h"
#include "actions/conditions/manoeuvre.h"
#include "common/cancellation_token.h"
#include "graph/action/action.h"

namespace possibility::actions {

/// A manoeuvre during a search: its conditions combined with the verdicts of its jobs and of the
/// planner. An exception from a condition or an extension becomes an InputError of one line that
/// begins with `where` and names the action, the function and the pose. Cancelled passes through.
/// Exceptions from jobs and motions stay as they are: they cost an edge, not the plan.
///
/// One thread explores. Jobs, `Motion` and the verdicts are used from several threads at once.
class SearchedManoeuvre final : public graph::NonholonomicAction {
 public:
  explicit SearchedManoeuvre(std::shared_ptr<Manoeuvre> manoeuvre, std::string where = {});

  std::string name() const override { return manoeuvre_->name(); }
  std::string plan_action() const { return manoeuvre_->plan_action(); }
  int from() const { return manoeuvre_->from(); }
  int to() const { return manoeuvre_->to(); }
  const Manoeuvre& manoeuvre() const { return *manoeuvre_; }

  bool CN(const graph::Point& v) const override;
  bool CN(const graph::Edge& edge) const override;
  bool CS(const graph::Point& v) const override;
  /// The verdict on the edge if there is one, otherwise the manoeuvre's C_S. A confirmed edge must
  /// still be explorable.
  bool CS(const graph::Edge& edge) const override;
  bool Explorable(const graph::Point& v) const override;
  /// False for refuted edges.
  bool Explorable(const graph::Edge& edge) const override;
  graph::Point ExtendTowards(const graph::Point& v0, const graph::Point& v1) const override;
  graph::Point ReverseExtend(const graph::Point& v0, const graph::Point& v1) const override;
  std::optional<graph::Point> FindLaunchPoint(const graph::Point& v,
                                              const graph::Point& v1) const override;
  std::optional<graph::Point> FindLandingPoint(const graph::Point& v,
                                               const graph::Point& v1) const override;
  std::vector<graph::Point> TransitionFrom(const graph::Point& v) const override;
  bool IsReversible() const override { return manoeuvre_->IsReversible(); }
  double ExpectedDuration(const graph::Edge& edge) const override;
  /// The manoeuvre's job. Its verdict is recorded here; the job must not outlive this object.
  std::unique_ptr<graph::ConfirmationJob> SpawnConfirmationJob(
      const graph::Edge& edge) const override;
  double cycle_budget() const override { return manoeuvre_->cycle_budget(); }

  /// Manoeuvre::Motion.
  std::vector<Phase> Motion(const graph::Edge& edge, const CancellationToken& cancellation) const {
    return manoeuvre_->Motion(edge, cancellation);
  }

  /// Marks an edge as impossible because its motion failed. `everywhere`: the fault does not depend
  /// on the place, so the manoeuvre is told as well.
  void Forbid(const graph::Edge& edge, const std::string& reason, bool everywhere);
  /// Nobody has decided on the edge any more: its job may be asked again.
  void Forget(const graph::Edge& edge);
  /// Edges that jobs refuted or the planner forbade, in that order.
  std::vector<Refusal> Refusals() const { return verdicts_.Refusals(); }

 private:
  template <typename At, typename Call>
  std::invoke_result_t<Call> Guard(const char* function, const At& at, const Call& call) const;

  std::shared_ptr<Manoeuvre> manoeuvre_;
  std::string where_;
  mutable EdgeVerdicts verdicts_;  ///< jobs of a const action record theirs
};

}  // namespace possibility::actions
