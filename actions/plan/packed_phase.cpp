#include "actions/plan/packed_phase.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "models/robot/rotation_vector.h"

namespace possibility::actions {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Quaterniond;
using Eigen::VectorXd;
using Integers = std::vector<std::int64_t>;

constexpr int kTimeBits = 40;  // 0.9 ps: what moves in flight must not be off by more

constexpr int kOrder = 3;  // of the differences in time
constexpr double kLargestInteger = 4e18;

double Step(int bits) { return std::ldexp(1.0, -bits); }

std::int64_t Integer(double x) {
  if (!(std::abs(x) < kLargestInteger)) {
    throw std::invalid_argument("a plan holds a number that is not finite or too large");
  }
  return std::llrint(x);
}

/// Sums and differences wrap, so that spoilt files have no undefined behaviour.
std::int64_t Plus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}
std::int64_t Minus(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}

void Difference(Integers::iterator begin, Integers::iterator end) {
  for (int order = 0; order < kOrder; ++order) {
    for (auto i = end - 1; i > begin; --i) *i = Minus(*i, *(i - 1));
  }
}

void Accumulate(Integers::iterator begin, Integers::iterator end) {
  for (int order = 0; order < kOrder; ++order) {
    for (auto i = begin + 1; i < end; ++i) *i = Plus(*i, *(i - 1));
  }
}

/// Appends the rows of `values`, in steps, differenced along time.
void AppendRows(const MatrixXd& values, double step, Integers* numbers) {
  for (Index row = 0; row < values.rows(); ++row) {
    const auto begin = static_cast<std::ptrdiff_t>(numbers->size());
    for (const double value : values.row(row)) numbers->push_back(Integer(value / step));
    Difference(numbers->begin() + begin, numbers->end());
  }
}

/// Inverse of AppendRows.
MatrixXd Rows(Integers numbers, Index rows, Index columns, double step) {
  MatrixXd values(rows, columns);
  for (Index row = 0; row < rows; ++row) {
    const auto begin = numbers.begin() + row * columns;
    Accumulate(begin, begin + columns);
    for (Index k = 0; k < columns; ++k) values(row, k) = static_cast<double>(begin[k]) * step;
  }
  return values;
}

/// Integrals of accelerations over interval k: of the cubic through the four nearest knots as if
/// they were equally far apart, or of the straight line if there are fewer.
VectorXd RateChange(const MatrixXd& a, Index k, double h) {
  const Index last = a.cols() - 1;
  if (last < 3) return h / 2 * (a.col(k) + a.col(k + 1));
  if (k == 0) return h / 24 * (9 * a.col(0) + 19 * a.col(1) - 5 * a.col(2) + a.col(3));
  if (k + 1 == last) {
    return h / 24 *
           (9 * a.col(last) + 19 * a.col(last - 1) - 5 * a.col(last - 2) + a.col(last - 3));
  }
  return h / 24 * (13 * (a.col(k) + a.col(k + 1)) - a.col(k - 1) - a.col(k + 2));
}

/// Change of position over an interval of Hermite's cubic through the rates.
VectorXd PositionChange(const VectorXd& v0, const VectorXd& v1, const VectorXd& a0,
                        const VectorXd& a1, double h) {
  return h / 2 * (v0 + v1) + h * h / 12 * (a0 - a1);
}

Quaterniond OrientationIn(const VectorXd& q) {
  return Quaterniond(q[0], q[1], q[2], q[3]).normalized();
}

/// `q` after a change: rotation vector in world axes, root position, joints.
VectorXd Moved(const VectorXd& q, const VectorXd& change) {
  const Quaterniond R = (models::Exponential(change.head<3>()) * OrientationIn(q)).normalized();
  VectorXd moved(q.size());
  moved << R.w(), R.vec(), q.tail(q.size() - 4) + change.tail(change.size() - 3);
  return moved;
}

/// Of a unit quaternion's length.
constexpr double kUnit = 1e-6;

VectorXd ChangeBetween(const VectorXd& q0, const VectorXd& q1) {
  VectorXd change(q0.size() - 1);
  change << models::RotationVector(OrientationIn(q1) * OrientationIn(q0).conjugate()),
      q1.tail(q1.size() - 4) - q0.tail(q0.size() - 4);
  return change;
}

/// Bits of a step no larger than `h`, s.
int BitsOfTime(double h) { return static_cast<int>(std::ceil(-std::log2(h))); }

bool Fits(const Knot& knot, const PackedOutline& outline) {
  return knot.q.size() == 7 + outline.num_joints && knot.v.size() == 6 + outline.num_joints &&
         knot.a.size() == 6 + outline.num_joints && knot.forces.cols() == outline.num_points &&
         knot.tau.size() == (outline.has_torques ? outline.num_joints : 0);
}

bool Continues(const Knot& knot, const Phase& phase_before) {
  const Knot& before = phase_before.knots.back();
  // Half a step of rounding, and as much again for what v1's own digits leave.
  const double step = Step(phase_before.acceleration_bits);
  const double h = before.t - phase_before.knots[phase_before.knots.size() - 2].t;
  return std::abs(knot.t - before.t) <= Step(kTimeBits) && knot.q.size() == before.q.size() &&
         ChangeBetween(before.q, knot.q).cwiseAbs().maxCoeff() <= std::min(step * h * h, 1e-9) &&
         (knot.v - before.v).cwiseAbs().maxCoeff() <= std::min(step * h, 5e-7);
}

/// Of the finest step that a double of the size of the phase's positions can hold well.
int BitsOfPlaces(const Phase& phase) {
  double largest = 1;
  for (const Knot& knot : phase.knots) {
    largest = std::max(largest, knot.q.segment<3>(4).cwiseAbs().maxCoeff());
  }
  if (!(largest < kLargestInteger)) {
    throw std::invalid_argument("a plan holds a number that is not finite or too large");
  }
  return kMostPackedBits + 3 - std::ilogb(largest);
}

/// How much finer than accelerations rates and positions must be, so that the quintic between two
/// knots does not turn their rounding into larger accelerations; never coarser than 5e-7 m/s and
/// 1e-9 m.
void ChooseSteps(const Phase& phase, PackedOutline* outline) {
  double shortest = phase.knots[1].t - phase.knots[0].t;
  for (std::size_t k = 1; k < phase.knots.size(); ++k) {
    shortest = std::min(shortest, phase.knots[k].t - phase.knots[k - 1].t);
  }
  if (!(shortest > 0)) throw std::invalid_argument("a plan's times do not increase");
  const int bits = BitsOfTime(shortest);
  outline->acceleration_bits = phase.acceleration_bits;
  outline->rate_bits = std::clamp(phase.acceleration_bits + 3 + bits, 21, kMostPackedBits);
  outline->position_bits = std::clamp(phase.acceleration_bits + 5 + 2 * bits, 30, kMostPackedBits);
  outline->position_bits = std::min(outline->position_bits, BitsOfPlaces(phase));
}

PackedOutline OutlineOf(const Phase& phase, int force_bits, const Phase* before) {
  PackedOutline outline;
  outline.num_knots = static_cast<Index>(phase.knots.size());
  if (outline.num_knots < 2) throw std::invalid_argument("a phase of a plan has less than 2 knots");
  const Knot& first = phase.knots.front();
  outline.num_joints = std::max<Index>(first.v.size() - 6, 0);
  outline.has_torques = first.tau.size() > 0;
  outline.num_points = first.forces.cols();
  outline.force_bits = force_bits;
  for (const Knot& knot : phase.knots) {
    if (!Fits(knot, outline)) {
      throw std::invalid_argument("the knots of a phase differ in their sizes");
    }
    // Integers tell turns, which would not show it. Not finite: refused below.
    if (std::abs(knot.q.head<4>().norm() - 1) > kUnit) {
      throw std::invalid_argument("an orientation of a plan is no unit quaternion");
    }
  }
  ChooseSteps(phase, &outline);
  if (before == nullptr || !Continues(first, *before)) {
    outline.start = PackedOutline::Start{
        static_cast<double>(Integer(first.t / Step(kTimeBits))) * Step(kTimeBits), first.q,
        first.v};
  }
  return outline;
}

template <typename OfKnot>
MatrixXd Stacked(const Phase& phase, const OfKnot& of_knot) {
  MatrixXd values(of_knot(phase.knots.front()).size(), phase.knots.size());
  for (std::size_t k = 0; k < phase.knots.size(); ++k) values.col(k) = of_knot(phase.knots[k]);
  return values;
}

/// Packs rates and positions as what their predictions miss. The predictions are those of the
/// reader: made from rounded values.
class Predictions {
 public:
  Predictions(const PackedOutline& outline, Integers times, const MatrixXd& a, double t, VectorXd q,
              VectorXd v)
      : rate_step_(Step(outline.rate_bits)),
        position_step_(Step(outline.position_bits)),
        times_(std::move(times)),
        a_(a),
        t_(t),
        q_(std::move(q)),
        v_(std::move(v)) {}

  double t() const { return t_; }
  const VectorXd& q() const { return q_; }
  const VectorXd& v() const { return v_; }

  /// Sets what the predictions of knot k + 1 miss, and goes on to it.
  void Miss(Index k, const Knot& next, Eigen::Ref<Eigen::Matrix<std::int64_t, -1, 1>> rates,
            Eigen::Ref<Eigen::Matrix<std::int64_t, -1, 1>> positions) {
    const double h = static_cast<double>(times_[k]) * Step(kTimeBits);
    const VectorXd rate = v_ + RateChange(a_, k, h);
    for (Index i = 0; i < rates.size(); ++i) {
      rates[i] = Integer((next.v[i] - rate[i]) / rate_step_);
    }
    const VectorXd v = rate + rates.cast<double>() * rate_step_;
    const VectorXd missed =
        ChangeBetween(q_, next.q) - PositionChange(v_, v, a_.col(k), a_.col(k + 1), h);
    for (Index i = 0; i < positions.size(); ++i) {
      positions[i] = Integer(missed[i] / position_step_);
    }
    Advance(k, rates, positions);
  }

  void Advance(Index k, const Eigen::Ref<const Eigen::Matrix<std::int64_t, -1, 1>>& rates,
               const Eigen::Ref<const Eigen::Matrix<std::int64_t, -1, 1>>& positions) {
    const double h = static_cast<double>(times_[k]) * Step(kTimeBits);
    const VectorXd v = v_ + RateChange(a_, k, h) + rates.cast<double>() * rate_step_;
    const VectorXd change = PositionChange(v_, v, a_.col(k), a_.col(k + 1), h) +
                            positions.cast<double>() * position_step_;
    q_ = Moved(q_, change);
    v_ = v;
    t_ += h;
  }

 private:
  double rate_step_;
  double position_step_;
  Integers times_;
  const MatrixXd& a_;
  double t_;
  VectorXd q_;
  VectorXd v_;
};

using IntegerMatrix = Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Integers RowByRow(const IntegerMatrix& matrix) {
  return Integers(matrix.data(), matrix.data() + matrix.size());
}

IntegerMatrix FromRows(const Integers& numbers, Index rows, Index columns) {
  return Eigen::Map<const IntegerMatrix>(numbers.data(), rows, columns);
}

Predictions BeginOf(const PackedPhase& packed, const MatrixXd& a, const Knot* before) {
  Integers times = packed.numbers[kTimes];
  for (std::size_t k = 1; k < times.size(); ++k) times[k] = Plus(times[k], times[k - 1]);
  const auto& start = packed.outline.start;
  if (start) return {packed.outline, std::move(times), a, start->t, start->q, start->v};
  if (before == nullptr) throw std::invalid_argument("the first phase of a plan has no start");
  return {packed.outline, std::move(times), a, before->t, before->q, before->v};
}

/// Steps of time, each minus the one before.
Integers TimesOf(const Phase& phase, double start) {
  Integers times;
  double t = start;
  for (std::size_t k = 1; k < phase.knots.size(); ++k) {
    times.push_back(Integer((phase.knots[k].t - t) / Step(kTimeBits)));
    if (times.back() < 1) throw std::invalid_argument("a plan's times do not increase");
    t += static_cast<double>(times.back()) * Step(kTimeBits);
  }
  for (std::size_t k = times.size() - 1; k > 0; --k) times[k] -= times[k - 1];
  return times;
}

}  // namespace

std::size_t PackedOutline::CountOf(PackedQuantity quantity) const {
  const auto knots = static_cast<std::size_t>(num_knots);
  const auto joints = static_cast<std::size_t>(num_joints);
  switch (quantity) {
    case kTimes:
      return knots - 1;
    case kAccelerations:
      return (6 + joints) * knots;
    case kRates:
    case kPositions:
      return (6 + joints) * (knots - 1);
    case kTorques:
      return has_torques ? joints * knots : 0;
    case kForces:
      return 3 * static_cast<std::size_t>(num_points) * knots;
  }
  return 0;
}

PackedPhase Pack(const Phase& phase, int force_bits, const Phase* before, PackedTorques torques) {
  PackedPhase packed;
  packed.outline = OutlineOf(phase, force_bits, before);
  if (torques == PackedTorques::kLeftOut) packed.outline.has_torques = false;
  const PackedOutline& outline = packed.outline;
  const Knot* last = before != nullptr ? &before->knots.back() : nullptr;
  packed.numbers[kTimes] = TimesOf(phase, outline.start ? outline.start->t : last->t);

  const double step = Step(outline.acceleration_bits);
  AppendRows(Stacked(phase, [](const Knot& knot) { return knot.a; }), step,
             &packed.numbers[kAccelerations]);
  if (outline.has_torques) {
    AppendRows(Stacked(phase, [](const Knot& knot) { return knot.tau; }),
               Step(force_bits - kTorqueBitsFewer), &packed.numbers[kTorques]);
  }
  AppendRows(Stacked(phase, [](const Knot& knot) { return VectorXd(knot.forces.reshaped()); }),
             Step(force_bits), &packed.numbers[kForces]);

  const Index nv = 6 + outline.num_joints;
  const MatrixXd a = Rows(packed.numbers[kAccelerations], nv, outline.num_knots, step);
  Predictions predictions = BeginOf(packed, a, last);
  IntegerMatrix rates(nv, outline.num_knots - 1);
  IntegerMatrix positions(nv, outline.num_knots - 1);
  Eigen::Matrix<std::int64_t, -1, 1> rate(nv);
  Eigen::Matrix<std::int64_t, -1, 1> position(nv);
  for (Index k = 0; k + 1 < outline.num_knots; ++k) {
    predictions.Miss(k, phase.knots[k + 1], rate, position);
    rates.col(k) = rate;
    positions.col(k) = position;
  }
  packed.numbers[kRates] = RowByRow(rates);
  packed.numbers[kPositions] = RowByRow(positions);
  return packed;
}

std::vector<Knot> Unpack(const PackedPhase& packed, const Knot* before) {
  const PackedOutline& outline = packed.outline;
  const Index nv = 6 + outline.num_joints;
  const Index n = outline.num_knots;
  const MatrixXd a = Rows(packed.numbers[kAccelerations], nv, n, Step(outline.acceleration_bits));
  const MatrixXd tau = Rows(packed.numbers[kTorques], outline.has_torques ? outline.num_joints : 0,
                            n, Step(outline.force_bits - kTorqueBitsFewer));
  const MatrixXd forces =
      Rows(packed.numbers[kForces], 3 * outline.num_points, n, Step(outline.force_bits));
  const IntegerMatrix rates = FromRows(packed.numbers[kRates], nv, n - 1);
  const IntegerMatrix positions = FromRows(packed.numbers[kPositions], nv, n - 1);
  Predictions state = BeginOf(packed, a, before);
  std::vector<Knot> knots;
  knots.reserve(n);
  for (Index k = 0; k < n; ++k) {
    if (k > 0) state.Advance(k - 1, rates.col(k - 1), positions.col(k - 1));
    knots.push_back({state.t(), state.q(), state.v(), a.col(k), tau.col(k),
                     forces.col(k).reshaped(3, outline.num_points)});
  }
  return knots;
}

void RoundToPackedSteps(int force_bits, const Phase* before, Phase* phase) {
  const PackedPhase packed = Pack(*phase, force_bits, before);
  phase->knots = Unpack(packed, before != nullptr ? &before->knots.back() : nullptr);
}

}  // namespace possibility::actions
