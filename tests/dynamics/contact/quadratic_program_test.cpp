#include "dynamics/contact/quadratic_program.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>

#include "tests/dynamics/random_robot.h"

namespace possibility::dynamics {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd RandomMatrix(std::mt19937* random, int rows, int cols) {
  MatrixXd m(rows, cols);
  for (int c = 0; c < cols; ++c) m.col(c) = RandomVector(random, rows, 1);
  return m;
}

QuadraticProgram RandomProgram(std::mt19937* random, int n, int equalities, int inequalities) {
  QuadraticProgram program;
  const MatrixXd root = RandomMatrix(random, n, n);
  program.H = root * root.transpose() + 0.1 * MatrixXd::Identity(n, n);
  program.g = RandomVector(random, n, 3);
  program.E = RandomMatrix(random, equalities, n);
  program.e = RandomVector(random, equalities, 1);
  program.C = RandomMatrix(random, inequalities, n);
  program.d = RandomVector(random, inequalities, 1);
  return program;
}

/// Shifts the bounds so that a random point is feasible, with the inequalities in `tight` active.
void MakeFeasible(QuadraticProgram* program, std::mt19937* random, int tight) {
  const VectorXd inside = RandomVector(random, static_cast<int>(program->g.size()), 1);
  program->e = program->E * inside;
  program->d = program->C * inside;
  for (Eigen::Index i = tight; i < program->d.size(); ++i) program->d[i] += Uniform(random, 0, 1);
}

/// Sufficient conditions of the minimum of a convex program.
void ExpectOptimal(const QuadraticProgram& p, const QuadraticProgramSolution& s) {
  ASSERT_EQ(s.status, QuadraticProgramStatus::kSolved);
  const double scale = 1 + s.x.norm();
  VectorXd gradient = p.H * s.x + p.g;
  double force = 1 + p.g.norm();
  if (p.e.size() > 0) {
    gradient += p.E.transpose() * s.y;
    force += s.y.norm();
    EXPECT_LT((p.E * s.x - p.e).cwiseAbs().maxCoeff(), 1e-9 * scale);
  }
  if (p.d.size() > 0) {
    gradient += p.C.transpose() * s.z;
    force += s.z.norm();
    EXPECT_LT((p.C * s.x - p.d).maxCoeff(), 1e-9 * scale);
    EXPECT_GE(s.z.minCoeff(), 0);
    EXPECT_LT((p.C * s.x - p.d).cwiseProduct(s.z).cwiseAbs().maxCoeff(), 1e-8 * scale * force);
  }
  EXPECT_LT(gradient.norm(), 1e-8 * force);
}

/// The least cost over all subsets of active inequalities whose equality-constrained minimum is
/// feasible; none if there is no such subset. Needs generic data with n >= equalities.
std::optional<double> BruteForceCost(const QuadraticProgram& p) {
  std::optional<double> best;
  const int n = static_cast<int>(p.g.size());
  const int m = static_cast<int>(p.d.size());
  for (int subset = 0; subset < (1 << m); ++subset) {
    MatrixXd A = p.E;
    VectorXd b = p.e;
    for (int i = 0; i < m; ++i) {
      if (!(subset >> i & 1)) continue;
      A.conservativeResize(A.rows() + 1, n);
      A.bottomRows<1>() = p.C.row(i);
      b.conservativeResize(b.size() + 1);
      b[b.size() - 1] = p.d[i];
    }
    const int k = static_cast<int>(b.size());
    if (k > n) continue;
    MatrixXd kkt = MatrixXd::Zero(n + k, n + k);
    kkt << p.H, A.transpose(), A, MatrixXd::Zero(k, k);
    VectorXd right(n + k);
    right << -p.g, b;
    const VectorXd x = kkt.fullPivLu().solve(right).head(n);
    if (!x.allFinite() || (A * x - b).norm() > 1e-7) continue;
    if ((p.C * x - p.d).maxCoeff() > 1e-9) continue;
    const double cost = 0.5 * x.dot(p.H * x) + p.g.dot(x);
    if (!best || cost < *best) best = cost;
  }
  return best;
}

TEST(QuadraticProgram, MatchesBruteForceOverActiveSets) {
  std::mt19937 random(1);
  int solved = 0;
  int infeasible = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const int n = 1 + trial % 4;
    const int equalities = static_cast<int>(random() % n);
    const QuadraticProgram program = RandomProgram(&random, n, equalities, 7);
    const std::optional<double> expected = BruteForceCost(program);
    const QuadraticProgramSolution solution = Solve(program);
    if (!expected) {
      EXPECT_EQ(solution.status, QuadraticProgramStatus::kInfeasible) << trial;
      ++infeasible;
      continue;
    }
    ExpectOptimal(program, solution);
    const double cost = 0.5 * solution.x.dot(program.H * solution.x) + program.g.dot(solution.x);
    EXPECT_NEAR(cost, *expected, 1e-8 * (1 + std::abs(*expected))) << trial;
    ++solved;
  }
  EXPECT_GT(solved, 50);
  EXPECT_GT(infeasible, 50);
}

TEST(QuadraticProgram, LargerProgramsMeetTheOptimalityConditions) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 100; ++trial) {
    QuadraticProgram program = RandomProgram(&random, 24, 6, 90);
    MakeFeasible(&program, &random, 0);
    ExpectOptimal(program, Solve(program));
  }
}

TEST(QuadraticProgram, IsSolvedWithDependentRowsAndDegenerateVertices) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    QuadraticProgram program = RandomProgram(&random, 8, 6, 40);
    // The equalities have rank 3. Every other inequality is a copy or a combination. Most of them
    // pass through one point.
    program.E.bottomRows(3) = RandomMatrix(&random, 3, 3) * program.E.topRows(3);
    for (int i = 1; i < 20; i += 2) program.C.row(i) = 2 * program.C.row(i - 1);
    for (int i = 21; i < 40; i += 2) program.C.row(i) = program.C.row(i - 1) - program.C.row(i - 2);
    MakeFeasible(&program, &random, 30);
    ExpectOptimal(program, Solve(program));
  }
}

TEST(QuadraticProgram, OppositeInequalitiesActAsAnEquality) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 100; ++trial) {
    QuadraticProgram program = RandomProgram(&random, 6, 0, 8);
    program.C.bottomRows(4) = -program.C.topRows(4);
    program.d.bottomRows(4) = -program.d.topRows(4);
    const QuadraticProgramSolution solution = Solve(program);
    ExpectOptimal(program, solution);
    QuadraticProgram same = program;
    same.E = program.C.topRows(4);
    same.e = program.d.head(4);
    same.C.resize(0, 6);
    same.d.resize(0);
    EXPECT_LT((Solve(same).x - solution.x).norm(), 1e-8 * (1 + solution.x.norm()));
  }
}

TEST(QuadraticProgram, TheSolutionDoesNotDependOnTheScaleOfTheCost) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    QuadraticProgram program = RandomProgram(&random, 10, 3, 20);
    MakeFeasible(&program, &random, 5);
    const double scale = std::pow(10, Uniform(&random, -6, 6));
    const QuadraticProgramSolution reference = Solve(program);
    program.H *= scale;
    program.g *= scale;
    const QuadraticProgramSolution scaled = Solve(program);
    ASSERT_EQ(scaled.status, QuadraticProgramStatus::kSolved);
    EXPECT_LT((scaled.x - reference.x).norm(), 1e-7 * (1 + reference.x.norm()));
  }
}

TEST(QuadraticProgram, ContradictoryConstraintsAreInfeasible) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    QuadraticProgram equalities = RandomProgram(&random, 6, 4, 5);
    MakeFeasible(&equalities, &random, 0);
    equalities.E.row(3) = equalities.E.row(0) + equalities.E.row(1);
    equalities.e[3] = equalities.e[0] + equalities.e[1] + 1e-3;
    EXPECT_EQ(Solve(equalities).status, QuadraticProgramStatus::kInfeasible);

    // A positive combination of the rows adds up to 0 <= -0.01 (Farkas).
    QuadraticProgram inequalities = RandomProgram(&random, 6, 2, 5);
    inequalities.C.row(4) = -inequalities.C.topRows(4).colwise().sum();
    inequalities.d[4] = -inequalities.d.head(4).sum() - 0.01;
    EXPECT_EQ(Solve(inequalities).status, QuadraticProgramStatus::kInfeasible);
    inequalities.d[4] += 0.02;
    ExpectOptimal(inequalities, Solve(inequalities));
  }
}

TEST(QuadraticProgram, RowsOfZerosAreIgnoredOrInfeasible) {
  QuadraticProgram program;
  program.H = MatrixXd::Identity(2, 2);
  program.g = VectorXd::Constant(2, -1);
  program.C = MatrixXd::Zero(1, 2);
  program.d = VectorXd::Zero(1);
  EXPECT_TRUE(Solve(program).x.isApprox(VectorXd::Ones(2)));
  program.d[0] = -1;
  EXPECT_EQ(Solve(program).status, QuadraticProgramStatus::kInfeasible);
}

TEST(QuadraticProgram, RefusesMalformedPrograms) {
  std::mt19937 random(7);
  const QuadraticProgram good = RandomProgram(&random, 4, 1, 3);
  QuadraticProgram bad = good;
  bad.d.resize(2);
  EXPECT_THROW(Solve(bad), std::invalid_argument);
  bad = good;
  bad.E.resize(1, 3);
  EXPECT_THROW(Solve(bad), std::invalid_argument);
  bad = good;
  bad.C(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Solve(bad), std::invalid_argument);
  bad = good;
  bad.H = -bad.H;
  EXPECT_THROW(Solve(bad), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::dynamics
