#include "collocation/kkt/rank_update.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;

MatrixXd RandomMatrix(int rows, int columns, std::mt19937* random) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(*random); });
}

TEST(LowerProducts, AgreeWithAPlainProductForEverySize) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> any_depth(1, 40);
  for (const LowerProduct subtract : LowerProducts()) {
    for (int size = 1; size <= 70; ++size) {
      const int depth = any_depth(random);
      const int stride = size + static_cast<int>(random() % 5);
      const MatrixXd a = RandomMatrix(stride, depth, &random);
      const MatrixXd b = RandomMatrix(stride, depth, &random);
      const MatrixXd before = RandomMatrix(stride, size, &random);
      MatrixXd c = before;
      subtract(size, depth, stride, a.data(), b.data(), c.data());
      const MatrixXd expected =
          before.topRows(size) - a.topRows(size) * b.topRows(size).transpose();
      for (int column = 0; column < size; ++column) {
        for (int row = column; row < size; ++row) {
          ASSERT_NEAR(c(row, column), expected(row, column), 1e-12) << size << " " << depth;
        }
      }
      // Nothing below the last row.
      EXPECT_EQ(c.bottomRows(stride - size), before.bottomRows(stride - size));
    }
  }
}

TEST(LowerProducts, GiveTheSameBitsAgain) {
  std::mt19937 random(2);
  const MatrixXd a = RandomMatrix(50, 20, &random);
  const MatrixXd b = RandomMatrix(50, 20, &random);
  const MatrixXd before = RandomMatrix(50, 50, &random);
  for (const LowerProduct subtract : LowerProducts()) {
    MatrixXd first = before, second = before;
    subtract(50, 20, 50, a.data(), b.data(), first.data());
    subtract(50, 20, 50, a.data(), b.data(), second.data());
    EXPECT_EQ(first, second);
  }
}

}  // namespace
}  // namespace possibility::collocation
