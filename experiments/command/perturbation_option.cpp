#include "experiments/command/perturbation_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <numbers>

#include "experiments/support/option_values.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using actions::Perturbation;

constexpr double kDegree = std::numbers::pi / 180;

/// A number that the command line may set.
struct Field {
  const char* name;
  double least;
  double most;
  void (*set)(double value, Perturbation* perturbation);
};

constexpr Field kFields[] = {
    {"mass", 0.1, 10, [](double value, Perturbation* p) { p->mass = value; }},
    {"slope_deg", -30, 30, [](double value, Perturbation* p) { p->slope = kDegree * value; }},
    {"side_slope_deg", -30, 30,
     [](double value, Perturbation* p) { p->side_slope = kDegree * value; }},
    {"torque", 0.01, 10, [](double value, Perturbation* p) { p->torque = value; }},
    {"armature", 0, 100, [](double value, Perturbation* p) { p->armature = value; }},
    {"friction", 0.01, 10, [](double value, Perturbation* p) { p->friction = value; }},
    {"push_ns", 0, 1000, [](double value, Perturbation* p) { p->push = value; }},
    {"push_direction_deg", -360, 360,
     [](double value, Perturbation* p) { p->push_direction = kDegree * value; }},
    {"push_share", 0, 1, [](double value, Perturbation* p) { p->push_share = value; }},
};

[[noreturn]] void Refuse(const std::string& word, const std::string& what) {
  throw InputError(fmt::format("--perturb: '{}': {}", word, what));
}

const Field& FieldNamed(const std::string& word, const std::string& name) {
  const auto field = std::find_if(std::begin(kFields), std::end(kFields),
                                  [&](const Field& candidate) { return candidate.name == name; });
  if (field != std::end(kFields)) return *field;
  std::string names;
  for (const Field& known : kFields) names += (names.empty() ? "" : ", ") + std::string(known.name);
  Refuse(word, "expected one of " + names);
}

double ValueOf(const std::string& word, const std::string& text, const Field& field) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= field.least && value <= field.most)) {
    Refuse(word, fmt::format("expected a number from {} to {}", field.least, field.most));
  }
  return value;
}

}  // namespace

NamedPerturbation ParsePerturbation(const std::string& text) {
  NamedPerturbation named;
  named.text = text;
  for (const std::string& word : ParseNames("--perturb", text)) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos) Refuse(word, "expected NAME=VALUE");
    const std::string name = word.substr(0, equals);
    const Field& field = FieldNamed(word, name);
    for (const auto& [known, unused] : named.values) {
      if (known == name) Refuse(word, "the name occurs twice");
    }
    const double value = ValueOf(word, word.substr(equals + 1), field);
    field.set(value, &named.perturbation);
    named.values.emplace_back(name, value);
  }
  return named;
}

std::vector<NamedPerturbation> UsualPerturbations() {
  std::vector<NamedPerturbation> cases = {{}};
  for (const char* text :
       {"mass=0.95", "mass=1.05", "slope_deg=1", "slope_deg=-1", "side_slope_deg=1",
        "side_slope_deg=-1", "torque=0.9", "friction=0.5", "push_ns=10",
        "push_ns=10,push_direction_deg=180", "push_ns=10,push_direction_deg=90",
        "push_ns=10,push_direction_deg=-90"}) {
    cases.push_back(ParsePerturbation(text));
  }
  return cases;
}

}  // namespace possibility::experiments
