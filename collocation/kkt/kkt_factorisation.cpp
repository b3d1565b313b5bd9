#include "collocation/kkt/kkt_factorisation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace possibility::collocation {
namespace {

constexpr int kScalingPasses = 4;
constexpr int kMaxRefinements = 3;
constexpr double kWantedResidual = 1e-10;  // relative to |A| |x| + |b|
constexpr int kFrontsPerQuestion = 16;

}  // namespace

KktFactorisation::KktFactorisation(int size, int num_dual, std::vector<int> rows,
                                   std::vector<int> columns, std::vector<double> times)
    : size_(size),
      num_dual_(num_dual),
      rows_(std::move(rows)),
      columns_(std::move(columns)),
      times_(std::move(times)) {
  if (size < 0 || num_dual < 0 || num_dual > size || rows_.size() != columns_.size() ||
      (!times_.empty() && times_.size() != static_cast<size_t>(size))) {
    throw std::invalid_argument("KktFactorisation: sizes do not fit");
  }
  for (size_t t = 0; t < rows_.size(); ++t) {
    if (std::min(rows_[t], columns_[t]) < 0 || std::max(rows_[t], columns_[t]) >= size) {
      throw std::invalid_argument("KktFactorisation: an entry lies outside the matrix");
    }
  }
}

void KktFactorisation::Analyse(const double* values, const CancellationToken& cancellation) {
  const size_t entries = rows_.size();
  // Weights: the size of an entry relative to those of its row and column.
  Eigen::VectorXd largest = Eigen::VectorXd::Zero(size_);
  for (size_t t = 0; t < entries; ++t) {
    const double magnitude = std::abs(values[t]);
    largest[rows_[t]] = std::max(largest[rows_[t]], magnitude);
    largest[columns_[t]] = std::max(largest[columns_[t]], magnitude);
  }
  std::vector<KktEdge> edges;
  edges.reserve(entries);
  for (size_t t = 0; t < entries; ++t) {
    if (rows_[t] == columns_[t]) continue;
    const double bound = std::sqrt(largest[rows_[t]]) * std::sqrt(largest[columns_[t]]);
    edges.push_back({rows_[t], columns_[t], bound > 0 ? std::abs(values[t]) / bound : 0});
  }
  analysis_ = AnalyseKkt(size_, num_dual_, edges, times_, cancellation);

  SortPlaces();
  const int places = static_cast<int>(place_row_.size());
  local_row_.resize(places);
  int place = 0;
  for (const KktFront& front : analysis_.fronts) {
    const int end = front.first_column + front.num_columns;
    for (; place < first_in_column_[end]; ++place) {
      const int row = place_row_[place];
      local_row_[place] =
          row < end
              ? row - front.first_column
              : front.num_columns +
                    static_cast<int>(std::lower_bound(front.rows.begin(), front.rows.end(), row) -
                                     front.rows.begin());
    }
  }
  factor_.reserve(analysis_.FactorEntries());
  analysed_ = true;
}

/// Gives entries of the pattern at the same place the same number, column after column.
void KktFactorisation::SortPlaces() {
  const size_t entries = rows_.size();
  std::vector<int> begin(size_ + 1, 0), of_column(entries);
  auto ends = [&](size_t t) {
    return std::minmax(analysis_.position_of[rows_[t]], analysis_.position_of[columns_[t]]);
  };
  for (size_t t = 0; t < entries; ++t) ++begin[ends(t).first + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> next(begin.begin(), begin.end() - 1);
  for (size_t t = 0; t < entries; ++t) of_column[next[ends(t).first]++] = static_cast<int>(t);

  place_of_.resize(entries);
  std::vector<int> place_of_row(size_, -1);
  for (int j = 0; j < size_; ++j) {
    const int first = static_cast<int>(place_row_.size());
    first_in_column_.push_back(first);
    for (int k = begin[j]; k < begin[j + 1]; ++k) {
      const int t = of_column[k];
      const int row = ends(t).second;
      if (place_of_row[row] < first) {
        place_of_row[row] = static_cast<int>(place_row_.size());
        place_row_.push_back(row);
      }
      place_of_[t] = place_of_row[row];
    }
  }
  first_in_column_.push_back(static_cast<int>(place_row_.size()));
}

/// Symmetric scaling until the largest entry of every row is near one (Ruiz 2001).
void KktFactorisation::Equilibrate() {
  scale_.setOnes(size_);
  Eigen::VectorXd& largest = r_;
  for (int pass = 0; pass < kScalingPasses; ++pass) {
    largest.setZero(size_);
    for (int j = 0; j < size_; ++j) {
      double largest_here = largest[j];
      for (int p = first_in_column_[j]; p < first_in_column_[j + 1]; ++p) {
        const int i = place_row_[p];
        const double magnitude = std::abs(values_[p]) * scale_[i] * scale_[j];
        largest[i] = std::max(largest[i], magnitude);
        largest_here = std::max(largest_here, magnitude);
      }
      largest[j] = largest_here;
    }
    scale_.array() /= (largest.array() > 0).select(largest.array().sqrt(), 1);
  }
  for (int j = 0; j < size_; ++j) {
    for (int p = first_in_column_[j]; p < first_in_column_[j + 1]; ++p) {
      values_[p] *= scale_[place_row_[p]] * scale_[j];
    }
  }
}

void KktFactorisation::AddContribution(const Contribution& contribution, int first_delayed) {
  const KktFront& child = analysis_.fronts[contribution.front];
  const KktFront& parent = analysis_.fronts[child.parent];
  const int delayed = static_cast<int>(contribution.delayed.size());
  const int delayed_here = front_.size() - parent.size();
  std::vector<int>& target = target_;
  target.resize(contribution.size);
  for (int k = 0; k < delayed; ++k) target[k] = parent.num_columns + first_delayed + k;
  for (int k = delayed; k < contribution.size; ++k) {
    const int local = child.rows_in_parent[k - delayed];
    target[k] = local < parent.num_columns ? local : local + delayed_here;
  }
  const double* value = stack_.data() + contribution.first_value;
  for (int j = 0; j < contribution.size; ++j) {
    const int tj = target[j];
    double* column = front_.column(tj);
    if (j < delayed) {  // rows may lie before delayed columns
      for (int i = j; i < contribution.size; ++i) {
        const int ti = target[i];
        (ti >= tj ? column[ti] : front_.column(ti)[tj]) += *value++;
      }
    } else {
      for (int i = j; i < contribution.size; ++i) column[target[i]] += *value++;
    }
  }
}

void KktFactorisation::Assemble(int f) {
  const KktFront& front = analysis_.fronts[f];
  const size_t first_child = contributions_.size() - front.num_children;
  int delayed = 0;
  for (size_t c = first_child; c < contributions_.size(); ++c) {
    delayed += static_cast<int>(contributions_[c].delayed.size());
  }
  front_.Reset(front.num_columns + delayed + static_cast<int>(front.rows.size()));
  for (int k = 0; k < front.num_columns; ++k) front_.index().push_back(front.first_column + k);
  for (size_t c = first_child; c < contributions_.size(); ++c) {
    const std::vector<int>& columns = contributions_[c].delayed;
    front_.index().insert(front_.index().end(), columns.begin(), columns.end());
  }
  front_.index().insert(front_.index().end(), front.rows.begin(), front.rows.end());

  for (int k = 0; k < front.num_columns; ++k) {
    double* column = front_.column(k);
    const int j = front.first_column + k;
    for (int p = first_in_column_[j]; p < first_in_column_[j + 1]; ++p) {
      const int row = local_row_[p];
      column[row < front.num_columns ? row : row + delayed] += values_[p];
    }
  }
  int first_delayed = 0;
  for (size_t c = first_child; c < contributions_.size(); ++c) {
    AddContribution(contributions_[c], first_delayed);
    first_delayed += static_cast<int>(contributions_[c].delayed.size());
  }
  if (front.num_children > 0) stack_top_ = contributions_[first_child].first_value;
  contributions_.resize(first_child);
  candidates_ = front.num_columns + delayed;
}

void KktFactorisation::StoreFactor() {
  const int pivots = front_.num_pivots();
  parts_.push_back({front_.size(), pivots, factor_.size(), index_.size(), pivots_.size()});
  for (int k = 0; k < pivots; ++k) {
    const double* column = front_.column(k);
    factor_.insert(factor_.end(), column + k + 1, column + front_.size());
  }
  index_.insert(index_.end(), front_.index().begin(), front_.index().end());
  pivots_.insert(pivots_.end(), front_.pivots().begin(), front_.pivots().end());
  inverse_diagonal_.insert(inverse_diagonal_.end(), front_.inverse_diagonal().begin(),
                           front_.inverse_diagonal().end());
  inverse_subdiagonal_.insert(inverse_subdiagonal_.end(), front_.inverse_subdiagonal().begin(),
                              front_.inverse_subdiagonal().end());
  num_negative_ += front_.num_negative();
}

void KktFactorisation::PassOn(int f) {
  Contribution contribution;
  contribution.front = f;
  const int pivots = front_.num_pivots();
  contribution.delayed.assign(front_.index().begin() + pivots,
                              front_.index().begin() + candidates_);
  contribution.size = front_.size() - pivots;
  contribution.first_value = stack_top_;
  num_delayed_ += candidates_ - pivots;
  const auto size = static_cast<size_t>(contribution.size);
  if (stack_.size() < stack_top_ + size * (size + 1) / 2) {
    stack_.resize(std::max(2 * stack_.size(), stack_top_ + size * (size + 1) / 2));
  }
  for (int j = pivots; j < front_.size(); ++j) {
    std::copy(front_.column(j) + j, front_.column(j) + front_.size(), stack_.data() + stack_top_);
    stack_top_ += static_cast<size_t>(front_.size() - j);
  }
  contributions_.push_back(std::move(contribution));
}

KktStatus KktFactorisation::Factorise(const double* values, double pivot_threshold,
                                      const CancellationToken& cancellation) {
  for (size_t t = 0; t < rows_.size(); ++t) {
    if (!std::isfinite(values[t])) return KktStatus::kNotFinite;
  }
  if (!analysed_) Analyse(values, cancellation);
  values_.setZero(static_cast<int>(place_row_.size()));
  for (size_t t = 0; t < rows_.size(); ++t) values_[place_of_[t]] += values[t];
  if (!values_.allFinite()) return KktStatus::kNotFinite;
  Equilibrate();

  contributions_.clear();
  stack_top_ = 0;
  parts_.clear();
  factor_.clear();
  index_.clear();
  pivots_.clear();
  inverse_diagonal_.clear();
  inverse_subdiagonal_.clear();
  num_negative_ = num_delayed_ = 0;
  for (int f = 0; f < static_cast<int>(analysis_.fronts.size()); ++f) {
    if (f % kFrontsPerQuestion == 0) cancellation.ThrowIfCancelled();
    const bool is_root = analysis_.fronts[f].parent < 0;
    Assemble(f);
    front_.Eliminate(candidates_, pivot_threshold, is_root, cancellation);
    const bool is_stuck = is_root && front_.num_pivots() < candidates_;
    if (is_stuck || front_.has_zero_candidate()) return KktStatus::kSingular;
    StoreFactor();
    if (!is_root) PassOn(f);
    if (delay_limit_ && num_delayed_ > *delay_limit_) return KktStatus::kGaveUp;
  }
  return KktStatus::kFactorised;
}

void KktFactorisation::SolveOnce(Eigen::VectorXd* x) {
  for (const FactorPart& part : parts_) {
    if (gathered_.size() < part.size) gathered_.resize(part.size);
    const int* index = index_.data() + part.first_index;
    double* y = gathered_.data();
    for (int i = 0; i < part.size; ++i) y[i] = (*x)[index[i]];
    kernels_->solve_down({part.size, part.num_pivots, factor_.data() + part.first_value}, y);
    for (int k = 0; k < part.num_pivots; ++k) {
      const size_t p = part.first_pivot + k;
      if (pivots_[p] == DenseFront::kPairFirst) {
        const double first = y[k], second = y[k + 1];
        y[k] = inverse_diagonal_[p] * first + inverse_subdiagonal_[p] * second;
        y[k + 1] = inverse_subdiagonal_[p] * first + inverse_diagonal_[p + 1] * second;
        ++k;
      } else {
        y[k] *= inverse_diagonal_[p];
      }
    }
    for (int i = 0; i < part.size; ++i) (*x)[index[i]] = y[i];
  }
  for (auto part = parts_.rbegin(); part != parts_.rend(); ++part) {
    const int* index = index_.data() + part->first_index;
    double* y = gathered_.data();
    for (int i = 0; i < part->size; ++i) y[i] = (*x)[index[i]];
    kernels_->solve_up({part->size, part->num_pivots, factor_.data() + part->first_value}, y);
    for (int i = 0; i < part->num_pivots; ++i) (*x)[index[i]] = y[i];
  }
}

/// r = b - A x; returns its size relative to the data.
double KktFactorisation::Residual(const Eigen::VectorXd& b, const Eigen::VectorXd& x,
                                  Eigen::VectorXd* r) const {
  *r = b;
  for (int j = 0; j < size_; ++j) {
    double product = 0;  // of the column as a row
    for (int p = first_in_column_[j]; p < first_in_column_[j + 1]; ++p) {
      const int i = place_row_[p];
      (*r)[i] -= values_[p] * x[j];
      if (i != j) product += values_[p] * x[i];
    }
    (*r)[j] -= product;
  }
  const double size = x.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>();
  return size > 0 ? r->lpNorm<Eigen::Infinity>() / size : 0;
}

void KktFactorisation::Solve(double* right_side) {
  b_.resize(size_);
  for (int k = 0; k < size_; ++k) b_[k] = scale_[k] * right_side[analysis_.variable_at[k]];
  x_ = b_;
  SolveOnce(&x_);
  double residual = Residual(b_, x_, &r_);
  for (int step = 0; step < kMaxRefinements && residual > kWantedResidual; ++step) {
    SolveOnce(&r_);
    correction_.swap(r_);
    correction_ += x_;
    const double improved = Residual(b_, correction_, &r_);
    if (!(improved < residual)) break;
    x_.swap(correction_);
    residual = improved;
  }
  const bool finite = x_.allFinite();
  for (int k = 0; k < size_; ++k) {
    right_side[analysis_.variable_at[k]] = finite ? scale_[k] * x_[k] : 0;
  }
}

}  // namespace possibility::collocation
