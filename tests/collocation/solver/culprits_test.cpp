// Problems that cannot be solved. Each has an error that names its cause.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "collocation/study/optimal_control.h"
#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

/// A mass on a line, from rest at 0.
struct Mass {
  explicit Mass(Bounds force = {}) : phase(problem.AddPhase("lift", 2)) {
    q = phase.AddCoordinate("q");
    u = phase.AddControl("force", force);
    phase.SetDynamics(Differentiated<1, 1>([](const auto& z, auto* a) { (*a)[0] = z[0]; }), {u});
    phase.Fix(q, 0, At::kStart);
    phase.Fix(phase.Rate(q), 0, At::kStart);
  }

  OptimalControlProblem problem{"mass"};
  Phase& phase;
  Variable q, u;
};

bool Contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string Refusal(const OptimalControlProblem& problem) {
  return MessageOf([&] { SolveOptimalControl(problem); });
}

TEST(Culprits, InfeasibleNamesTheWorstConstraintItsKnotAndHowFar) {
  Mass mass({-100, 100});
  mass.phase.SetDuration(1);
  mass.phase.Fix(mass.q, 2, At::kEnd);
  // At the end q^2 is 4, 3 above the bound, whatever the force.
  mass.phase.Constrain("tunnel",
                       Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }),
                       {mass.q}, {{-1, 1}}, At::kEverywhere, {10});
  const OptimalControlResult result = SolveOptimalControl(mass.problem);
  EXPECT_EQ(result.status, SolverStatus::kInfeasible) << result.message;
  EXPECT_TRUE(Contains(result.message,
                       "constraint 'lift, knot 20 (t = 1 of the duration): tunnel' "
                       "is off by 3"))
      << result.message;
  const ConstraintViolation& worst = result.violations.at("lift: tunnel");
  EXPECT_NEAR(worst.amount, 3, 1e-4);
  EXPECT_TRUE(Contains(worst.where, "knot 20")) << worst.where;
}

// The end is fixed outside the tunnel. With a strong force, most points violate the constraints as
// little as any other, which used to keep the solver busy until its last iteration.
TEST(Culprits, InfeasibleIsFoundWhateverTheForce) {
  std::mt19937 random(7);
  const auto between = [&random](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  for (int k = 0; k < 60; ++k) {
    const double force = std::pow(10, between(-1, 3)), duration = between(0.3, 4.3);
    const double bound = between(0.2, 1.2), end = between(1.3, 6.3);
    Mass mass({-force, force});
    mass.phase.SetDuration(duration);
    mass.phase.Fix(mass.q, end, At::kEnd);
    mass.phase.Constrain(
        "tunnel", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }),
        {mass.q}, {{-bound, bound}}, At::kEverywhere, {10});
    const OptimalControlResult result = SolveOptimalControl(mass.problem);
    EXPECT_EQ(result.status, SolverStatus::kInfeasible)
        << "force " << force << ", duration " << duration << ", bound " << bound << ", end " << end
        << ": " << result.message;
  }
}

TEST(Culprits, InfeasibleByABoundOnForceNamesTheConstraint) {
  Mass mass({-0.1, 0.1});
  mass.phase.SetDuration(0.5);
  mass.phase.Fix(mass.q, 2, At::kEnd);
  const OptimalControlResult result = SolveOptimalControl(mass.problem);
  EXPECT_EQ(result.status, SolverStatus::kInfeasible);
  EXPECT_TRUE(Contains(result.message, "constraint 'lift, ")) << result.message;
  EXPECT_TRUE(Contains(result.message, "is off by ")) << result.message;
}

/// Nothing bounds the position, and the objective rewards a large one.
TEST(Culprits, UnboundedNamesTheVariableThatGrew) {
  Mass mass;
  mass.phase.SetDuration(1);
  mass.problem.AddCost({mass.q, At::kEnd}, -1);
  const OptimalControlResult result = SolveOptimalControl(mass.problem);
  EXPECT_EQ(result.status, SolverStatus::kUnbounded) << result.message;
  EXPECT_TRUE(Contains(result.message, "nothing bounds the objective")) << result.message;
  EXPECT_TRUE(Contains(result.message, "'lift, ")) << result.message;
  EXPECT_TRUE(Contains(result.message, "reached 1")) << result.message;
  EXPECT_LT(result.objective, -1e6);
}

/// The objective diverges long before a variable does.
TEST(Culprits, UnboundedByAnExponentialIsNamed) {
  Mass mass;
  mass.phase.SetDuration(1);
  mass.phase.AddIntegralCost(
      "gain", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = -exp(z[0]); }), {mass.u});
  const OptimalControlResult result = SolveOptimalControl(mass.problem);
  EXPECT_EQ(result.status, SolverStatus::kUnbounded) << result.message;
  EXPECT_LT(result.objective, -1e12);
}

TEST(Culprits, NotANumberInTheDynamicsNamesTheKnot) {
  OptimalControlProblem problem("root");
  Phase& phase = problem.AddPhase("go");
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration(1);
  // The guess goes from 1 to 0 along a line. Below 0.48 the root is undefined: from knot 11 on.
  phase.SetDynamics(
      Differentiated<1, 1>([](const auto& z, auto* f) { (*f)[0] = sqrt(z[0] - 0.48); }), {x});
  phase.Fix(x, 1, At::kStart);
  phase.Fix(x, 0, At::kEnd);
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  const OptimalControlResult result = SolveOptimalControl(problem, options);
  EXPECT_EQ(result.status, SolverStatus::kInvalidNumber);
  EXPECT_TRUE(Contains(result.message,
                       "constraint 'go, knot 11 (t = 0.55 of the duration): "
                       "dynamics'"))
      << result.message;
  EXPECT_TRUE(Contains(result.message, "nan at the starting point")) << result.message;
  EXPECT_TRUE(std::isinf(result.mesh_error)) << "not known where the dynamics are none";
}

TEST(Culprits, NotANumberInACostNamesTheCostAndTheKnot) {
  Mass mass;
  mass.phase.SetDuration(1);
  mass.phase.Fix(mass.q, 2, At::kEnd);
  mass.phase.AddIntegralCost(
      "height", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = sqrt(1.04 - z[0]); }),
      {mass.q});
  OptimalControlOptions options;
  options.scheme = Trapezoidal();
  const OptimalControlResult result = SolveOptimalControl(mass.problem, options);
  EXPECT_EQ(result.status, SolverStatus::kInvalidNumber);
  EXPECT_TRUE(Contains(result.message, "cost 'lift, knot 11 (t = 0.55 of the duration): height'"))
      << result.message;
}

enum class Call { kEvaluate, kJacobian, kHessian };

/// y = (0, z^2). Above 1 one of its calls fails.
class Fails : public Function {
 public:
  Fails(Call where, std::function<double()> how, int outputs = 1)
      : Function(1, outputs), where_(where), how_(std::move(how)) {}

  void Evaluate(const Eigen::VectorXd& z, Eigen::VectorXd* y) override {
    y->setZero();
    (*y)[num_outputs() - 1] = z[0] * z[0] + Failure(Call::kEvaluate, z);
  }
  void Jacobian(const Eigen::VectorXd& z, Eigen::MatrixXd* J) override {
    J->setZero();
    (*J)(num_outputs() - 1, 0) = 2 * z[0] + Failure(Call::kJacobian, z);
  }
  void Hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers,
               Eigen::MatrixXd* H) override {
    H->setConstant(2 * multipliers[num_outputs() - 1] + Failure(Call::kHessian, z));
  }

 private:
  double Failure(Call call, const Eigen::VectorXd& z) const {
    return call == where_ && z[0] > 1 ? how_() : 0;
  }

  Call where_;
  std::function<double()> how_;
};

double TableEnds() { throw std::runtime_error("the table ends at 1"); }
double NotANumber() { return std::nan(""); }

/// Its guess rises from 0 to 2 along a line, so it is above 1 from knot 11 on.
struct RisingMass : Mass {
  RisingMass() {
    phase.SetDuration(1);
    phase.Fix(q, 2, At::kEnd);
  }
  OptimalControlResult Solve() const {
    OptimalControlOptions options;
    options.scheme = Trapezoidal();
    const OptimalControlResult result = SolveOptimalControl(problem, options);
    EXPECT_EQ(result.status, SolverStatus::kInvalidNumber);
    return result;
  }
};

constexpr char kTable[] = "'lift, knot 11 (t = 0.55 of the duration): table'";

TEST(Culprits, AConstraintThatThrowsIsNamedWithItsKnotAndItsOwnText) {
  for (const Call call : {Call::kEvaluate, Call::kJacobian, Call::kHessian}) {
    RisingMass mass;
    mass.phase.Constrain("table", std::make_shared<Fails>(call, TableEnds, 2), {mass.q}, {{-5, 5}});
    const OptimalControlResult result = mass.Solve();
    EXPECT_TRUE(
        Contains(result.message, "constraint " + std::string(kTable) + ": the table ends at 1"))
        << result.message;
  }
}

TEST(Culprits, ACostThatThrowsIsNamedWithItsKnotAndItsOwnText) {
  for (const Call call : {Call::kEvaluate, Call::kJacobian, Call::kHessian}) {
    RisingMass mass;
    mass.phase.AddIntegralCost("table", std::make_shared<Fails>(call, TableEnds), {mass.q});
    const OptimalControlResult result = mass.Solve();
    EXPECT_TRUE(Contains(result.message, "cost " + std::string(kTable) + ": the table ends at 1"))
        << result.message;
  }
}

TEST(Culprits, DynamicsThatThrowAreNamedWithTheirKnot) {
  OptimalControlProblem problem("table");
  Phase& phase = problem.AddPhase("go");
  const Variable x = phase.AddCoordinate("x");
  phase.SetDuration(1);
  phase.SetDynamics(std::make_shared<Fails>(Call::kEvaluate, TableEnds), {x});
  phase.Fix(x, 2, At::kEnd);
  phase.Guess(x, [](double s) { return 2 * s; });
  EXPECT_EQ(SolveOptimalControl(problem).message,
            "constraint 'go, interval 10, node 1 (t = 0.525 of the duration): dynamics': the table "
            "ends at 1 at the starting point");
}

TEST(Culprits, LinksAndEndCostsThatThrowAreNamed) {
  RisingMass link, cost;
  link.problem.Link("goal", std::make_shared<Fails>(Call::kEvaluate, TableEnds),
                    {{link.q, At::kEnd}}, {{0, 1}});
  EXPECT_TRUE(Contains(link.Solve().message, "constraint 'goal': the table ends at 1"));
  cost.problem.AddCost("goal", std::make_shared<Fails>(Call::kEvaluate, TableEnds),
                       {{cost.q, At::kEnd}});
  EXPECT_TRUE(Contains(cost.Solve().message, "cost 'goal': the table ends at 1"));
}

TEST(Culprits, NotANumberNamesTheOutput) {
  RisingMass value, slope, curvature;
  const auto add = [](RisingMass* mass, Call call) {
    mass->phase.Constrain("table", std::make_shared<Fails>(call, NotANumber, 2), {mass->q},
                          {{-5, 5}});
    return mass->Solve().message;
  };
  const std::string row = "constraint 'lift, knot 11 (t = 0.55 of the duration): table";
  const std::string q = "'lift, knot 11 (t = 0.55 of the duration): q'";
  const std::string of_value = add(&value, Call::kEvaluate);
  EXPECT_TRUE(Contains(of_value, row + "[1]' is nan")) << of_value;
  const std::string of_slope = add(&slope, Call::kJacobian);
  EXPECT_TRUE(Contains(of_slope, row + "[1]' with respect to " + q + " is nan")) << of_slope;
  const std::string of_curvature = add(&curvature, Call::kHessian);
  EXPECT_TRUE(Contains(of_curvature, row + "': the second derivative with respect to " + q +
                                         " and " + q + " is nan"))
      << of_curvature;
}

TEST(Culprits, ASecondDerivativeOfACostThatIsNotANumberIsNamed) {
  RisingMass mass;
  mass.phase.AddIntegralCost("table", std::make_shared<Fails>(Call::kHessian, NotANumber),
                             {mass.q});
  const std::string message = mass.Solve().message;
  EXPECT_TRUE(Contains(message, "cost " + std::string(kTable) + ": the second derivative with"))
      << message;
}

TEST(Culprits, OtherExceptionsOfFunctionsReachTheCaller) {
  const auto bug = []() -> double { throw std::logic_error("a bug"); };
  for (const Call call : {Call::kEvaluate, Call::kJacobian, Call::kHessian}) {
    RisingMass constraint, cost;
    constraint.phase.Constrain("table", std::make_shared<Fails>(call, bug), {constraint.q},
                               {{-5, 5}});
    cost.phase.AddIntegralCost("table", std::make_shared<Fails>(call, bug), {cost.q});
    for (const OptimalControlProblem* problem : {&constraint.problem, &cost.problem}) {
      EXPECT_EQ(MessageOf<std::logic_error>([&] { SolveOptimalControl(*problem); }), "a bug");
    }
  }
}

TEST(Culprits, AGuessThatIsNotANumberNamesItsKnot) {
  Mass mass;
  mass.phase.SetDuration(1);
  mass.phase.Guess(mass.q, [](double s) { return s > 0.96 ? std::nan("") : 0; });
  EXPECT_EQ(Refusal(mass.problem),
            "the guess of the variables: 'lift, interval 19, node 1 (t = 0.975 of the duration): "
            "q' is nan");
}

TEST(Culprits, PhasesWithoutDurationOrAscendingMeshAreRefused) {
  Mass mass;
  EXPECT_EQ(Refusal(mass.problem), "mass: phase 'lift': no duration was set");
  EXPECT_EQ(MessageOf([&] { mass.phase.SetDuration(0); }),
            "mass: phase 'lift': expected a duration within finite bounds above 0, got [0, 0]");
  EXPECT_EQ(MessageOf([&] {
              mass.phase.SetDuration({0, 1});
            }),
            "mass: phase 'lift': expected a duration within finite bounds above 0, got [0, 1]");
  EXPECT_EQ(MessageOf([&] { mass.phase.SetDuration(std::nan("")); }),
            "mass: phase 'lift': expected a duration within finite bounds above 0, got [nan, nan]");
  mass.phase.SetDuration(1);
  OptimalControlOptions options;
  options.meshes = {{0, 0.5, 0.5, 1}};
  EXPECT_EQ(MessageOf([&] { SolveOptimalControl(mass.problem, options); }),
            "mass: phase 'lift': the mesh must ascend from 0 to 1");
}

TEST(Culprits, ContradictoryBoundsAreRefusedByName) {
  Mass mass({-1, 1});
  mass.phase.SetDuration(1);
  mass.phase.Fix(mass.u, 2, At::kEnd);
  EXPECT_EQ(Refusal(mass.problem),
            "mass: lift, knot 20 (t = 1 of the duration): force: contradictory bounds [2, 1]");
  EXPECT_EQ(MessageOf([&] {
              mass.phase.Constrain("narrow", Differentiated<1, 1>([](const auto&, auto*) {}),
                                   {mass.q}, {{1, -1}});
            }),
            "mass: phase 'lift': 'narrow': contradictory bounds [1, -1]");
  EXPECT_EQ(MessageOf([&] {
              mass.problem.AddParameter("gain", {std::nan(""), 1});
            }),
            "mass: parameter 'gain': contradictory bounds [nan, 1]");
}

TEST(Culprits, ContradictoryBoundsWherePhasesMeetAreRefusedByName) {
  OptimalControlProblem problem("relay");
  std::vector<Variable> x;
  for (const char* name : {"first", "second"}) {
    Phase& phase = problem.AddPhase(name);
    x.push_back(phase.AddCoordinate("x", x.empty() ? Bounds{0, 1} : Bounds{2, 3}));
    phase.SetDuration(1);
  }
  problem.Continue({x[0], At::kEnd}, {x[1], At::kStart});
  EXPECT_EQ(Refusal(problem),
            "relay: second, knot 0 (t = 0 of the duration): x: contradictory bounds [2, 1] where "
            "phases meet");
}

TEST(Culprits, ProblemsWithoutPhasesOrCoordinatesAreRefused) {
  OptimalControlProblem problem("nothing");
  EXPECT_EQ(Refusal(problem), "nothing: the problem has no phase");
  Phase& phase = problem.AddPhase("void");
  phase.SetDuration(1);
  EXPECT_EQ(Refusal(problem), "nothing: phase 'void': the phase has no coordinates");
}

TEST(Culprits, MeshesOfWrongNumberOrSizeAreRefused) {
  Mass mass;
  mass.phase.SetDuration(1);
  OptimalControlOptions options;
  options.intervals = {3, 4};
  EXPECT_EQ(MessageOf([&] { SolveOptimalControl(mass.problem, options); }),
            "mass: 2 numbers of intervals for 1 phases");
  options.intervals = {0};
  EXPECT_EQ(MessageOf([&] { SolveOptimalControl(mass.problem, options); }),
            "a mesh has 0 intervals, expected 1 or more");
}

}  // namespace
}  // namespace possibility::collocation
