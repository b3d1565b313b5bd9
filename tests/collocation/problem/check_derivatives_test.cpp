#include "collocation/problem/check_derivatives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

#include "tests/message_of.h"

namespace possibility::collocation {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Kind = DerivativeFault::Kind;

/// y = (a sin b, b c^2) with derivatives that a test may spoil.
class Spoilt : public Function {
 public:
  Spoilt() : Function(3, 2) {}

  void Evaluate(const VectorXd& z, VectorXd* y) override {
    *y << z[0] * std::sin(z[1]), z[1] * z[2] * z[2];
  }
  void Jacobian(const VectorXd& z, MatrixXd* J) override {
    *J << std::sin(z[1]), z[0] * std::cos(z[1]), 0,  //
        0, z[2] * z[2], 2 * z[1] * z[2];
    if (spoil_jacobian) spoil_jacobian(J);
  }
  void Hessian(const VectorXd& z, const VectorXd& multipliers, MatrixXd* H) override {
    const double mixed = multipliers[0] * std::cos(z[1]);
    const double last = 2 * multipliers[1] * z[2];
    *H << 0, mixed, 0,  //
        mixed, -multipliers[0] * z[0] * std::sin(z[1]), last, 0, last, 2 * multipliers[1] * z[1];
    if (spoil_hessian) spoil_hessian(multipliers, H);
  }
  Mask JacobianMask() const override { return jacobian_mask; }
  Mask HessianMask() const override { return hessian_mask; }

  std::function<void(MatrixXd*)> spoil_jacobian;
  std::function<void(const VectorXd&, MatrixXd*)> spoil_hessian;
  Mask jacobian_mask{{true, true, false}, {false, true, true}};
  Mask hessian_mask{{false, true, false}, {true, true, true}, {false, true, true}};
};

const Vector3d kPoint(0.8, -0.7, 1.3);

/// Expects one fault at a place, and returns it.
DerivativeFault OnlyFault(Spoilt* f, Kind kind, int row, int column, int output) {
  const auto faults = CheckDerivatives(f, kPoint);
  EXPECT_EQ(faults.size(), 1U);
  if (faults.empty()) return {};
  EXPECT_EQ(faults[0].kind, kind);
  EXPECT_EQ(faults[0].row, row);
  EXPECT_EQ(faults[0].column, column);
  EXPECT_EQ(faults[0].output, output);
  return faults[0];
}

TEST(CheckDerivatives, RightOnesHaveNoFaults) {
  Spoilt f;
  EXPECT_TRUE(CheckDerivatives(&f, kPoint).empty());
  EXPECT_TRUE(CheckDerivatives(&f, Vector3d::Zero()).empty());
  EXPECT_TRUE(CheckDerivatives(&f, 1e4 * kPoint).empty());
}

TEST(CheckDerivatives, AWrongJacobianIsFound) {
  Spoilt f;
  f.spoil_jacobian = [](MatrixXd* J) { (*J)(1, 2) *= 1 + 1e-5; };
  const DerivativeFault fault = OnlyFault(&f, Kind::kJacobian, 1, 2, 1);
  EXPECT_NEAR(fault.differenced, -2 * 0.7 * 1.3, 1e-10);
  EXPECT_NEAR(fault.given, -2 * 0.7 * 1.3 * (1 + 1e-5), 1e-10);
}

TEST(CheckDerivatives, ATermMissingFromTheJacobianIsFound) {
  Spoilt f;
  f.spoil_jacobian = [](MatrixXd* J) { (*J)(0, 0) = 0; };
  EXPECT_EQ(OnlyFault(&f, Kind::kJacobian, 0, 0, 0).given, 0);
}

TEST(CheckDerivatives, AJacobianThatIsNotWrittenIsFound) {
  Spoilt f;
  f.spoil_jacobian = [](MatrixXd* J) { (*J)(0, 1) = std::nan(""); };
  EXPECT_TRUE(std::isnan(OnlyFault(&f, Kind::kJacobian, 0, 1, 0).given));
}

TEST(CheckDerivatives, AWrongHessianIsFoundWithItsOutput) {
  Spoilt f;
  f.spoil_hessian = [](const VectorXd& multipliers, MatrixXd* H) {
    (*H)(1, 2) += 1e-5 * multipliers[1];
  };
  const DerivativeFault fault = OnlyFault(&f, Kind::kHessian, 1, 2, 1);
  EXPECT_NEAR(fault.differenced, 2 * 1.3, 1e-9);
  EXPECT_NEAR(fault.given, 2 * 1.3 + 1e-5, 1e-9);
}

TEST(CheckDerivatives, AHessianThatDropsAnOutputOfSeveralIsFound) {
  Spoilt f;
  // Right for each output alone.
  f.spoil_hessian = [](const VectorXd& multipliers, MatrixXd* H) {
    if (multipliers[0] != 0) (*H)(2, 2) = 0;
  };
  OnlyFault(&f, Kind::kHessian, 2, 2, -1);
}

TEST(CheckDerivatives, AMaskThatHidesTheJacobianIsFound) {
  Spoilt f;
  f.jacobian_mask(1, 1) = false;
  EXPECT_NEAR(OnlyFault(&f, Kind::kJacobianMask, 1, 1, 1).differenced, 1.3 * 1.3, 1e-9);
  // Neither may the function leave it out.
  f.spoil_jacobian = [](MatrixXd* J) { (*J)(1, 1) = 0; };
  EXPECT_EQ(OnlyFault(&f, Kind::kJacobianMask, 1, 1, 1).given, 0);
}

TEST(CheckDerivatives, AMaskThatHidesTheHessianIsFound) {
  Spoilt f;
  f.hessian_mask(2, 2) = false;
  const DerivativeFault fault = OnlyFault(&f, Kind::kHessianMask, 2, 2, 1);
  EXPECT_NEAR(fault.given, -2 * 0.7, 1e-12);
}

TEST(CheckDerivatives, AValueOutsideTheMaskThatShouldBeZeroIsFound) {
  Spoilt f;
  f.spoil_jacobian = [](MatrixXd* J) { (*J)(0, 2) = 0.1; };
  EXPECT_EQ(OnlyFault(&f, Kind::kJacobianMask, 0, 2, 0).given, 0.1);
}

TEST(CheckDerivatives, WhatIsOutsideTheMaskNeedNotBeWritten) {
  Spoilt f;
  f.spoil_jacobian = [](MatrixXd* J) { (*J)(0, 2) = std::nan(""); };
  EXPECT_TRUE(CheckDerivatives(&f, kPoint).empty());
}

/// At an edge of its domain, at a kink and where it varies faster than its argument's size.
TEST(CheckDerivatives, DoesNotAccuseWhereDifferencesFail) {
  const auto root = Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = sqrt(z[0]); });
  EXPECT_TRUE(CheckDerivatives(root.get(), VectorXd::Constant(1, 1e-5)).empty());
  EXPECT_TRUE(CheckDerivatives(root.get(), VectorXd::Constant(1, 0.05)).empty());
  const auto fast = Differentiated<1, 1>([](const auto& z, auto* y) { (*y)[0] = sin(300 * z[0]); });
  DerivativeCheck check;
  EXPECT_TRUE(CheckDerivatives(fast.get(), VectorXd::Constant(1, 0.3), check).empty());
  check.sizes = VectorXd::Constant(1, 0.01);
  EXPECT_TRUE(CheckDerivatives(fast.get(), VectorXd::Constant(1, 0.3), check).empty());
}

TEST(CheckDerivatives, SizesMustFit) {
  Spoilt f;
  EXPECT_EQ(MessageOf([&] { CheckDerivatives(&f, VectorXd::Zero(2)); }),
            "CheckDerivatives: 2 arguments, expected 3");
  DerivativeCheck check;
  check.multipliers = VectorXd::Zero(3);
  EXPECT_EQ(MessageOf([&] { CheckDerivatives(&f, kPoint, check); }),
            "CheckDerivatives: 3 multipliers, expected 2");
}

}  // namespace
}  // namespace possibility::collocation
