#include "collocation/kkt/vector_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>
#include <vector>

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kLongest = 70;

MatrixXd RandomMatrix(int rows, int columns, std::mt19937* random) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(*random); });
}

int RandomUpTo(int most, std::mt19937* random) {
  return 1 + static_cast<int>((*random)() % static_cast<unsigned>(most));
}

TEST(VectorKernels, ProductsAgreeWithAPlainProductForEverySize) {
  std::mt19937 random(1);
  for (const VectorKernels& kernels : AvailableKernels()) {
    for (int rows = 1; rows <= kLongest; ++rows) {
      const int columns = RandomUpTo(rows, &random);
      const int depth = RandomUpTo(40, &random);
      const int stride = rows + kPaddingRows + static_cast<int>(random() % 5);
      const MatrixXd a = RandomMatrix(stride, depth, &random);
      const MatrixXd b = RandomMatrix(stride, depth, &random);
      const MatrixXd before = RandomMatrix(stride, columns, &random);
      MatrixXd c = before;
      kernels.subtract_product({rows, columns, depth, stride}, a.data(), b.data(), c.data());
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

TEST(VectorKernels, FindTheLargestMagnitudeAtEveryPlace) {
  for (const VectorKernels& kernels : AvailableKernels()) {
    EXPECT_EQ(kernels.largest_magnitude(nullptr, 0), 0);
    for (int size = 1; size <= kLongest; ++size) {
      for (int place = 0; place < size; ++place) {
        VectorXd x = VectorXd::LinSpaced(size, -1, 1);
        x[place] = place % 2 == 0 ? 3 : -3;
        ASSERT_EQ(kernels.largest_magnitude(x.data(), size), 3) << size << " " << place;
      }
    }
  }
}

TEST(VectorKernels, ScaleAndCopyWithinTheirSize) {
  std::mt19937 random(2);
  for (const VectorKernels& kernels : AvailableKernels()) {
    for (int size = 0; size <= kLongest; ++size) {
      const VectorXd before = RandomMatrix(size + 1, 1, &random);
      VectorXd x = before;
      VectorXd copy = VectorXd::Constant(size + 1, 7);
      kernels.scale(0.5, size, x.data(), copy.data());
      EXPECT_EQ(x.head(size), 0.5 * before.head(size));
      EXPECT_EQ(copy.head(size), before.head(size));
      EXPECT_EQ(x[size], before[size]);
      EXPECT_EQ(copy[size], 7);
    }
  }
}

TEST(VectorKernels, ScalePairsAndCopyWithinTheirSize) {
  std::mt19937 random(3);
  const Eigen::Matrix2d d{{0.5, -2}, {-2, 0.25}};
  for (const VectorKernels& kernels : AvailableKernels()) {
    for (int size = 0; size <= kLongest; ++size) {
      const MatrixXd before = RandomMatrix(size + 1, 2, &random);
      MatrixXd x = before;
      MatrixXd copy = MatrixXd::Constant(size + 1, 2, 7);
      kernels.scale_pair({d(0, 0), d(0, 1), d(1, 1)}, size, x.col(0).data(), x.col(1).data(),
                         copy.col(0).data(), copy.col(1).data());
      EXPECT_TRUE(x.topRows(size).isApprox(before.topRows(size) * d, 1e-14));
      EXPECT_EQ(copy.topRows(size), before.topRows(size));
      EXPECT_EQ(x.row(size), before.row(size));
      EXPECT_TRUE((copy.row(size).array() == 7).all());
    }
  }
}

/// A random panel, and its matrix filled up with columns of the identity.
struct Triangle {
  Triangle(int rows, int columns, std::mt19937* random) : matrix(MatrixXd::Identity(rows, rows)) {
    for (int k = 0; k < columns; ++k) {
      const VectorXd below = 0.2 * RandomMatrix(rows - k - 1, 1, random);
      values.insert(values.end(), below.begin(), below.end());
      matrix.col(k).tail(rows - k - 1) = below;
    }
  }

  MatrixXd matrix;
  std::vector<double> values;
};

TEST(VectorKernels, SolvesInvertTheTriangleForEverySize) {
  std::mt19937 random(4);
  for (const VectorKernels& kernels : AvailableKernels()) {
    for (int rows = 1; rows <= kLongest; ++rows) {
      const int columns = RandomUpTo(rows, &random);
      const Triangle triangle(rows, columns, &random);
      const FactorPanel panel = {rows, columns, triangle.values.data()};
      ASSERT_EQ(panel.entries(), triangle.values.size());
      const VectorXd b = RandomMatrix(rows, 1, &random);
      VectorXd x = b;
      kernels.solve_down(panel, x.data());
      EXPECT_TRUE((triangle.matrix * x).isApprox(b, 1e-10)) << rows << " " << columns;
      x = b;
      kernels.solve_up(panel, x.data());
      EXPECT_TRUE((triangle.matrix.transpose() * x).isApprox(b, 1e-10)) << rows << " " << columns;
    }
  }
}

TEST(VectorKernels, ProductsGiveTheSameBitsAgain) {
  std::mt19937 random(5);
  const MatrixXd a = RandomMatrix(57, 20, &random);
  const MatrixXd b = RandomMatrix(57, 20, &random);
  const MatrixXd before = RandomMatrix(57, 50, &random);
  for (const VectorKernels& kernels : AvailableKernels()) {
    MatrixXd first = before, second = before;
    kernels.subtract_product({50, 50, 20, 57}, a.data(), b.data(), first.data());
    kernels.subtract_product({50, 50, 20, 57}, a.data(), b.data(), second.data());
    EXPECT_EQ(first, second);
  }
}

}  // namespace
}  // namespace possibility::collocation
