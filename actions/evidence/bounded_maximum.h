#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace possibility::actions {

/// Bernstein coefficients of polynomials over an interval: one row per polynomial. Values are
/// convex combinations of the columns; at the ends they equal the first and the last column (Farin
/// 2002, Curves and Surfaces for CAGD, chapter 5).
template <int Rows, int Columns>
struct ControlPolygon {
  Eigen::Matrix<double, Rows, Columns> points;

  auto front() const { return points.col(0); }
  auto back() const { return points.col(Columns - 1); }

  /// Coefficients of the derivative; `duration`: s, of the interval.
  ControlPolygon<Rows, Columns - 1> Rate(double duration) const {
    return {(points.template rightCols<Columns - 1>() - points.template leftCols<Columns - 1>()) *
            ((Columns - 1) / duration)};
  }

  /// Coefficients over the first and the second half of the interval (de Casteljau).
  void Halve(ControlPolygon* first, ControlPolygon* second) const {
    Eigen::Matrix<double, Rows, Columns> level = points;
    for (int k = 0; k < Columns; ++k) {
      first->points.col(k) = level.col(0);
      second->points.col(Columns - 1 - k) = level.col(Columns - 1 - k);
      for (int j = 0; j + 1 < Columns - k; ++j) {
        level.col(j) = (0.5 * (level.col(j) + level.col(j + 1))).eval();
      }
    }
  }
};

/// Maximum of a function, from BoundedMaximum.
struct Maximum {
  double value = 0;
  double place = 0;  ///< as a fraction of the interval
};

/// The maximum of a function over an interval, to within `accuracy`. If the maximum is at most
/// `enough` + `accuracy`, the result may be any lower value of the function. `Piece`: the function
/// over an interval. Front() and Back() are its values at the ends, Bound() is at least its
/// greatest value and tends to it as the interval shrinks, Halve(&first, &second) gives it over the
/// halves.
template <typename Piece>
class BoundedMaximum {
 public:
  BoundedMaximum(const Piece& piece, double enough, double accuracy)
      : enough_(enough), accuracy_(accuracy) {
    best_ = piece.Front() >= piece.Back() ? Maximum{piece.Front(), 0} : Maximum{piece.Back(), 1};
    Raise(piece, 0, 1, kDeepest);
  }

  const Maximum& best() const { return best_; }

 private:
  // If a function never comes near its bound, the bound is used.
  static constexpr int kDeepest = 40;
  static constexpr int kMostPieces = 10000;

  void Raise(const Piece& piece, double begin, double end, int depth) {
    const double bound = piece.Bound();
    if (bound <= std::max(enough_, best_.value + accuracy_ * std::max(1.0, best_.value))) return;
    if (depth == 0 || ++pieces_ > kMostPieces || !std::isfinite(bound)) {
      best_ = {bound, end};
      return;
    }
    Piece first;
    Piece second;
    piece.Halve(&first, &second);
    const double middle = (begin + end) / 2;
    if (first.Back() > best_.value) best_ = {first.Back(), middle};
    Raise(first, begin, middle, depth - 1);
    Raise(second, middle, end, depth - 1);
  }

  double enough_;
  double accuracy_;
  Maximum best_;
  int pieces_ = 0;
};

}  // namespace possibility::actions
