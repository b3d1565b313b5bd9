#include "experiments/trials/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <vector>

#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::experiments {
namespace {

/// Recursive descent, a function per level of precedence.
class Parser {
 public:
  Parser(const std::string& text, const std::map<std::string, double>& names)
      : text_(text), names_(names) {}

  double Evaluate() {
    const double value = Sum();
    if (Peek() != '\0') Fail("expected an operator");
    return value;
  }

 private:
  static constexpr int kDeepest = 100;

  double Sum() {
    double value = Product();
    for (char c = Peek(); c == '+' || c == '-'; c = Peek()) {
      ++at_;
      const double next = Product();
      value = Finite(c == '+' ? value + next : value - next);
    }
    return value;
  }

  double Product() {
    double value = Factor();
    for (char c = Peek(); c == '*' || c == '/'; c = Peek()) {
      ++at_;
      const double next = Factor();
      value = Finite(c == '*' ? value * next : value / next);
    }
    return value;
  }

  double Factor() {
    if (++depth_ > kDeepest) Fail(fmt::format("expected at most {} nested levels", kDeepest));
    const double value = SignedOrPrimary();
    --depth_;
    return value;
  }

  double SignedOrPrimary() {
    const char c = Peek();
    if (c == '-' || c == '+') {
      ++at_;
      const double value = Factor();
      return c == '-' ? -value : value;
    }
    if (c == '(') {
      ++at_;
      const double value = Sum();
      if (Peek() != ')') Fail("expected ')'");
      ++at_;
      return value;
    }
    if (std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_') return Name();
    return Number();
  }

  double Name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
      ++at_;
    }
    const std::string name = text_.substr(begin, at_ - begin);
    const auto found = names_.find(name);
    if (found != names_.end()) return found->second;
    std::vector<std::string> known;
    for (const auto& [other, value] : names_) known.push_back(other);
    throw InputError(fmt::format("there is no '{}' in '{}', expected one of {}{}", name, text_,
                                 fmt::join(known, ", "), models::DidYouMean(name, known)));
  }

  double Number() {
    double value = 0;
    const char* begin = text_.data() + at_;
    const char* end = text_.data() + text_.size();
    // from_chars knows "inf" and "nan", which Name has taken.
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error == std::errc::result_out_of_range) Fail("expected a smaller number");
    if (error != std::errc()) Fail("expected a number, a name or '('");
    at_ += static_cast<std::size_t>(stop - begin);
    return value;
  }

  char Peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  double Finite(double value) const {
    if (!std::isfinite(value)) {
      throw InputError(fmt::format("'{}' is not finite, expected a number", text_));
    }
    return value;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("'{}': {} at character {}", text_, what, at_ + 1));
  }

  const std::string& text_;
  const std::map<std::string, double>& names_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

double EvaluateExpression(const std::string& expression,
                          const std::map<std::string, double>& names) {
  return Parser(expression, names).Evaluate();
}

}  // namespace possibility::experiments
