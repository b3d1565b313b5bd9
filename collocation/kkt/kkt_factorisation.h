#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "collocation/kkt/dense_front.h"
#include "collocation/kkt/kkt_analysis.h"
#include "collocation/kkt/vector_kernels.h"
#include "common/cancellation_token.h"

namespace possibility::collocation {

enum class KktStatus {
  kFactorised,
  kSingular,   ///< to rounding; the inertia is unknown
  kNotFinite,  ///< an entry of the matrix is not a finite number
  kGaveUp      ///< more columns were delayed than LimitDelays allows; the inertia is unknown
};

/// Solves sparse symmetric indefinite systems, as they arise in interior-point methods, for many
/// matrices of one pattern: a multifrontal L D L' (Duff & Reid 1983) of the equilibrated matrix
/// with 1x1 and 2x2 threshold pivots. A column without a stable pivot in its front is delayed to
/// the next front, so the inertia is that of the matrix itself. Each object belongs to one thread
/// at a time; objects share nothing.
class KktFactorisation {
 public:
  /// The pattern: entry t couples rows[t] and columns[t] (0-based, either triangle, each
  /// off-diagonal entry given once; repeated entries add up). The last `num_dual` rows may have a
  /// zero diagonal; `times` as KktPairs takes them: hints for the ordering.
  /// @throws std::invalid_argument for an index out of range or sizes that do not fit.
  KktFactorisation(int size, int num_dual, std::vector<int> rows, std::vector<int> columns,
                   std::vector<double> times = {});

  /// `values`: one per entry of the pattern. A pivot is accepted if it bounds the multipliers by
  /// 1 / pivot_threshold, in (0, 0.5]. `cancellation` is asked from time to time.
  /// @throws Cancelled; the object can then be used for another Factorise.
  KktStatus Factorise(const double* values, double pivot_threshold,
                      const CancellationToken& cancellation = {});

  /// Ends a factorisation with kGaveUp once more than `limit` columns were delayed, counted as
  /// num_delayed() does: nearly singular matrices can take time without measure. None: no limit.
  void LimitDelays(std::optional<int> limit) { delay_limit_ = limit; }

  /// Overwrites the right-hand side (size) with the solution, refined against the matrix. A
  /// solution that is not finite is returned as zero. Call only after kFactorised.
  void Solve(double* right_side);

  int size() const { return size_; }
  /// Number of negative eigenvalues of the factorised matrix.
  int num_negative() const { return num_negative_; }
  /// Number of columns delayed to a later front for lack of a pivot, counted once per front left.
  int num_delayed() const { return num_delayed_; }
  /// Multiplications of a factorisation without delayed columns; 0 before the first.
  double flops() const { return analysis_.Flops(); }
  /// Number of stored entries of the factor.
  size_t factor_size() const { return factor_.size(); }

 private:
  struct FactorPart {
    int size = 0;
    int num_pivots = 0;
    size_t first_value = 0;  ///< in factor_: for each pivot, the rows below it
    size_t first_index = 0;  ///< in index_
    size_t first_pivot = 0;  ///< in pivots_ and the inverse of D
  };
  /// What a front passes to its parent: its Schur complement, the delayed columns first.
  struct Contribution {
    int front = 0;
    std::vector<int> delayed;  ///< positions
    int size = 0;
    size_t first_value = 0;  ///< in stack_
  };

  void Analyse(const double* values, const CancellationToken& cancellation);
  void SortPlaces();
  void Equilibrate();
  void Assemble(int front);
  void AddContribution(const Contribution& contribution, int first_delayed);
  void StoreFactor();
  void PassOn(int front);
  void SolveOnce(Eigen::VectorXd* x);
  double Residual(const Eigen::VectorXd& b, const Eigen::VectorXd& x, Eigen::VectorXd* r) const;

  const VectorKernels* kernels_ = &WidestKernels();
  int size_;
  int num_dual_;
  std::vector<int> rows_, columns_;
  std::vector<double> times_;
  bool analysed_ = false;
  KktAnalysis analysis_;

  // The matrix without repetitions, lower triangle in elimination order, column by column.
  std::vector<int> place_of_;  ///< entry of the pattern -> place
  std::vector<int> place_row_;
  std::vector<int> first_in_column_;  ///< place, and the end
  std::vector<int> local_row_;        ///< in the front, before delayed columns
  Eigen::VectorXd values_;            ///< equilibrated
  Eigen::VectorXd scale_;             ///< by position

  DenseFront front_;
  int candidates_ = 0;       ///< columns of front_ that may be eliminated
  std::vector<int> target_;  ///< places of a contribution's rows in front_
  std::vector<Contribution> contributions_;
  std::vector<double> stack_;
  size_t stack_top_ = 0;

  std::vector<FactorPart> parts_;
  std::vector<double> factor_;
  std::vector<int> index_;
  std::vector<DenseFront::Pivot> pivots_;
  std::vector<double> inverse_diagonal_, inverse_subdiagonal_;
  int num_negative_ = 0;
  int num_delayed_ = 0;
  std::optional<int> delay_limit_;
  Eigen::VectorXd b_, x_, r_, correction_;
  Eigen::VectorXd gathered_;
};

}  // namespace possibility::collocation
