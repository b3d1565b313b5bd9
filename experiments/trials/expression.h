#pragma once

#include <map>
#include <string>

namespace possibility::experiments {

/// The value of an arithmetic expression: numbers, names, + - * / and parentheses, with the usual
/// precedence.
/// @throws InputError describing the fault, without a place: a syntax error, an unknown name, a
/// division by zero or another result that is not finite.
double EvaluateExpression(const std::string& expression,
                          const std::map<std::string, double>& names);

}  // namespace possibility::experiments
