#pragma once

#include <Eigen/Core>
#include <cmath>

namespace possibility::collocation {

/// Forward automatic differentiation: a number with its exact gradient with respect to N inputs
/// and, for order 2, its Hessian. Functions written for any scalar type accept it in place of
/// double; comparisons use the value.
template <int N, int Order>
struct Jet {
  static_assert(Order == 1 || Order == 2);
  static constexpr int kHessian = Order == 2 ? N : 0;
  using Gradient = Eigen::Matrix<double, N, 1, Eigen::DontAlign>;
  using Hessian = Eigen::Matrix<double, kHessian, kHessian, Eigen::DontAlign>;

  double value = 0;
  Gradient gradient = Gradient::Zero();
  Hessian hessian = Hessian::Zero();

  Jet() = default;
  Jet(double constant) : value(constant) {}  // NOLINT(google-explicit-constructor): as a number

  static Jet Input(double value, int index) {
    Jet x(value);
    x.gradient[index] = 1;
    return x;
  }

  Jet operator-() const { return Chain(-value, -1, 0); }
  Jet& operator+=(const Jet& b) {
    value += b.value;
    gradient += b.gradient;
    hessian += b.hessian;
    return *this;
  }
  Jet& operator-=(const Jet& b) {
    value -= b.value;
    gradient -= b.gradient;
    hessian -= b.hessian;
    return *this;
  }
  Jet& operator*=(const Jet& b) { return *this = *this * b; }
  Jet& operator/=(const Jet& b) { return *this = *this / b; }

  friend Jet operator+(Jet a, const Jet& b) { return a += b; }
  friend Jet operator-(Jet a, const Jet& b) { return a -= b; }
  friend Jet operator*(const Jet& a, const Jet& b) {
    Jet result(a.value * b.value);
    result.gradient = b.value * a.gradient + a.value * b.gradient;
    if constexpr (Order == 2) {
      result.hessian = b.value * a.hessian + a.value * b.hessian;
      result.hessian += a.gradient * b.gradient.transpose();
      result.hessian += b.gradient * a.gradient.transpose();
    }
    return result;
  }
  friend Jet operator*(double a, const Jet& b) { return b.Chain(a * b.value, a, 0); }
  friend Jet operator*(const Jet& a, double b) { return b * a; }
  friend Jet operator/(const Jet& a, double b) { return (1 / b) * a; }
  friend Jet operator/(const Jet& a, const Jet& b) {
    const double inverse = 1 / b.value;
    return a * b.Chain(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
  }

  friend bool operator<(const Jet& a, const Jet& b) { return a.value < b.value; }
  friend bool operator>(const Jet& a, const Jet& b) { return a.value > b.value; }

  /// f of this number, given the value and the first two derivatives of f there.
  Jet Chain(double f, double first, double second) const {
    Jet result(f);
    result.gradient = first * gradient;
    if constexpr (Order == 2) {
      result.hessian = first * hessian;
      if (second != 0) result.hessian += second * gradient * gradient.transpose();
    }
    return result;
  }
};

// For plain numbers; the overloads for jets follow.
using std::atan;
using std::cos;
using std::exp;
using std::log;
using std::pow;
using std::sin;
using std::sqrt;
using std::tan;
using std::tanh;

template <int N, int Order>
Jet<N, Order> sin(const Jet<N, Order>& x) {
  const double s = std::sin(x.value);
  return x.Chain(s, std::cos(x.value), -s);
}

template <int N, int Order>
Jet<N, Order> cos(const Jet<N, Order>& x) {
  const double c = std::cos(x.value);
  return x.Chain(c, -std::sin(x.value), -c);
}

template <int N, int Order>
Jet<N, Order> tan(const Jet<N, Order>& x) {
  const double t = std::tan(x.value);
  return x.Chain(t, 1 + t * t, 2 * t * (1 + t * t));
}

template <int N, int Order>
Jet<N, Order> atan(const Jet<N, Order>& x) {
  const double d = 1 / (1 + x.value * x.value);
  return x.Chain(std::atan(x.value), d, -2 * x.value * d * d);
}

template <int N, int Order>
Jet<N, Order> exp(const Jet<N, Order>& x) {
  const double e = std::exp(x.value);
  return x.Chain(e, e, e);
}

template <int N, int Order>
Jet<N, Order> log(const Jet<N, Order>& x) {
  return x.Chain(std::log(x.value), 1 / x.value, -1 / (x.value * x.value));
}

template <int N, int Order>
Jet<N, Order> sqrt(const Jet<N, Order>& x) {
  const double root = std::sqrt(x.value);
  return x.Chain(root, 0.5 / root, -0.25 / (root * x.value));
}

template <int N, int Order>
Jet<N, Order> tanh(const Jet<N, Order>& x) {
  const double t = std::tanh(x.value);
  const double d = 1 - t * t;
  return x.Chain(t, d, -2 * t * d);
}

template <int N, int Order>
Jet<N, Order> pow(const Jet<N, Order>& x, double exponent) {
  const double first = exponent * std::pow(x.value, exponent - 1);
  const double second = exponent * (exponent - 1) * std::pow(x.value, exponent - 2);
  return x.Chain(std::pow(x.value, exponent), first, second);
}

/// x squared.
template <typename T>
T Square(const T& x) {
  return x * x;
}

}  // namespace possibility::collocation
