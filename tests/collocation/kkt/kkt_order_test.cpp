#include "collocation/kkt/kkt_order.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>
#include <random>

#include "collocation/kkt/kkt_factorisation.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

struct ChainShape {
  int instants = 20;
  int states = 4;
  int controls = 2;
  bool periodic = false;      ///< rows couple the last state with the first
  bool has_duration = false;  ///< a variable without a time that every defect depends on
};

/// The KKT system of a linear-quadratic problem: states and controls at instants, and defects
/// x(k+1) - A x(k) - B u(k) - C u(k+1).
class Chain {
 public:
  Chain(const ChainShape& shape, std::mt19937* random) : shape_(shape), random_(random) {
    if (shape.has_duration) duration_ = AddRow(kNoTime);
    for (int k = 0; k < shape.instants; ++k) {
      for (int i = 0; i < shape.states + shape.controls; ++i) AddRow(k);
    }
    const int num_primal = size();
    for (int i = 0; i < num_primal; ++i) Couple(i, i, 3 + Normal());
    for (int k = 0; k < shape.instants; ++k) CoupleHessian(k);
    for (int k = 0; k + 1 < shape.instants; ++k) AddDefects(k);
    if (shape.periodic) AddPeriodicity();
    num_dual_ = size() - num_primal;
  }

  int size() const { return static_cast<int>(times.size()); }
  int num_dual() const { return num_dual_; }
  KktFactorisation Factorisation(std::vector<double> of_times) const {
    return KktFactorisation(size(), num_dual_, rows, columns, std::move(of_times));
  }
  std::vector<KktEdge> Edges() const {
    std::vector<KktEdge> edges;
    for (std::size_t t = 0; t < rows.size(); ++t) {
      if (rows[t] != columns[t]) edges.push_back({rows[t], columns[t], std::abs(values[t])});
    }
    return edges;
  }
  MatrixXd Dense() const {
    MatrixXd dense = MatrixXd::Zero(size(), size());
    for (std::size_t t = 0; t < rows.size(); ++t) {
      dense(rows[t], columns[t]) = dense(columns[t], rows[t]) = values[t];
    }
    return dense;
  }

  std::vector<int> rows, columns;
  std::vector<double> values, times;

 private:
  double Normal() { return std::normal_distribution<double>()(*random_); }
  int AddRow(double time) {
    times.push_back(time);
    return size() - 1;
  }
  void Couple(int row, int column, double value) {
    rows.push_back(row);
    columns.push_back(column);
    values.push_back(value);
  }
  int State(int k, int i) const {
    return (shape_.has_duration ? 1 : 0) + k * (shape_.states + shape_.controls) + i;
  }
  int Control(int k, int i) const { return State(k, shape_.states + i); }
  void CoupleHessian(int k) {
    const int width = shape_.states + shape_.controls;
    for (int i = 0; i < width; ++i) {
      for (int j = 0; j < i; ++j) Couple(State(k, i), State(k, j), 0.3 * Normal());
    }
  }
  void AddDefects(int k) {
    for (int i = 0; i < shape_.states; ++i) {
      const int row = AddRow(k + 1);
      Couple(row, State(k + 1, i), 1);
      for (int j = 0; j < shape_.states; ++j) Couple(row, State(k, j), Normal());
      for (int j = 0; j < shape_.controls; ++j) {
        Couple(row, Control(k, j), Normal());
        Couple(row, Control(k + 1, j), Normal());
      }
      if (duration_ >= 0) Couple(row, duration_, Normal());
    }
  }
  void AddPeriodicity() {
    for (int i = 0; i < shape_.states; ++i) {
      const int row = AddRow(kNoTime);
      Couple(row, State(shape_.instants - 1, i), 1);
      Couple(row, State(0, i), -1 + 0.1 * Normal());
    }
  }

  ChainShape shape_;
  std::mt19937* random_;
  int duration_ = -1;
  int num_dual_ = 0;
};

ChainShape RandomShape(std::mt19937* random) {
  const auto pick = [random](int low, int high) {
    return std::uniform_int_distribution<int>(low, high)(*random);
  };
  return {pick(2, 12), pick(1, 5), pick(0, 3), pick(0, 1) == 1, pick(0, 1) == 1};
}

void ExpectSolves(const Chain& chain, std::vector<double> times, std::mt19937* random) {
  KktFactorisation kkt = chain.Factorisation(std::move(times));
  ASSERT_EQ(kkt.Factorise(chain.values.data(), 1e-6), KktStatus::kFactorised);
  const MatrixXd dense = chain.Dense();
  const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(dense).eigenvalues();
  EXPECT_EQ(kkt.num_negative(), (eigenvalues.array() < 0).count());
  std::normal_distribution<double> normal;
  VectorXd b(chain.size());
  for (double& value : b) value = normal(*random);
  VectorXd x = b;
  kkt.Solve(x.data());
  EXPECT_LT((dense * x - b).norm(), 1e-9 * (dense.norm() * x.norm() + b.norm()));
}

double FlopsOf(const Chain& chain, std::vector<double> times) {
  KktFactorisation kkt = chain.Factorisation(std::move(times));
  EXPECT_EQ(kkt.Factorise(chain.values.data(), 1e-6), KktStatus::kFactorised);
  return kkt.flops();
}

TEST(KktPairs, OrdersHoldEveryRowOnceAndKeepPairsTogether) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Chain chain(RandomShape(&random), &random);
    const KktPairs pairs(chain.size(), chain.num_dual(), chain.Edges(), chain.times);
    const std::optional<std::vector<int>> along_time = pairs.OrderAlongTime();
    for (std::vector<int> order : {pairs.OrderByDegree(), pairs.OrderByTime().value(),
                                   along_time.value_or(pairs.OrderByDegree())}) {
      std::sort(order.begin(), order.end());
      std::vector<int> all(chain.size());
      std::iota(all.begin(), all.end(), 0);
      EXPECT_EQ(order, all);
    }
  }
}

/// A pair stands at the instant of its row that is no dual one, unless a far coupling has taken its
/// time away.
TEST(KktPairs, ByTimeOneInstantFollowsTheOther) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 100; ++trial) {
    ChainShape shape = RandomShape(&random);
    shape.periodic = false;
    const Chain chain(shape, &random);
    const std::vector<int> order =
        KktPairs(chain.size(), chain.num_dual(), chain.Edges(), chain.times).OrderByTime().value();
    double last = -1;
    bool at_end = false;  // only rows without a time are left
    for (const int row : order) {
      if (row >= chain.size() - chain.num_dual()) continue;
      const double time = chain.times[row];
      if (std::isnan(time)) {
        at_end = true;
        continue;
      }
      EXPECT_FALSE(at_end);
      EXPECT_GE(time, last);
      last = time;
    }
  }
}

TEST(KktPairs, ALongChainHasAnOrderAlongTime) {
  std::mt19937 random(7);
  for (const bool periodic : {false, true}) {
    const Chain chain({.periodic = periodic}, &random);
    EXPECT_TRUE(
        KktPairs(chain.size(), chain.num_dual(), chain.Edges(), chain.times).OrderAlongTime());
  }
}

TEST(KktPairs, WithoutTimesThereIsNoOrderAlongTime) {
  std::mt19937 random(2);
  const Chain chain({}, &random);
  const std::vector<double> none(chain.size(), kNoTime);
  EXPECT_FALSE(KktPairs(chain.size(), chain.num_dual(), chain.Edges(), {}).OrderAlongTime());
  EXPECT_FALSE(KktPairs(chain.size(), chain.num_dual(), chain.Edges(), none).OrderAlongTime());
  EXPECT_FALSE(KktPairs(chain.size(), chain.num_dual(), chain.Edges(), none).OrderByTime());
}

TEST(KktAlongTime, RandomChainsAreSolved) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Chain chain(RandomShape(&random), &random);
    ExpectSolves(chain, chain.times, &random);
  }
}

TEST(KktAlongTime, WrongTimesDoNotChangeTheSolution) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(0, 5);
  for (int trial = 0; trial < 100; ++trial) {
    const Chain chain(RandomShape(&random), &random);
    std::vector<double> times(chain.size());
    for (double& time : times) time = uniform(random) < 1 ? kNoTime : std::floor(uniform(random));
    ExpectSolves(chain, times, &random);
  }
}

TEST(KktAlongTime, FlopsGrowWithTheNumberOfInstantsOnly) {
  std::mt19937 random(5);
  for (const bool periodic : {false, true}) {
    ChainShape shape{.instants = 40, .states = 16, .controls = 8, .periodic = periodic};
    const double flops = FlopsOf(Chain(shape, &random), Chain(shape, &random).times);
    shape.instants = 80;
    const double twice = FlopsOf(Chain(shape, &random), Chain(shape, &random).times);
    EXPECT_NEAR(twice / flops, 2, 0.2);
  }
}

/// Where one instant after the other makes small fronts, no better order is looked for: 300
/// multiplications a row cost less than the search.
TEST(KktAlongTime, TimesCostFlopsOnlyWhereFrontsAreSmall) {
  std::mt19937 random(6);
  int num_large = 0;
  for (int trial = 0; trial < 100; ++trial) {
    ChainShape shape = RandomShape(&random);
    if (trial % 2 == 1) shape.states *= 4;
    const Chain chain(shape, &random);
    const double without = FlopsOf(chain, {}), with = FlopsOf(chain, chain.times);
    EXPECT_LE(with, std::max(without, 300.0 * chain.size()));
    num_large += with > 300 * chain.size() ? 1 : 0;
  }
  EXPECT_GT(num_large, 10);
}

}  // namespace
}  // namespace possibility::collocation
