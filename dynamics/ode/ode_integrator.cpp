// Only this file, newton_linear_solver and state_vector include SUNDIALS (docs/dynamics.md: the
// SUNDIALS seam).
#include "dynamics/ode/ode_integrator.h"

#include <cvode/cvode.h>
#include <cvode/cvode_ls.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>

#include "dynamics/ode/newton_linear_solver.h"
#include "dynamics/ode/ode_guard_search.h"
#include "dynamics/ode/state_vector.h"

namespace possibility::dynamics {

namespace {

std::string Number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// Index of the first component that is not finite; -1 if all are finite.
int FirstNotFinite(const Eigen::Ref<const Eigen::VectorXd>& x) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i])) return static_cast<int>(i);
  }
  return -1;
}

[[noreturn]] void Reject(const std::string& what) {
  throw std::invalid_argument("Integrate: " + what);
}

void CheckProblem(const OdeProblem& problem) {
  if (!problem.rate) Reject("no rate function");
  if (problem.start.size() == 0) Reject("the state is empty");
  if (const int bad = FirstNotFinite(problem.start); bad >= 0) {
    Reject("component " + std::to_string(bad) + " of the start is not finite");
  }
  if (!std::isfinite(problem.start_time) || !std::isfinite(problem.end_time) ||
      problem.end_time < problem.start_time) {
    Reject("times from " + Number(problem.start_time) + " to " + Number(problem.end_time) +
           " s; expected finite ones that do not decrease");
  }
  if (!problem.guards.empty() && !problem.guard_values) Reject("guards without guard_values");
  for (const OdeGuard& guard : problem.guards) {
    if (!(guard.zero >= 0)) Reject("a guard's zero must not be negative");
  }
  if (problem.positions < 0 || problem.positions > problem.start.size()) {
    Reject("positions is " + std::to_string(problem.positions) + ", expected 0 to " +
           std::to_string(problem.start.size()));
  }
}

void CheckSettings(const OdeSettings& settings, Eigen::Index size) {
  const auto positive = [](const char* what, double value) {
    if (!(value > 0)) Reject(std::string(what) + " is " + Number(value) + ", expected above 0");
  };
  positive("relative_tolerance", settings.relative_tolerance);
  positive("absolute_tolerance", settings.absolute_tolerance);
  positive("max_step", settings.max_step);
  positive("max_steps", settings.max_steps);
  positive("guard_samples", settings.guard_samples);
  if (!(settings.relative_tolerance < 1)) Reject("relative_tolerance must be below 1");
  if (!(settings.guard_zero >= 0)) Reject("guard_zero must not be negative");
  if (!(settings.simultaneous >= 0)) Reject("simultaneous must not be negative");
  if (settings.absolute_tolerances.size() != 0 && settings.absolute_tolerances.size() != size) {
    Reject("absolute_tolerances has " + std::to_string(settings.absolute_tolerances.size()) +
           " elements, expected " + std::to_string(size));
  }
  for (const double tolerance : settings.absolute_tolerances) {
    positive("one of absolute_tolerances", tolerance);
  }
}

struct Free {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
  void operator()(SUNMatrix matrix) const { SUNMatDestroy(matrix); }
  void operator()(SUNLinearSolver solver) const { SUNLinSolFree(solver); }
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
  void operator()(void* cvode) const { CVodeFree(&cvode); }
};

template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

/// CVODE's integration of one problem, step by step.
class Stepper {
 public:
  Stepper(const OdeProblem& problem, const OdeSettings& settings)
      : problem_(problem), time_(problem.start_time) {
    CreateContext();
    state_ = NewVector(problem.start);
    cvode_.reset(
        CVodeCreate(settings.method == OdeMethod::kAdams ? CV_ADAMS : CV_BDF, context_.get()));
    if (!cvode_) throw std::bad_alloc();
    Check(CVodeSetErrHandlerFn(cvode_.get(), &KeepMessage, this));
    Check(CVodeInit(cvode_.get(), &EvaluateRate, problem.start_time, state_.get()));
    Check(CVodeSetUserData(cvode_.get(), this));
    SetTolerances(settings);
    SetSolver(settings.method);
    if (std::isfinite(settings.max_step)) Check(CVodeSetMaxStep(cvode_.get(), settings.max_step));
    Check(CVodeSetMaxHnilWarns(cvode_.get(), -1));
    Check(CVodeSetStopTime(cvode_.get(), problem.end_time));
  }
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  double time() const { return time_; }
  Eigen::VectorXd State() const { return AsVector(state_.get()); }

  void Step() {
    const double before = time_;
    const int flag = CVode(cvode_.get(), problem_.end_time, state_.get(), &time_, CV_ONE_STEP);
    if (thrown_) std::rethrow_exception(std::exchange(thrown_, nullptr));
    if (flag < 0) GiveUp(flag);
    if (const int bad = FirstNotFinite(AsVector(state_.get())); bad >= 0) {
      throw OdeError("ODE integration gave up at t = " + Number(time_) + " s: component " +
                         std::to_string(bad) + " of the state is not finite",
                     time_, bad);
    }
    if (time_ == before) Fail("time no longer advances: the steps have become too small");
  }

  /// The last step's interpolant.
  OdePiece Piece() {
    OdePiece piece;
    int order = 0;
    Check(CVodeGetLastOrder(cvode_.get(), &order));
    Check(CVodeGetLastStep(cvode_.get(), &piece.length));
    piece.origin = piece.end = time_;
    piece.coefficients.resize(problem_.start.size(), order + 1);
    if (!scratch_) scratch_ = NewVector(problem_.start);
    double scale = 1;  // length^k / k!
    for (int k = 0; k <= order; ++k) {
      Check(CVodeGetDky(cvode_.get(), time_, k, scratch_.get()));
      piece.coefficients.col(k) = scale * AsVector(scratch_.get());
      scale *= piece.length / (k + 1);
    }
    return piece;
  }

  OdeStatistics Statistics() {
    OdeStatistics statistics;
    Check(CVodeGetNumSteps(cvode_.get(), &statistics.steps));
    Check(CVodeGetNumErrTestFails(cvode_.get(), &statistics.error_test_failures));
    statistics.rate_evaluations = rate_evaluations_;
    if (linear_) Check(CVodeGetNumJacEvals(cvode_.get(), &statistics.jacobian_evaluations));
    return statistics;
  }

  /// Names the cause: a rate that is not finite just ahead, otherwise the component with the
  /// greatest error.
  [[noreturn]] void Fail(const std::string& why) {
    std::string message = "ODE integration gave up at t = " + Number(time_) + " s: " + why;
    int component = -1;
    if (not_finite_ >= 0 && std::abs(not_finite_time_ - time_) <= 1e-6 * (1 + std::abs(time_))) {
      component = not_finite_;
      message += "; the rate of component " + std::to_string(component) +
                 " is not finite at t = " + Number(not_finite_time_) + " s";
    } else if (component = GreatestError(); component >= 0) {
      message += "; the error is greatest in component " + std::to_string(component) + " (" +
                 Number(AsVector(state_.get())[component]) + ")";
    }
    throw OdeError(message, time_, component);
  }

  /// The component with the greatest weighted error estimate; -1 if unknown.
  int GreatestError() {
    const Owned<N_Vector> errors = NewVector(problem_.start);
    const Owned<N_Vector> weights = NewVector(problem_.start);
    if (CVodeGetEstLocalErrors(cvode_.get(), errors.get()) != CV_SUCCESS ||
        CVodeGetErrWeights(cvode_.get(), weights.get()) != CV_SUCCESS) {
      return -1;
    }
    const Eigen::VectorXd weighted =
        AsVector(errors.get()).cwiseProduct(AsVector(weights.get())).cwiseAbs();
    Eigen::Index worst = -1;
    if (!weighted.allFinite() || weighted.maxCoeff(&worst) <= 0) return -1;
    return static_cast<int>(worst);
  }

 private:
  void CreateContext() {
    SUNContext context = nullptr;
    if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
    context_.reset(context);
  }

  Owned<N_Vector> NewVector(const Eigen::VectorXd& values) {
    Owned<N_Vector> vector(MakeStateVector(values, context_.get()));
    if (!vector) throw std::bad_alloc();
    return vector;
  }

  void SetTolerances(const OdeSettings& settings) {
    if (settings.absolute_tolerances.size() == 0) {
      Check(CVodeSStolerances(cvode_.get(), settings.relative_tolerance,
                              settings.absolute_tolerance));
      return;
    }
    const Owned<N_Vector> absolute = NewVector(settings.absolute_tolerances);
    Check(CVodeSVtolerances(cvode_.get(), settings.relative_tolerance, absolute.get()));
  }

  void SetSolver(OdeMethod method) {
    if (method == OdeMethod::kAdams) {
      fixed_point_.reset(SUNNonlinSol_FixedPoint(state_.get(), 0, context_.get()));
      if (!fixed_point_) throw std::bad_alloc();
      Check(CVodeSetNonlinearSolver(cvode_.get(), fixed_point_.get()));
      return;
    }
    if (problem_.jacobian) return SolveWithJacobian();
    const Eigen::Index size = problem_.start.size();
    matrix_.reset(SUNDenseMatrix(size, size, context_.get()));
    if (!matrix_) throw std::bad_alloc();
    linear_.reset(SUNLinSol_Dense(state_.get(), matrix_.get(), context_.get()));
    if (!linear_) throw std::bad_alloc();
    Check(CVodeSetLinearSolver(cvode_.get(), linear_.get(), matrix_.get()));
  }

  void SolveWithJacobian() {
    newton_.emplace(problem_.start.size(), problem_.positions);
    // CVODE insists on a matrix for a direct solver; this one has no entries.
    matrix_.reset(SUNMatNewEmpty(context_.get()));
    if (!matrix_) throw std::bad_alloc();
    linear_.reset(MakeNewtonLinearSolver(&*newton_, context_.get()));
    if (!linear_) throw std::bad_alloc();
    Check(CVodeSetLinearSolver(cvode_.get(), linear_.get(), matrix_.get()));
    Check(CVodeSetLinSysFn(cvode_.get(), &SetUpNewton));
  }

  void Check(int flag) {
    if (flag < 0) GiveUp(flag);
  }

  [[noreturn]] void GiveUp(int flag) {
    if (flag == CV_MEM_FAIL) throw std::bad_alloc();
    std::string why = message_;
    if (why.empty()) {
      const std::unique_ptr<char, decltype(&std::free)> name(CVodeGetReturnFlagName(flag),
                                                             &std::free);
      why = name.get();
    }
    Fail(why);
  }

  // These are called from C: no exception may pass through it.
  static int EvaluateRate(double time, N_Vector state, N_Vector rate, void* self) noexcept {
    return static_cast<Stepper*>(self)->Evaluate(time, state, rate);
  }

  int Evaluate(double time, N_Vector state, N_Vector rate) noexcept {
    constexpr int kUnrecoverable = -1, kRecoverable = 1;
    try {
      ++rate_evaluations_;
      Eigen::Map<Eigen::VectorXd> values = AsVector(rate);
      problem_.rate(time, AsVector(state), values);
      const int bad = FirstNotFinite(values);
      if (bad < 0) return 0;
      not_finite_ = bad;
      not_finite_time_ = time;
      return kRecoverable;
    } catch (...) {
      thrown_ = std::current_exception();
      return kUnrecoverable;
    }
  }

  static int SetUpNewton(double time, N_Vector state, N_Vector /*rate*/, SUNMatrix /*matrix*/,
                         booleantype jacobian_is_good, booleantype* jacobian_is_new, double gamma,
                         void* self, N_Vector, N_Vector, N_Vector) noexcept {
    Stepper* stepper = static_cast<Stepper*>(self);
    SetGamma(stepper->linear_.get(), gamma);
    *jacobian_is_new = jacobian_is_good ? SUNFALSE : SUNTRUE;
    return jacobian_is_good ? 0 : stepper->Differentiate(time, state);
  }

  int Differentiate(double time, N_Vector state) noexcept {
    constexpr int kUnrecoverable = -1, kRecoverable = 1;
    try {
      problem_.jacobian(time, AsVector(state), newton_->jacobian());
      if (!newton_->jacobian().allFinite()) return kRecoverable;
      newton_->Update();
      return 0;
    } catch (...) {
      thrown_ = std::current_exception();
      return kUnrecoverable;
    }
  }

  static void KeepMessage(int, const char*, const char*, char* message, void* self) noexcept {
    try {
      std::string& kept = static_cast<Stepper*>(self)->message_;
      kept = message;
      for (char& c : kept) {
        if (c == '\n') c = ' ';
      }
      while (!kept.empty() && (kept.back() == '.' || kept.back() == ' ')) kept.pop_back();
    } catch (...) {
      static_cast<Stepper*>(self)->thrown_ = std::current_exception();
    }
  }

  const OdeProblem& problem_;
  double time_;
  Owned<SUNContext> context_;  // created first, destroyed last
  Owned<N_Vector> state_, scratch_;
  std::optional<NewtonMatrix> newton_;  // with a given Jacobian
  Owned<SUNMatrix> matrix_;
  Owned<SUNLinearSolver> linear_;
  Owned<SUNNonlinearSolver> fixed_point_;
  std::unique_ptr<void, Free> cvode_;
  std::string message_;
  std::exception_ptr thrown_;
  int not_finite_ = -1;
  double not_finite_time_ = 0;
  long rate_evaluations_ = 0;
};

/// True if the time span is too short for a step.
bool IsRounding(const OdeProblem& problem) {
  const double magnitude = std::max(std::abs(problem.start_time), std::abs(problem.end_time));
  return problem.end_time - problem.start_time <=
         1000 * std::numeric_limits<double>::epsilon() * magnitude;
}

void FinishAt(OdeSolution* solution, OdeEnd end, double time, Eigen::VectorXd state) {
  solution->end = end;
  solution->time = time;
  solution->state = std::move(state);
}

}  // namespace

OdeError::OdeError(const std::string& message, double time, int component)
    : std::runtime_error(message), time_(time), component_(component) {}

OdeError::~OdeError() = default;

OdeSolution Integrate(const OdeProblem& problem, const OdeSettings& settings) {
  CheckProblem(problem);
  CheckSettings(settings, problem.start.size());
  OdeSolution solution;
  solution.trajectory = OdeTrajectory(problem.start_time, problem.start);
  FinishAt(&solution, OdeEnd::kTime, problem.start_time, problem.start);
  GuardSearch guards(problem, settings);
  if (problem.end_time == problem.start_time) return solution;
  if (IsRounding(problem)) {
    OdePiece piece = solution.trajectory.pieces().front();
    piece.end = solution.time = problem.end_time;
    solution.trajectory.Append(std::move(piece));
    return solution;
  }

  Stepper stepper(problem, settings);
  for (int step = 0; stepper.time() < problem.end_time; ++step) {
    if (!settings.cancellation.Proceed()) {
      FinishAt(&solution, OdeEnd::kCancelled, stepper.time(), stepper.State());
      break;
    }
    if (step == settings.max_steps) {
      stepper.Fail(std::to_string(step) + " steps taken before t = " + Number(problem.end_time) +
                   " s");
    }
    std::exception_ptr failure;
    try {
      stepper.Step();
      solution.trajectory.Append(stepper.Piece());
    } catch (...) {
      // The step may have left the region that the guards bound.
      failure = std::current_exception();
    }
    const bool is_last = failure || stepper.time() >= problem.end_time;
    if (!is_last && !guards.IsDue(stepper.time())) continue;
    if (const auto crossing = guards.Search(solution.trajectory)) {
      solution.trajectory.CutAt(crossing->time);
      FinishAt(&solution, OdeEnd::kGuard, crossing->time,
               solution.trajectory.State(crossing->time));
      solution.guards = crossing->guards;
      break;
    }
    if (failure) std::rethrow_exception(failure);
    FinishAt(&solution, OdeEnd::kTime, stepper.time(), stepper.State());
  }
  solution.statistics = stepper.Statistics();
  solution.statistics.guard_evaluations = guards.evaluations();
  return solution;
}

}  // namespace possibility::dynamics
