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
  friend bool operator<=(const Jet& a, const Jet& b) { return a.value <= b.value; }
  friend bool operator>=(const Jet& a, const Jet& b) { return a.value >= b.value; }

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
using std::abs;
using std::acos;
using std::asin;
using std::atan;
using std::atan2;
using std::cos;
using std::cosh;
using std::exp;
using std::log;
using std::pow;
using std::sin;
using std::sinh;
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
Jet<N, Order> asin(const Jet<N, Order>& x) {
  const double d = 1 / std::sqrt(1 - x.value * x.value);
  return x.Chain(std::asin(x.value), d, x.value * d * d * d);
}

template <int N, int Order>
Jet<N, Order> acos(const Jet<N, Order>& x) {
  const double d = 1 / std::sqrt(1 - x.value * x.value);
  return x.Chain(std::acos(x.value), -d, -x.value * d * d * d);
}

/// The angle of (x, y). Not differentiable at the origin: its derivatives are NaN there.
template <int N, int Order>
Jet<N, Order> atan2(const Jet<N, Order>& y, const Jet<N, Order>& x) {
  // All branches differ from one another by a constant.
  const bool steep = std::abs(y.value) > std::abs(x.value);
  Jet<N, Order> angle = steep ? -atan(x / y) : atan(y / x);
  angle.value = std::atan2(y.value, x.value);
  return angle;
}

/// Its derivatives jump at 0, where they are those of x.
template <int N, int Order>
Jet<N, Order> abs(const Jet<N, Order>& x) {
  return x.value < 0 ? -x : x;
}

template <int N, int Order>
Jet<N, Order> sinh(const Jet<N, Order>& x) {
  const double s = std::sinh(x.value);
  return x.Chain(s, std::cosh(x.value), s);
}

template <int N, int Order>
Jet<N, Order> cosh(const Jet<N, Order>& x) {
  const double c = std::cosh(x.value);
  return x.Chain(c, std::sinh(x.value), c);
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
  // A factor of 0 counts as such, even beside a power that is infinite.
  const auto power = [&x](double factor, double of) {
    return factor == 0 ? 0 : factor * std::pow(x.value, of);
  };
  return x.Chain(std::pow(x.value, exponent), power(exponent, exponent - 1),
                 power(exponent * (exponent - 1), exponent - 2));
}

/// For x above 0.
template <int N, int Order>
Jet<N, Order> pow(const Jet<N, Order>& x, const Jet<N, Order>& exponent) {
  return exp(exponent * log(x));
}

/// The greater of two numbers, rounded off where they are closer than about `width` > 0, and above
/// both: (a + b + sqrt((a - b)^2 + width^2)) / 2.
template <typename T>
T SmoothMax(const T& a, const T& b, double width) {
  const T difference = a - b;
  return 0.5 * (a + b + sqrt(difference * difference + width * width));
}

/// The smaller of two numbers likewise, and below both.
template <typename T>
T SmoothMin(const T& a, const T& b, double width) {
  const T difference = a - b;
  return 0.5 * (a + b - sqrt(difference * difference + width * width));
}

/// x squared.
template <typename T>
T Square(const T& x) {
  return x * x;
}

}  // namespace possibility::collocation
