// Derivatives that disagree with differences stop a solve before it begins.
#include <gtest/gtest.h>

#include "collocation/study/optimal_control.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

enum class Mistake { kNone, kJacobian, kHessian, kMask };

/// y = (a, a b^2), with one mistake in the second output.
class Mistaken : public Function {
 public:
  explicit Mistaken(Mistake mistake) : Function(2, 2), mistake_(mistake) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override { *y << z[0], z[0] * z[1] * z[1]; }
  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    const double factor = mistake_ == Mistake::kJacobian ? 1 : 2;
    *J << 1, 0, z[1] * z[1], factor * z[0] * z[1];
  }
  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const double factor = mistake_ == Mistake::kHessian ? 1 : 2;
    *H << 0, 2 * z[1], 2 * z[1], factor * z[0];
    *H *= multipliers[1];
  }
  Mask JacobianMask() const override { return Mask{{true, false}, {true, true}}; }
  Mask HessianMask() const override {
    return Mask{{false, mistake_ != Mistake::kMask}, {mistake_ != Mistake::kMask, true}};
  }

 private:
  Mistake mistake_;
};

/// A leg with knee and hip, swung by torques; the guess has a knee of 0.5 and a hip of 0.75.
struct Leg {
  Leg() : swing(problem.AddPhase("swing", 2)) {
    knee = swing.AddCoordinate("knee");
    hip = swing.AddCoordinate("hip");
    const Variable u = swing.AddControl("torque");
    swing.SetDuration(1);
    swing.SetDynamics(Differentiated<1, 2>([](const auto& z, auto* a) {
                        (*a)[0] = z[0];
                        (*a)[1] = z[0];
                      }),
                      {u});
    swing.Guess(knee, 0.5);
    swing.Guess(hip, 0.75);
    swing.AddIntegralCost(
        "effort", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = z[0] * z[0]; }), {u});
  }

  OptimalControlResult Solve(bool check = true) const {
    OptimalControlOptions options;
    options.intervals = {4};
    options.check_derivatives = check;
    return SolveOptimalControl(problem, options);
  }

  OptimalControlProblem problem{"leg"};
  Phase& swing;
  Variable knee, hip;
};

OptimalControlResult SolveWith(Mistake mistake, At at = At::kEverywhere) {
  Leg leg;
  leg.swing.Constrain("motion", std::make_shared<Mistaken>(mistake), {leg.knee, leg.hip}, {{-9, 9}},
                      at);
  return leg.Solve();
}

TEST(WrongDerivatives, NoneLetTheSolveBegin) {
  const OptimalControlResult result = SolveWith(Mistake::kNone);
  EXPECT_EQ(result.status, SolverStatus::kSolved) << result.message;
}

TEST(WrongDerivatives, AJacobianIsNamedWithKnotOutputAndArgument) {
  const OptimalControlResult result = SolveWith(Mistake::kJacobian);
  EXPECT_EQ(result.status, SolverStatus::kWrongDerivative);
  EXPECT_EQ(result.message,
            "constraint 'motion', phase 'swing', knot 0: d output 1 / d argument 'hip' is 0.375, "
            "differences give 0.75 (and 2 more)");
  EXPECT_TRUE(result.solver.history.empty()) << "nothing was solved";
  EXPECT_NEAR(result.trajectory.phases.at(0).Coordinates(0.5)[1], 0.75, 1e-12) << "the guess";
}

TEST(WrongDerivatives, AHessianIsNamedWithKnotOutputAndArguments) {
  EXPECT_EQ(SolveWith(Mistake::kHessian, At::kEnd).message,
            "constraint 'motion', phase 'swing', knot 4: d2 output 1 / d argument 'hip' d argument "
            "'hip' is 0.5, differences give 1");
}

TEST(WrongDerivatives, AMaskIsNamedWithKnotOutputAndArguments) {
  EXPECT_EQ(
      SolveWith(Mistake::kMask, At::kInside).message,
      "constraint 'motion', phase 'swing', interval 0, node 1: d2 output 1 / d argument 'knee' d "
      "argument 'hip' is 1.5 and left out by the mask, differences give 1.5 (and 5 more)");
}

/// A square whose derivative forgets the factor 2.
class HalfSquare : public Function {
 public:
  HalfSquare() : Function(1, 1) {}
  void Evaluate(const VectorXd& z, VectorXd* y) override { (*y)[0] = z[0] * z[0]; }
  void Jacobian(const VectorXd& z, MatrixXd* J) override { (*J)(0, 0) = z[0]; }
  void Hessian(const VectorXd&, const VectorXd& multipliers, MatrixXd* H) override {
    (*H)(0, 0) = multipliers[0];
  }
};

TEST(WrongDerivatives, OfCostsAndLinksAreNamed) {
  const auto wrong = std::make_shared<HalfSquare>();
  Leg cost, link, end_cost;
  cost.swing.AddIntegralCost("bend", wrong, {cost.hip});
  EXPECT_EQ(cost.Solve().message,
            "cost 'bend', phase 'swing', knot 0: d output 0 / d argument 'hip' is 0.75, "
            "differences give 1.5 (and 2 more)");
  link.problem.Link("goal", wrong, {{link.knee, At::kEnd}}, {{0, 1}});
  EXPECT_EQ(link.Solve().message,
            "constraint 'goal': d output 0 / d argument 'swing: knee' is 0.5, differences give 1");
  end_cost.problem.AddCost("goal", wrong, {{end_cost.knee, At::kEnd}});
  EXPECT_EQ(end_cost.Solve().message,
            "cost 'goal': d output 0 / d argument 'swing: knee' is 0.5, differences give 1");
}

TEST(WrongDerivatives, AreNotLookedForUnlessAsked) {
  Leg leg;
  leg.swing.AddIntegralCost("bend", std::make_shared<HalfSquare>(), {leg.hip});
  EXPECT_NE(leg.Solve(false).status, SolverStatus::kWrongDerivative);
}

TEST(WrongDerivatives, WhereAFunctionIsUndefinedTheSolverNamesIt) {
  Leg leg;
  leg.swing.AddIntegralCost(
      "root", Differentiated<1, 1>([](const auto& z, auto* c) { (*c)[0] = sqrt(z[0] - 2); }),
      {leg.hip});
  EXPECT_EQ(leg.Solve().status, SolverStatus::kInvalidNumber);
}

}  // namespace
}  // namespace possibility::collocation
