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
  for (const LowerProduct subtract : LowerProducts()) {
    for (int rows = 1; rows <= 70; ++rows) {
      const int columns = 1 + static_cast<int>(random() % rows);
      const int depth = 1 + static_cast<int>(random() % 40);
      const int stride = rows + kPaddingRows + static_cast<int>(random() % 5);
      const MatrixXd a = RandomMatrix(stride, depth, &random);
      const MatrixXd b = RandomMatrix(stride, depth, &random);
      const MatrixXd before = RandomMatrix(stride, columns, &random);
      MatrixXd c = before;
      subtract({rows, columns, depth, stride}, a.data(), b.data(), c.data());
      const MatrixXd expected =
          before.topRows(rows) - a.topRows(rows) * b.topRows(columns).transpose();
      for (int column = 0; column < columns; ++column) {
        for (int row = column; row < rows; ++row) {
          ASSERT_NEAR(c(row, column), expected(row, column), 1e-12) << rows << " " << columns;
        }
      }
      // Nothing below the padding.
      const int below = stride - rows - kPaddingRows;
      EXPECT_EQ(c.bottomRows(below), before.bottomRows(below));
    }
  }
}

TEST(LowerProducts, GiveTheSameBitsAgain) {
  std::mt19937 random(2);
  const MatrixXd a = RandomMatrix(57, 20, &random);
  const MatrixXd b = RandomMatrix(57, 20, &random);
  const MatrixXd before = RandomMatrix(57, 50, &random);
  for (const LowerProduct subtract : LowerProducts()) {
    MatrixXd first = before, second = before;
    subtract({50, 50, 20, 57}, a.data(), b.data(), first.data());
    subtract({50, 50, 20, 57}, a.data(), b.data(), second.data());
    EXPECT_EQ(first, second);
  }
}

}  // namespace
}  // namespace possibility::collocation
