#include "graph/search/path_confirmation.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "tests/graph/scripted_job.h"
#include "tests/graph/stick_figure.h"

namespace possibility::graph {
namespace {

using test::BandAction;
using test::Ending;
using test::MakePoint;
using test::ScriptedJob;

/// An action whose edges are all indeterminate. Their jobs confirm, or never end.
class Doubtful : public BandAction {
 public:
  explicit Doubtful(Ending ending) : BandAction("doubtful", {0, 1}, 0.5, {}), ending_(ending) {}
  bool CS(const Edge&) const override { return false; }
  bool IsReversible() const override { return false; }
  std::unique_ptr<ConfirmationJob> SpawnConfirmationJob(const Edge&) const override {
    return std::make_unique<ScriptedJob>(ending_, 2);
  }

 private:
  Ending ending_;
};

/// An action that is certain of everything it finds, and of nothing that others find.
class Certain : public BandAction {
 public:
  Certain() : BandAction("certain", {0, 1}, 0.5, {}) {}
  bool CN(const Edge& edge) const override { return own.count(Key(edge)) > 0; }
  bool CS(const Edge& edge) const override { return CN(edge); }
  bool IsReversible() const override { return false; }
  using Ends = std::pair<double, double>;
  static Ends Key(const Edge& edge) { return {edge.from[0], edge.to[0]}; }
  std::map<Ends, bool> own;
};

/// Vertices at x = their number on a line of length 10, the start at 0 and the goal at 9.
class Routes : public ::testing::Test {
 protected:
  void Build(Ending ending) {
    actions_ = {std::make_shared<Doubtful>(ending), certain_};
    master_ = std::make_unique<PossibilityGraph>(actions_, &room_, MakePoint(0, 0.5),
                                                 std::vector<Point>{MakePoint(9, 0.5)});
    confirmation_ = std::make_unique<PathConfirmation>(actions_, master_.get(), &queue_, &deadline_,
                                                       &counters_);
  }
  VertexId At(double x, double z = 0.5) { return master_->VertexAt(MakePoint(x, z)); }
  EdgeId Add(int action, VertexId from, VertexId to) {
    if (action == 1) {
      certain_->own[{master_->point(from)[0], master_->point(to)[0]}] = true;
    }
    master_->Append(action, {{from, to, false}});
    return *master_->FindEdge(action, from, to);
  }
  /// Collects often enough for the jobs to get new costs.
  void CollectOften() {
    for (int i = 0; i < 60; ++i) {
      confirmation_->CollectResults();
    }
  }

  test::Room room_;
  Deadline deadline_{std::numeric_limits<double>::infinity()};
  Counters counters_;
  ConfirmationQueue queue_;
  std::shared_ptr<Certain> certain_ = std::make_shared<Certain>();
  std::vector<std::shared_ptr<const Action>> actions_;
  std::unique_ptr<PossibilityGraph> master_;
  std::unique_ptr<PathConfirmation> confirmation_;
};

TEST_F(Routes, TheCheapestRouteIsExaminedFirstAfterChangesOfTheGraph) {
  for (const bool shortcut : {false, true}) {
    queue_.CancelAll({});
    queue_.DrainFinished();
    Build(Ending::kConfirm);
    const VertexId low = At(4, 0.2);
    const VertexId high = At(4, 1.0);
    const VertexId detour = At(5, 0);
    const EdgeId by_low = Add(0, master_->start(), low);
    const EdgeId low_on = Add(1, low, master_->goals()[0]);
    const EdgeId by_high = Add(0, master_->start(), high);
    const EdgeId away = Add(1, high, detour);
    const EdgeId back = Add(1, detour, master_->goals()[0]);
    EXPECT_FALSE(confirmation_->ConfirmPath({by_low, low_on}));
    EXPECT_FALSE(confirmation_->ConfirmPath({by_high, away, back}));
    if (shortcut) {
      master_->Remove(low_on);  // the low route is refuted: the high route becomes the cheapest
    }
    CollectOften();
    EXPECT_TRUE(queue_.RunTurn(deadline_));
    confirmation_->CollectResults();
    EXPECT_TRUE(queue_.RunTurn(deadline_));
    confirmation_->CollectResults();
    const std::vector<ConfirmationReport> reports = confirmation_->TakeReports();
    ASSERT_EQ(reports.size(), 2);
    EXPECT_EQ(reports[0].points.to, master_->point(shortcut ? high : low));
    EXPECT_EQ(reports[1].points.to, master_->point(shortcut ? low : high));
    EXPECT_FALSE(master_->topology().removed(by_low));
    EXPECT_FALSE(master_->topology().removed(by_high));
  }
}

TEST_F(Routes, AJobIsCancelledOnceConfirmedEdgesAreAsQuick) {
  for (const double height : {0.5, 0.9}) {  // on the straight line, or beside it
    Build(Ending::kNever);
    const VertexId middle = At(2, height);
    const VertexId end = At(4);
    const EdgeId doubtful = Add(0, master_->start(), end);
    const EdgeId first = Add(1, master_->start(), middle);
    const EdgeId second = Add(1, middle, end);
    EXPECT_FALSE(confirmation_->ConfirmPath({doubtful}));
    CollectOften();
    EXPECT_TRUE(confirmation_->TakeReports().empty()) << "nothing is confirmed yet";
    EXPECT_TRUE(confirmation_->ConfirmPath({first, second}));
    CollectOften();
    const std::vector<ConfirmationReport> reports = confirmation_->TakeReports();
    EXPECT_EQ(reports.size(), height == 0.5 ? 1 : 0);
    for (const ConfirmationReport& report : reports) {
      EXPECT_EQ(report.outcome, JobOutcome::kCancelled);
      EXPECT_EQ(report.reason, "confirmed edges lead the same way as quickly");
    }
    EXPECT_TRUE(master_->topology().removed(doubtful));
    EXPECT_EQ(master_->possibility(doubtful), Possibility::kIndeterminate);
    confirmation_->CancelJobs();
    EXPECT_EQ(confirmation_->TakeReports().size(), height == 0.5 ? 0 : 1);
  }
}

}  // namespace
}  // namespace possibility::graph
