#include "collocation/solver/ipopt_options.h"

#include <fmt/format.h>

#include <IpRegOptions.hpp>
#include <algorithm>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace possibility::collocation {
namespace {

template <typename Number>
std::optional<Number> Parse(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// Options that SolverOptions covers, with their names there.
std::string_view OwnName(std::string_view option) {
  if (option == "linear_solver") return "linear_solver";
  if (option == "hessian_approximation") return "hessian";
  return {};
}

bool SetByType(const std::string& name, const std::string& value,
               const Ipopt::RegisteredOption& known, Ipopt::OptionsList* list) {
  switch (known.Type()) {
    case Ipopt::OT_Number:
      if (const auto number = Parse<double>(value)) return list->SetNumericValue(name, *number);
      return false;
    case Ipopt::OT_Integer:
      if (const auto number = Parse<int>(value)) return list->SetIntegerValue(name, *number);
      return false;
    default:
      return list->SetStringValue(name, value);
  }
}

void SetUserOption(const std::string& name, const std::string& value,
                   Ipopt::IpoptApplication* application) {
  if (const std::string_view own = OwnName(name); !own.empty()) {
    throw std::invalid_argument(
        fmt::format("Ipopt option '{}': set SolverOptions::{} instead", name, own));
  }
  const auto known = application->RegOptions()->GetOption(name);
  if (!Ipopt::IsValid(known)) {
    throw std::invalid_argument(fmt::format("Ipopt has no option '{}'", name));
  }
  bool good = false;
  try {
    good = SetByType(name, value, *known, Ipopt::GetRawPtr(application->Options()));
  } catch (const Ipopt::IpoptException&) {  // a string that is not among the choices
  }
  if (!good) {
    throw std::invalid_argument(
        fmt::format("Ipopt option '{}' does not take the value '{}'", name, value));
  }
}

}  // namespace

void SetIpoptOptions(const SolverOptions& options, bool warm, double largest_bound,
                     Ipopt::IpoptApplication* application) {
  Ipopt::OptionsList& list = *application->Options();
  list.SetStringValue("sb", "yes");
  list.SetIntegerValue("print_level", 0);
  list.SetNumericValue("tol", options.tolerance);
  list.SetNumericValue("constr_viol_tol", options.constraint_tolerance);
  list.SetNumericValue("acceptable_tol", std::max(1e-6, 100 * options.tolerance));
  list.SetNumericValue("acceptable_constr_viol_tol", options.constraint_tolerance);
  // Ipopt relaxes each bound by this factor of it. That must stay within the constraint tolerance.
  list.SetNumericValue("bound_relax_factor", std::min(1e-8, 0.1 * options.constraint_tolerance /
                                                                std::max(1.0, largest_bound)));
  list.SetIntegerValue("max_iter", options.max_iterations);
  list.SetNumericValue("obj_scaling_factor", 1 / options.objective_size);
  // Variables are of order one, so iterates this large diverge. If the objective falls linearly,
  // 1000 iterations do not reach Ipopt's own 1e20.
  list.SetNumericValue("diverging_iterates_tol", 1e12);
  list.SetStringValue("mu_strategy", "adaptive");
  // With the adaptive strategy the restoration wanders where many points violate constraints least.
  list.SetStringValue("resto.mu_strategy", "monotone");
  if (options.linear_solver == LinearSolver::kSparseLdlt) {
    list.SetStringValue("linear_solver", "ma27");  // hsl_hook.h
    list.SetStringValue("linear_system_scaling", "none");
    list.SetNumericValue("ma27_pivtol", 1e-6);  // as for MUMPS
    // KktFactorisation refines its solutions itself. Ipopt still does where residuals are large.
    list.SetIntegerValue("min_refinement_steps", 0);
  } else {
    list.SetStringValue("linear_solver", "mumps");
  }
  if (options.hessian == HessianMode::kLimitedMemory) {
    list.SetStringValue("hessian_approximation", "limited-memory");
  }
  if (warm) {
    list.SetStringValue("warm_start_init_point", "yes");
    for (const char* push :
         {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
          "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      list.SetNumericValue(push, 1e-6);
    }
  }
  for (const auto& [name, value] : options.ipopt) SetUserOption(name, value, application);
}

}  // namespace possibility::collocation
