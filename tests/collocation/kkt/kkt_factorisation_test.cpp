#include "collocation/kkt/kkt_factorisation.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <limits>
#include <random>

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A symmetric matrix in triplets, each entry split into two at random.
struct Sample {
  int size = 0;
  int num_dual = 0;
  std::vector<int> rows, columns;
  std::vector<double> values;

  void Add(int i, int j, double value) {
    rows.push_back(i);
    columns.push_back(j);
    values.push_back(value);
  }
  MatrixXd Dense() const {
    MatrixXd dense = MatrixXd::Zero(size, size);
    for (size_t t = 0; t < rows.size(); ++t) {
      dense(rows[t], columns[t]) += values[t];
      if (rows[t] != columns[t]) dense(columns[t], rows[t]) += values[t];
    }
    return dense;
  }
};

struct Shape {
  int num_primal = 0;
  int num_dual = 0;
  int per_row = 3;
  double hessian = 1;        // size of H's diagonal; negative ones are mixed in
  double decades = 0;        // decades of bad scaling of the rows
  double dual_diagonal = 0;  // the -delta_c of the lower right block
};

Sample MakeSample(const Shape& shape, std::mt19937* random) {
  std::normal_distribution<double> normal;
  auto pick = [&](int n) { return std::uniform_int_distribution<int>(0, n - 1)(*random); };
  Sample sample;
  sample.size = shape.num_primal + shape.num_dual;
  sample.num_dual = shape.num_dual;
  std::uniform_real_distribution<double> exponent(-shape.decades, shape.decades);
  VectorXd scale(sample.size);
  for (double& s : scale) s = std::pow(10, exponent(*random));
  auto add = [&](int i, int j, double value) {
    value *= scale[i] * scale[j];
    const double share = normal(*random);
    sample.Add(std::max(i, j), std::min(i, j), value - share * value);
    sample.Add(std::max(i, j), std::min(i, j), share * value);
  };
  for (int i = 0; i < shape.num_primal; ++i) {
    add(i, i, shape.hessian * normal(*random));
    if (i > 0 && pick(2) == 0) add(i, std::max(0, i - 1 - pick(5)), normal(*random));
  }
  for (int k = 0; k < shape.num_dual; ++k) {
    const int dual = shape.num_primal + k;
    add(dual, dual, -shape.dual_diagonal);
    for (int e = 0; e < shape.per_row; ++e) {
      const int near = k * shape.num_primal / std::max(1, shape.num_dual);
      add(dual, std::min(shape.num_primal - 1, near + pick(6)), normal(*random));
    }
  }
  return sample;
}

int CountNegative(const MatrixXd& dense) {
  // Congruent scaling keeps the inertia and makes the eigenvalues accurate.
  VectorXd scale = VectorXd::Ones(dense.rows());
  MatrixXd scaled = dense;
  for (int pass = 0; pass < 20; ++pass) {
    const VectorXd largest = scaled.cwiseAbs().rowwise().maxCoeff();
    for (int i = 0; i < scale.size(); ++i) {
      if (largest[i] > 0) scale[i] /= std::sqrt(largest[i]);
    }
    scaled = scale.asDiagonal() * dense * scale.asDiagonal();
  }
  const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(scaled).eigenvalues();
  return static_cast<int>((eigenvalues.array() < 0).count());
}

double SmallestEigenvalue(const MatrixXd& dense) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(dense).eigenvalues().cwiseAbs().minCoeff();
}

/// The residual of a solve, relative row by row to |A||x| + |b|.
double BackwardError(const MatrixXd& a, const VectorXd& x, const VectorXd& b) {
  const VectorXd size = a.cwiseAbs() * x.cwiseAbs() + b.cwiseAbs();
  return ((a * x - b).cwiseAbs().array() / size.array().max(1e-300)).maxCoeff();
}

void ExpectFactorises(const Sample& sample, double threshold, double tolerance,
                      std::mt19937* random) {
  KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
  ASSERT_EQ(kkt.Factorise(sample.values.data(), threshold), KktStatus::kFactorised);
  const MatrixXd dense = sample.Dense();
  EXPECT_EQ(kkt.num_negative(), CountNegative(dense));
  std::normal_distribution<double> normal;
  VectorXd b(sample.size);
  for (double& value : b) value = normal(*random);
  VectorXd x = b;
  kkt.Solve(x.data());
  EXPECT_LT((dense * x - b).norm(), tolerance * (dense.norm() * x.norm() + b.norm()));
}

TEST(KktFactorisation, AgreesWithEigenvaluesOnRandomSystems) {
  std::mt19937 random(1);
  int checked = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Shape shape;
    shape.num_primal = 2 + static_cast<int>(random() % 60);
    shape.num_dual = static_cast<int>(random() % (shape.num_primal / 2 + 1));
    shape.dual_diagonal = trial % 2 == 0 ? 0 : 1e-8;
    shape.decades = trial % 3 == 0 ? 3 : 0;
    const Sample sample = MakeSample(shape, &random);
    SCOPED_TRACE(trial);
    // Some rows of constraints may lack independent entries. Those are for the singular tests.
    if (shape.dual_diagonal == 0) {
      const MatrixXd jacobian = sample.Dense().bottomLeftCorner(shape.num_dual, shape.num_primal);
      if (shape.num_dual > 0 && Eigen::FullPivLU<MatrixXd>(jacobian).rank() < shape.num_dual) {
        continue;
      }
    }
    ExpectFactorises(sample, 1e-8, 1e-10, &random);
    ++checked;
  }
  EXPECT_GT(checked, 250);
}

TEST(KktFactorisation, AgreesWithEigenvaluesWithoutADiagonal) {
  std::mt19937 random(2);
  int checked = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Shape shape;
    shape.num_primal = 8 + static_cast<int>(random() % 30);
    shape.num_dual = shape.num_primal;
    shape.per_row = 4;
    shape.hessian = 0;
    Sample sample = MakeSample(shape, &random);
    for (int k = 0; k < shape.num_dual; ++k) sample.Add(shape.num_primal + k, k, 2);
    if (trial % 2 == 0) sample.num_dual = 0;  // without the hint
    const MatrixXd dense = sample.Dense();
    if (SmallestEigenvalue(dense) < 1e-9) continue;
    SCOPED_TRACE(trial);
    ExpectFactorises(sample, 1e-8, 1e-9, &random);
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

TEST(KktFactorisation, LargeDenseFrontsUseEveryBlockOfPivots) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const int size : {1, 2, 31, 32, 33, 150}) {
    Sample sample;
    sample.size = size;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j <= i; ++j)
        sample.Add(i, j, i == j ? (i % 2) * normal(random) : normal(random));
    }
    if (size == 1) sample.values[0] = -2;
    SCOPED_TRACE(size);
    ExpectFactorises(sample, 1e-8, 1e-11, &random);
    ExpectFactorises(sample, 0.5, 1e-12, &random);
  }
}

TEST(KktFactorisation, SmallPivotsLateInABarrierDoNotSpoilTheInertia) {
  // Diagonals over 20 decades, as when some bounds are active and others are not.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> exponent(-10, 10);
  for (int trial = 0; trial < 100; ++trial) {
    Shape shape;
    shape.num_primal = 40;
    shape.num_dual = 15;
    shape.dual_diagonal = 1e-9;
    Sample sample = MakeSample(shape, &random);
    for (int i = 0; i < shape.num_primal; ++i) {
      sample.Add(i, i, std::pow(10, exponent(random)));
    }
    SCOPED_TRACE(trial);
    ExpectFactorises(sample, 1e-8, 1e-9, &random);
  }
}

TEST(KktFactorisation, RefactorisesOtherValuesOfTheSamePattern) {
  std::mt19937 random(5);
  Shape shape;
  shape.num_primal = 50;
  shape.num_dual = 20;
  shape.dual_diagonal = 1e-6;
  Sample sample = MakeSample(shape, &random);
  KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 30; ++trial) {
    for (double& value : sample.values) value *= std::exp(normal(random));
    ASSERT_EQ(kkt.Factorise(sample.values.data(), 1e-8), KktStatus::kFactorised);
    const MatrixXd dense = sample.Dense();
    EXPECT_EQ(kkt.num_negative(), CountNegative(dense));
    const VectorXd b = VectorXd::LinSpaced(sample.size, -1, 1);
    VectorXd x = b;
    kkt.Solve(x.data());
    EXPECT_LT(BackwardError(dense, x, b), 1e-6);
  }
}

TEST(KktFactorisation, DependentConstraintsAndEmptyRowsAreSingular) {
  std::mt19937 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    Shape shape;
    shape.num_primal = 10 + static_cast<int>(random() % 40);
    shape.num_dual = 5;
    Sample sample = MakeSample(shape, &random);
    const int copy = sample.size;  // a multiple of the last constraint, or a row of zeros
    sample.size += 1;
    sample.num_dual += 1;
    const size_t entries = sample.rows.size();
    if (trial % 2 == 0) {
      for (size_t t = 0; t < entries; ++t) {
        if (sample.rows[t] == copy - 1 && sample.columns[t] != copy - 1) {
          sample.Add(copy, sample.columns[t], -3 * sample.values[t]);
        }
      }
    }
    sample.Add(copy, copy, 0);
    KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
    SCOPED_TRACE(trial);
    EXPECT_EQ(kkt.Factorise(sample.values.data(), 1e-8), KktStatus::kSingular);
    // What Ipopt does in this case.
    for (int k = 0; k < sample.num_dual; ++k) {
      sample.Add(shape.num_primal + k, shape.num_primal + k, -1e-8);
    }
    ExpectFactorises(sample, 1e-8, 1e-9, &random);
  }
}

TEST(KktFactorisation, GivesUpBeyondItsLimitOfDelays) {
  std::mt19937 random(3);
  int delayed = 0;
  for (int k = 0; k < 30; ++k) {
    const Sample sample =
        MakeSample({.num_primal = 60, .num_dual = 40, .hessian = 1e-4, .decades = 1}, &random);
    KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
    if (kkt.Factorise(sample.values.data(), 0.5) != KktStatus::kFactorised) continue;
    const int needed = kkt.num_delayed(), negative = kkt.num_negative();
    if (needed == 0) continue;
    delayed += needed;
    kkt.LimitDelays(needed);
    EXPECT_EQ(kkt.Factorise(sample.values.data(), 0.5), KktStatus::kFactorised);
    kkt.LimitDelays(needed - 1);
    EXPECT_EQ(kkt.Factorise(sample.values.data(), 0.5), KktStatus::kGaveUp);
    kkt.LimitDelays(std::nullopt);
    EXPECT_EQ(kkt.Factorise(sample.values.data(), 0.5), KktStatus::kFactorised);
    EXPECT_EQ(kkt.num_negative(), negative);
  }
  EXPECT_GT(delayed, 30);
}

TEST(KktFactorisation, FewPivotsOfZeroColumnsAreDelayed) {
  // A coordinate that the dynamics hold at its bound: x_k+1 = x_k + h v_k, v_k+1 = v_k. The barrier
  // term on every x is so large that the rows of x carry no other information than those of v.
  std::mt19937 random(9);
  constexpr int kSteps = 60;
  constexpr double kStep = 0.01;
  Sample sample;
  sample.size = 4 * kSteps;
  sample.num_dual = 2 * kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const int x = 2 * k, v = 2 * k + 1, row = 2 * kSteps + 2 * k;
    sample.Add(x, x, 1e17);
    sample.Add(row, x, 1);
    sample.Add(row, v, -kStep);
    sample.Add(row + 1, v, 1);
    if (k == 0) continue;
    sample.Add(row, x - 2, -1);
    sample.Add(row, v - 2, -kStep);
    sample.Add(row + 1, v - 2, -1);
  }
  KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
  EXPECT_EQ(kkt.Factorise(sample.values.data(), 1e-6), KktStatus::kSingular);
  EXPECT_LT(kkt.num_delayed(), kSteps);
  for (int k = 2 * kSteps; k < sample.size; ++k) sample.Add(k, k, -1e-8);
  ExpectFactorises(sample, 1e-6, 1e-9, &random);
}

TEST(KktFactorisation, RefusesNonFiniteNumbers) {
  std::mt19937 random(7);
  Shape shape;
  shape.num_primal = 20;
  shape.num_dual = 8;
  shape.dual_diagonal = 1e-3;
  const Sample sample = MakeSample(shape, &random);
  KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<double> values = sample.values;
    values[values.size() / 2] = bad;
    EXPECT_EQ(kkt.Factorise(values.data(), 1e-8), KktStatus::kNotFinite);
    // Afterwards it works as before.
    EXPECT_EQ(kkt.Factorise(sample.values.data(), 1e-8), KktStatus::kFactorised);
  }
  VectorXd x = VectorXd::Constant(sample.size, std::nan(""));
  kkt.Solve(x.data());
  EXPECT_EQ(x, VectorXd::Zero(sample.size));
}

TEST(KktFactorisation, IsUsableAfterCancellation) {
  std::mt19937 random(8);
  Shape shape;
  shape.num_primal = 400;
  shape.num_dual = 150;
  shape.dual_diagonal = 1e-3;
  const Sample sample = MakeSample(shape, &random);
  KktFactorisation kkt(sample.size, sample.num_dual, sample.rows, sample.columns);
  int calls = 0;
  EXPECT_THROW(
      kkt.Factorise(sample.values.data(), 1e-8, CancellationToken([&] { return ++calls < 2; })),
      Cancelled);
  ASSERT_EQ(kkt.Factorise(sample.values.data(), 1e-8), KktStatus::kFactorised);
  EXPECT_EQ(kkt.num_negative(), CountNegative(sample.Dense()));
  const VectorXd b = VectorXd::Ones(sample.size);
  VectorXd x = b;
  kkt.Solve(x.data());
  EXPECT_LT((sample.Dense() * x - b).norm(), 1e-9 * b.norm());
}

TEST(KktFactorisation, RefusesAnInvalidPattern) {
  EXPECT_THROW(KktFactorisation(2, 0, {0, 2}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(KktFactorisation(2, 0, {0, -1}, {0, 1}), std::invalid_argument);
  EXPECT_THROW(KktFactorisation(2, 3, {0}, {0}), std::invalid_argument);
  EXPECT_THROW(KktFactorisation(2, 0, {0}, {0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace possibility::collocation
