// Minima and saddles, against dense eigenvalues of the Hessian along the active constraints.
#include "collocation/diagnosis/stationary_point.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <map>
#include <random>

#include "tests/collocation/solver/pendulum_chain.h"
#include "tests/collocation/solver/quadratic_program.h"
#include "tests/collocation/solver/small_program.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Extremum = StationaryPoint;
using Numbers = std::vector<Hyper>;

const std::pair<double, double> kAnyNumber{-kUnbounded, kUnbounded};

StationaryPoint SolveAndClassify(SmallProgram program, const VectorXd& start) {
  const SolverResult result = Solve(&program, {start, {}, {}, {}});
  EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
  return ClassifyStationaryPoint(&program, result, {});
}

/// A point given by hand, with multipliers of rows; those of bounds are zero.
StationaryPoint ClassifyAt(SmallProgram program, const VectorXd& x, const VectorXd& multipliers) {
  SolverResult result;
  result.status = SolverStatus::kSolved;
  result.x = x;
  result.constraints.setZero(program.num_constraints());
  program.Constraints(x, &result.constraints);
  result.constraint_multipliers = multipliers;
  result.lower_multipliers.setZero(x.size());
  result.upper_multipliers.setZero(x.size());
  return ClassifyStationaryPoint(&program, result, {});
}

TEST(StationaryPointTest, AMaximumWhereTheSolverStartedIsASaddle) {
  const SmallProgram hill({{-1, 1}}, [](const Numbers& x) { return -(x[0] * x[0]); });
  EXPECT_EQ(SolveAndClassify(hill, VectorXd::Zero(1)), Extremum::kSaddle);
  // From beside it, the solver goes to a bound.
  EXPECT_EQ(SolveAndClassify(hill, VectorXd::Constant(1, 0.1)), Extremum::kMinimum);
}

TEST(StationaryPointTest, AnIndefiniteHessianIsAMinimumWhereItsRowsAllowNoDescent) {
  // x^2 - y^2 on the line y = x / 2: 3/4 x^2; on the line y = 2 x: -3 x^2.
  for (const auto& [slope, kind] : {std::pair{0.5, Extremum::kMinimum}, {2.0, Extremum::kSaddle}}) {
    SmallProgram line({kAnyNumber, kAnyNumber},
                      [](const Numbers& x) { return x[0] * x[0] - x[1] * x[1]; });
    line.Add(0, 0, [slope = slope](const Numbers& x) { return x[1] - slope * x[0]; });
    EXPECT_EQ(ClassifyAt(line, VectorXd::Zero(2), VectorXd::Zero(1)), kind) << slope;
  }
}

TEST(StationaryPointTest, TheCurvatureOfConstraintsCounts) {
  // The vertex of a parabola is the nearest point to (0, 1) unless the parabola is steep.
  for (const auto& [curvature, kind] :
       {std::pair{0.4, Extremum::kMinimum}, {0.6, Extremum::kSaddle}}) {
    SmallProgram parabola({kAnyNumber, kAnyNumber}, [](const Numbers& x) {
      return x[0] * x[0] + (x[1] - 1.0) * (x[1] - 1.0);
    });
    parabola.Add(0, 0, [curvature = curvature](const Numbers& x) {
      return x[1] - curvature * (x[0] * x[0]);
    });
    // df/dy + multiplier = 0
    EXPECT_EQ(ClassifyAt(parabola, VectorXd::Zero(2), VectorXd::Constant(1, 2)), kind) << curvature;
  }
}

TEST(StationaryPointTest, AFlatDirectionIsUnknown) {
  const SmallProgram valley({kAnyNumber, kAnyNumber},
                            [](const Numbers& x) { return (x[0] - x[1]) * (x[0] - x[1]); });
  EXPECT_EQ(SolveAndClassify(valley, VectorXd::Ones(2)), Extremum::kUnknown);
  const SmallProgram quartic({kAnyNumber},
                             [](const Numbers& x) { return -((x[0] * x[0]) * (x[0] * x[0])); });
  EXPECT_EQ(ClassifyAt(quartic, VectorXd::Zero(1), {}), Extremum::kUnknown);
}

/// x >= 0 holds at the stationary point 0 without a multiplier. Only one side is feasible.
TEST(StationaryPointTest, ABoundWithoutAMultiplierProvesNothingByItself) {
  const std::pair<double, double> positive{0, kUnbounded};
  const SmallProgram up({positive}, [](const Numbers& x) { return x[0] * x[0]; });
  EXPECT_EQ(ClassifyAt(up, VectorXd::Zero(1), {}), Extremum::kMinimum);
  // Downhill on the feasible side, but along the bound there is no direction at all.
  const SmallProgram down({positive}, [](const Numbers& x) { return -(x[0] * x[0]); });
  EXPECT_EQ(ClassifyAt(down, VectorXd::Zero(1), {}), Extremum::kUnknown);
  // x y has descent for x > 0 and y < 0 only if the bound is left.
  const SmallProgram twist({positive, kAnyNumber}, [](const Numbers& x) { return x[0] * x[1]; });
  EXPECT_EQ(ClassifyAt(twist, VectorXd::Zero(2), {}), Extremum::kUnknown);
  // Here it need not be left.
  const SmallProgram along({positive, kAnyNumber},
                           [](const Numbers& x) { return x[0] * x[0] - x[1] * x[1]; });
  EXPECT_EQ(ClassifyAt(along, VectorXd::Zero(2), {}), Extremum::kSaddle);
}

TEST(StationaryPointTest, DependentRowsMayProveAMinimumButNoSaddle) {
  for (const auto& [sign, kind] :
       {std::pair{1.0, Extremum::kMinimum}, {-1.0, Extremum::kUnknown}}) {
    SmallProgram twice({kAnyNumber, kAnyNumber}, [sign = sign](const Numbers& x) {
      return sign * (x[1] * x[1]) - x[0] * x[0];
    });
    for (const double factor : {1.0, 3.0}) {
      twice.Add(0, 0, [factor](const Numbers& x) { return factor * x[0]; });
    }
    EXPECT_EQ(ClassifyAt(twice, VectorXd::Zero(2), VectorXd::Zero(2)), kind) << sign;
  }
}

TEST(StationaryPointTest, APointWithoutFreedomIsAMinimum) {
  const SmallProgram fixed({{2, 2}, {0, 1}}, [](const Numbers& x) { return x[0] * x[1]; });
  EXPECT_EQ(SolveAndClassify(fixed, VectorXd::Constant(2, 0.5)), Extremum::kMinimum);
}

TEST(StationaryPointTest, UnsolvedOrWithoutExactHessianIsUnknown) {
  SmallProgram bowl({kAnyNumber}, [](const Numbers& x) { return x[0] * x[0]; });
  SolverResult result = Solve(&bowl, {VectorXd::Ones(1), {}, {}, {}});
  SolverOptions limited;
  limited.hessian = HessianMode::kLimitedMemory;
  EXPECT_EQ(ClassifyStationaryPoint(&bowl, result, {}), Extremum::kMinimum);
  EXPECT_EQ(ClassifyStationaryPoint(&bowl, result, limited), Extremum::kUnknown);
  result.status = SolverStatus::kIterationLimit;
  EXPECT_EQ(ClassifyStationaryPoint(&bowl, result, {}), Extremum::kUnknown);
}

/// Least eigenvalue of H in the directions that keep the given rows; 1 if there is no direction.
double LeastCurvature(const MatrixXd& h, const MatrixXd& rows) {
  MatrixXd directions = MatrixXd::Identity(h.rows(), h.rows());
  if (rows.rows() > 0) {
    const Eigen::FullPivLU<MatrixXd> lu(rows);
    if (lu.dimensionOfKernel() == 0) return 1;
    directions = lu.kernel();
  }
  const MatrixXd reduced = directions.transpose() * h * directions;
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(reduced).eigenvalues()[0];
}

/// Rows that hold, one below the other: `firm` for those that push.
struct DenseHold {
  MatrixXd firm, all;

  void Add(const VectorXd& row, bool pushes) {
    for (MatrixXd* rows : {&firm, &all}) {
      if (rows == &firm && !pushes) continue;
      rows->conservativeResize(rows->rows() + 1, row.size());
      rows->bottomRows(1) = row.transpose();
    }
  }
  StationaryPoint Classify(const MatrixXd& h) const {
    if (LeastCurvature(h, firm) > 0) return Extremum::kMinimum;
    return LeastCurvature(h, all) < 0 ? Extremum::kSaddle : Extremum::kUnknown;
  }
};

/// A quadratic program with a stationary point made by choosing bounds and multipliers first.
struct Made {
  MatrixXd h;
  QuadraticProgram program;
  SolverResult result;
  DenseHold hold;
};

Made MakeStationary(std::mt19937* random) {
  std::uniform_real_distribution<double> size(0.1, 1);
  const int n = 8, m = 5, num_equalities = 2;
  const MatrixXd noise = NormalMatrix(n, n, random);
  const double shift = 2 * size(*random);
  const MatrixXd h = noise + noise.transpose() + 3 * shift * MatrixXd::Identity(n, n);
  const MatrixXd a = NormalMatrix(m, n, random);
  Made made{h, {h, VectorXd::Zero(n), a}, {}, {MatrixXd(0, n), MatrixXd(0, n)}};
  SolverResult& result = made.result;
  result.status = SolverStatus::kSolved;
  result.x = NormalMatrix(n, 1, random);
  result.constraints = a * result.x;
  result.constraint_multipliers.setZero(m);
  result.lower_multipliers.setZero(n);
  result.upper_multipliers.setZero(n);
  QuadraticProgram& program = made.program;
  const auto pick = [&](int choices) { return static_cast<int>((*random)() % choices); };
  for (int i = 0; i < n; ++i) {
    program.mutable_lower()[i] = result.x[i] - size(*random);
    program.mutable_upper()[i] = result.x[i] + size(*random);
    const int kind = pick(8);  // 0, 1: at a bound that pushes; 2: at a bound that does not
    if (kind > 2) continue;
    (kind == 0 ? program.mutable_lower() : program.mutable_upper())[i] = result.x[i];
    if (kind < 2) {
      (kind == 0 ? result.lower_multipliers : result.upper_multipliers)[i] = size(*random);
    }
    made.hold.Add(VectorXd::Unit(n, i), kind < 2);
  }
  for (int row = 0; row < m; ++row) {
    const int kind = row < num_equalities ? 3 : pick(4);
    const double value = result.constraints[row];
    program.mutable_row_lower()[row] = kind == 0 || kind == 3 ? value : value - size(*random);
    program.mutable_row_upper()[row] =
        (kind == 1 || row < num_equalities) ? value : value + size(*random);
    if (row >= num_equalities && kind == 3) {  // does not hold
      program.mutable_row_lower()[row] = value - 1;
      continue;
    }
    if (kind < 2) result.constraint_multipliers[row] = (kind == 0 ? -1 : 1) * size(*random);
    if (row < num_equalities) result.constraint_multipliers[row] = size(*random);
    if (kind != 2) made.hold.Add(a.row(row), true);
  }
  return made;
}

TEST(StationaryPointTest, AgreesWithDenseEigenvaluesOfRandomQuadraticPrograms) {
  std::mt19937 random(5);
  std::map<StationaryPoint, int> count;
  for (int sample = 0; sample < 200; ++sample) {
    Made made = MakeStationary(&random);
    const StationaryPoint expected = made.hold.Classify(made.h);
    EXPECT_EQ(ClassifyStationaryPoint(&made.program, made.result, {}), expected) << sample;
    ++count[expected];
  }
  for (const Extremum kind : {Extremum::kMinimum, Extremum::kSaddle, Extremum::kUnknown}) {
    EXPECT_GE(count[kind], 10) << StationaryPointName(kind);
  }
}

TEST(StationaryPointTest, AgreesWithDenseEigenvaluesWhereIpoptEnds) {
  std::mt19937 random(11);
  const int n = 7, m = 3;
  int active = 0;
  for (int sample = 0; sample < 50; ++sample) {
    const MatrixXd noise = NormalMatrix(n, n, &random);
    const MatrixXd h = noise + noise.transpose(), a = NormalMatrix(m, n, &random);
    QuadraticProgram program(h, NormalMatrix(n, 1, &random), a);
    program.mutable_lower().setConstant(-1);
    program.mutable_upper().setConstant(1);
    program.mutable_row_lower() << 0, -1, -kUnbounded;
    program.mutable_row_upper() << 0, 1, 0.5;
    const SolverResult result = Solve(&program, {VectorXd::Zero(n), {}, {}, {}});
    ASSERT_TRUE(result.succeeded()) << result.message;
    DenseHold hold{MatrixXd(0, n), MatrixXd(0, n)};
    for (int i = 0; i < n; ++i) {
      if (std::abs(result.x[i]) > 1 - 1e-5) hold.Add(VectorXd::Unit(n, i), true);
    }
    for (int row = 0; row < m; ++row) {
      const double g = result.constraints[row];
      const bool holds =
          g < program.constraint_lower()[row] + 1e-5 || g > program.constraint_upper()[row] - 1e-5;
      if (holds) hold.Add(a.row(row), true);
    }
    active += static_cast<int>(hold.all.rows());
    EXPECT_EQ(ClassifyStationaryPoint(&program, result, {}), hold.Classify(h)) << sample;
  }
  EXPECT_GT(active, 50 * 3);  // bounds decide
}

TEST(StationaryPointTest, TheMotionOfAPendulumChainIsAMinimum) {
  PendulumChain chain({.pendulums = 3, .knots = 40, .target = 0.5});
  const SolverResult result = Solve(&chain, {chain.Guess(), {}, {}, {}});
  ASSERT_TRUE(result.succeeded()) << result.message;
  EXPECT_EQ(ClassifyStationaryPoint(&chain, result, {}), Extremum::kMinimum);
}

TEST(StationaryPointTest, ACancelledCheckThrows) {
  PendulumChain chain({.pendulums = 3, .knots = 40, .target = 0.5});
  const SolverResult result = Solve(&chain, {chain.Guess(), {}, {}, {}});
  const CancellationToken cancelled([] { return false; });
  EXPECT_THROW(ClassifyStationaryPoint(&chain, result, {}, cancelled), Cancelled);
}

}  // namespace
}  // namespace possibility::collocation
