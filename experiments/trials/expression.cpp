#include "experiments/trials/expression.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <muParser.h>

#include <cctype>
#include <cmath>
#include <vector>

#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::experiments {
namespace {

using Names = std::map<std::string, double>;

constexpr char kLanguage[] =
    "0123456789_abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ.+-*/() \t";

double Finite(double value) {
  if (!std::isfinite(value)) throw mu::ParserError(mu::ecDOMAIN_ERROR);
  return value;
}

/// Replaces each run of signs and blanks by blanks and one sign. muParser knows one sign before a
/// value only. Places stay what they are.
std::string WithSingleSigns(std::string text) {
  std::size_t last = std::string::npos;  // the sign before, if only blanks lie between
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_sign = text[i] == '+' || text[i] == '-';
    if (is_sign && last != std::string::npos) {
      text[i] = text[i] == text[last] ? '+' : '-';
      text[last] = ' ';
    }
    if (is_sign) {
      last = i;
    } else if (text[i] != ' ' && text[i] != '\t') {
      last = std::string::npos;
    }
  }
  return text;
}

/// A parser of the documented language only: none of muParser's functions, constants, comparisons,
/// assignments or conditions.
mu::Parser ParserOf(const Names& names) {
  mu::Parser parser;
  parser.ClearFun();
  parser.ClearConst();
  parser.EnableBuiltInOprt(false);
  // Operators of our own, because muParser's let infinity pass.
  parser.DefineOprt(
      "+", [](double a, double b) { return Finite(a + b); }, mu::prADD_SUB);
  parser.DefineOprt(
      "-", [](double a, double b) { return Finite(a - b); }, mu::prADD_SUB);
  parser.DefineOprt(
      "*", [](double a, double b) { return Finite(a * b); }, mu::prMUL_DIV);
  parser.DefineOprt(
      "/", [](double a, double b) { return Finite(a / b); }, mu::prMUL_DIV);
  for (const auto& [name, value] : names) parser.DefineConst(name, value);
  return parser;
}

std::string UnknownName(const std::string& text, const std::string& name, const Names& names) {
  std::vector<std::string> known;
  for (const auto& [other, value] : names) known.push_back(other);
  return fmt::format("there is no '{}' in '{}', expected one of {}{}", name, text,
                     fmt::join(known, ", "), models::DidYouMean(name, known));
}

std::string MessageOf(const mu::ParserError& error, const std::string& text, const Names& names) {
  std::string token = error.GetToken();
  token.erase(token.find_last_not_of(" \t") + 1);
  const bool is_at_end = error.GetPos() >= static_cast<int>(text.size());
  switch (is_at_end && !token.empty() && token != ")" ? mu::ecUNEXPECTED_EOF : error.GetCode()) {
    case mu::ecDOMAIN_ERROR:
      return fmt::format("'{}' is not finite, expected a number", text);
    case mu::ecEMPTY_EXPRESSION:
    case mu::ecUNEXPECTED_EOF:
      return fmt::format("'{}': expected a number, a name or '(' at the end", text);
    case mu::ecMISSING_PARENS:
      return fmt::format("'{}': expected ')' at the end", text);
    case mu::ecUNASSIGNABLE_TOKEN:
      if (std::isalpha(static_cast<unsigned char>(token[0])) != 0 || token[0] == '_') {
        return UnknownName(text, token, names);
      }
      break;
    default:
      if (token.empty() || error.GetPos() < 0) {
        return fmt::format("'{}': {}", text, error.GetMsg());
      }
  }
  return fmt::format("'{}': unexpected '{}' at character {}", text, token, error.GetPos() + 1);
}

}  // namespace

double EvaluateExpression(const std::string& expression, const Names& names) {
  // What muParser would take beyond the language: commas, conditions, strings.
  const std::size_t foreign = expression.find_first_not_of(kLanguage);
  if (foreign != std::string::npos) {
    throw InputError(fmt::format("'{}': expected a digit, a letter, + - * / ( or ) at character {}",
                                 expression, foreign + 1));
  }
  try {
    mu::Parser parser = ParserOf(names);
    parser.SetExpr(WithSingleSigns(expression));
    return parser.Eval();
  } catch (const mu::ParserError& error) {
    throw InputError(MessageOf(error, expression, names));
  }
}

}  // namespace possibility::experiments
