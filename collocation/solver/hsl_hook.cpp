#include "collocation/solver/hsl_hook.h"

#include <HSLLoader.h>

#include <algorithm>
#include <mutex>
#include <utility>
#include <vector>

namespace possibility::collocation {
namespace {

/// A matrix that delays more columns, and more than half of its own, passes for singular, so that
/// Ipopt regularises it. Delayed columns travel along time and the fronts grow with them: without
/// the limit, the factorisations of the container crane on 800 intervals took 37.6 s in all, with
/// it 2.
constexpr int kFewDelays = 1000;

thread_local HslScope* current_scope = nullptr;

// The sizes of MA27's control and information arrays (HSL 2013, MA27 specification).
constexpr int kNumIcntl = 30;
constexpr int kNumCntl = 5;
constexpr int kNumInfo = 20;
// The entries that Ipopt 3.11 reads: IpMa27TSolverInterface.
constexpr int kFlag = 0;
constexpr int kRealsWanted = 4;
constexpr int kIntegersWanted = 5;
constexpr int kNumNegative = 14;
constexpr int kFatal = -1;
constexpr int kSingularMatrix = -5;

void Initialise(ipfint* icntl, double* cntl) {
  std::fill(icntl, icntl + kNumIcntl, 0);
  std::fill(cntl, cntl + kNumCntl, 0.0);
}

/// MA27AD. The control array is a member of the solver instance, so its address identifies the
/// instance.
void Analyse(ipfint* n, ipfint* nz, const ipfint* irn, const ipfint* icn, ipfint*, ipfint*, ipfint*,
             ipfint*, ipfint* nsteps, ipfint*, ipfint* icntl, double*, ipfint* info, double* ops) {
  std::fill(info, info + kNumInfo, 0);
  *ops = 0;
  *nsteps = 1;
  info[kRealsWanted] = *nz;
  info[kIntegersWanted] = 1;
  if (HslScope::Current() == nullptr) {
    info[kFlag] = kFatal;
    return;
  }
  HslScope::Current()->SetPattern(icntl, *n, *nz, irn, icn);
}

/// MA27BD.
void Factorise(ipfint*, ipfint*, const ipfint*, const ipfint*, double* a, ipfint*, ipfint*, ipfint*,
               ipfint*, ipfint*, ipfint* maxfrt, ipfint*, ipfint* icntl, double* cntl,
               ipfint* info) {
  std::fill(info, info + kNumInfo, 0);
  *maxfrt = 1;
  if (HslScope::Current() == nullptr) {
    info[kFlag] = kFatal;
    return;
  }
  const std::optional<KktStatus> status =
      HslScope::Current()->Factorise(icntl, a, cntl[0], &info[kNumNegative]);
  if (!status || *status == KktStatus::kNotFinite) {
    info[kFlag] = kFatal;
  } else if (*status != KktStatus::kFactorised) {
    info[kFlag] = kSingularMatrix;
  }
}

/// MA27CD.
void BackSolve(ipfint*, double*, ipfint*, ipfint*, ipfint*, double*, ipfint*, double* rhs, ipfint*,
               ipfint*, ipfint* icntl, double*) {
  HslScope::Current()->Solve(icntl, rhs);
}

void Register() {
  static std::once_flag once;
  std::call_once(once, [] { LSL_setMA27(Analyse, Factorise, BackSolve, Initialise); });
}

}  // namespace

HslScope::HslScope(int num_dual, std::vector<double> times, SolveClock* clock)
    : num_dual_(num_dual), times_(std::move(times)), clock_(clock), outer_(current_scope) {
  Register();
  current_scope = this;
}

HslScope::~HslScope() { current_scope = outer_; }

HslScope* HslScope::Current() { return current_scope; }

void HslScope::SetPattern(const void* instance, int size, int entries, const int* rows,
                          const int* columns) {
  const SolveTimer timer(*clock_, &factorisation_seconds_);
  auto zero_based = [entries](const int* indices) {
    std::vector<int> shifted(indices, indices + entries);
    for (int& index : shifted) --index;
    return shifted;
  };
  const bool fits = times_.size() == static_cast<std::size_t>(size);
  factorisations_[instance] = std::make_unique<KktFactorisation>(
      size, std::min(num_dual_, size), zero_based(rows), zero_based(columns),
      fits ? times_ : std::vector<double>());
  factorisations_[instance]->LimitDelays(std::max(kFewDelays, size / 2));
}

std::optional<KktStatus> HslScope::Factorise(const void* instance, const double* values,
                                             double pivot_threshold, int* num_negative) {
  const SolveTimer timer(*clock_, &factorisation_seconds_);
  ++num_factorisations_;
  KktFactorisation& kkt = *factorisations_.at(instance);
  try {
    const KktStatus status =
        kkt.Factorise(values, std::clamp(pivot_threshold, 0.0, 0.5), clock_->token());
    *num_negative = kkt.num_negative();
    return status;
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

void HslScope::Solve(const void* instance, double* right_side) {
  const SolveTimer timer(*clock_, &back_solve_seconds_);
  ++num_solves_;
  factorisations_.at(instance)->Solve(right_side);
}

}  // namespace possibility::collocation
