#pragma once

#include <map>
#include <string>

namespace possibility::experiments {

/// The value of an arithmetic expression: numbers, names, + - * / and parentheses, with the usual
/// precedence; at most 20,000 characters. muParser reads it, and has nothing else left of its
/// language.
/// @throws InputError describing the fault, without file and line: a syntax error, an unknown name,
/// a division by zero or another intermediate result that is not finite.
double EvaluateExpression(const std::string& expression,
                          const std::map<std::string, double>& names);

}  // namespace possibility::experiments
