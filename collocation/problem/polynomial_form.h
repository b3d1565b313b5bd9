#pragma once

#include <Eigen/Core>
#include <vector>

namespace possibility::collocation {

/// One term of a PolynomialForm: coefficient * x[variable] * x[duration]^power.
struct Monomial {
  int variable = -1;  ///< -1: the constant 1
  double coefficient = 0;
  int power = 0;  ///< -1 to 2; -1 in rates of controls
};

/// A point whose variables are all 1, however many: where only the places of derivatives are asked
/// for.
struct AllOnes {
  double operator[](int) const { return 1; }
};

/// A sum of monomials in the variables of a program, all with the same duration. Transcription
/// makes such forms of integrals and interpolants: they are linear in the variables except for the
/// duration of a phase.
struct PolynomialForm {
  int duration = -1;  ///< variable; -1: no monomial has a power
  std::vector<Monomial> monomials;

  double Value(const Eigen::VectorXd& x) const;
  /// `x`: the variables, by index. Calls visit(variable, derivative) for the variable of each
  /// monomial; the duration comes last, with its derivatives summed up.
  template <typename Point, typename Visit>
  void Gradient(const Point& x, const Visit& visit) const;
  /// Calls visit(variable, variable, derivative) for each second derivative that may be non-zero.
  /// All of them involve the duration; a mixed pair is visited once.
  template <typename Point, typename Visit>
  void Hessian(const Point& x, const Visit& visit) const;
  bool is_linear() const { return duration < 0; }

 private:
  static double Power(double t, int power) {
    switch (power) {
      case 0:
        return 1;
      case 1:
        return t;
      case 2:
        return t * t;
      default:
        return power < 0 ? Power(1 / t, -power) : t * Power(t, power - 1);
    }
  }
};

inline double PolynomialForm::Value(const Eigen::VectorXd& x) const {
  double sum = 0;
  if (is_linear()) {
    for (const Monomial& m : monomials) {
      sum += m.coefficient * (m.variable < 0 ? 1 : x[m.variable]);
    }
    return sum;
  }
  const double t = x[duration];
  for (const Monomial& m : monomials) {
    sum += m.coefficient * (m.variable < 0 ? 1 : x[m.variable]) * Power(t, m.power);
  }
  return sum;
}

template <typename Point, typename Visit>
void PolynomialForm::Gradient(const Point& x, const Visit& visit) const {
  const double t = duration < 0 ? 1 : x[duration];
  double by_duration = 0;
  for (const Monomial& m : monomials) {
    if (m.variable >= 0) visit(m.variable, m.coefficient * Power(t, m.power));
    if (m.power != 0) {
      const double value = m.variable < 0 ? 1 : x[m.variable];
      by_duration += m.coefficient * value * m.power * Power(t, m.power - 1);
    }
  }
  if (duration >= 0) visit(duration, by_duration);
}

template <typename Point, typename Visit>
void PolynomialForm::Hessian(const Point& x, const Visit& visit) const {
  if (duration < 0) return;
  const double t = x[duration];
  double by_duration = 0;
  for (const Monomial& m : monomials) {
    if (m.power == 0) continue;
    if (m.variable >= 0) {
      visit(m.variable, duration, m.coefficient * m.power * Power(t, m.power - 1));
    }
    if (m.power == 1) continue;
    by_duration += m.power * (m.power - 1) * m.coefficient * (m.variable < 0 ? 1 : x[m.variable]) *
                   Power(t, m.power - 2);
  }
  visit(duration, duration, by_duration);
}

}  // namespace possibility::collocation
