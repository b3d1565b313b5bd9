#include "collocation/transcription/program_functions.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

namespace possibility::collocation {

ProgramFunctions::ProgramFunctions(const VariableLayout& layout)
    : layout_(layout), ones_(Eigen::VectorXd::Ones(layout.num_variables())) {}

void ProgramFunctions::AddFormRow(PolynomialForm form, double scale, Bounds bounds,
                                  PlacedName name) {
  const int row = static_cast<int>(row_lowers_.size());
  FormRow form_row{std::move(form), 1 / scale, {}, {}};
  form_row.form.Gradient(ones_, [&](int variable, double) {
    form_row.jacobian_slots.push_back(jacobian_.At(row, variable));
  });
  form_row.form.Hessian(ones_, [&](int i, int j, double) {
    form_row.hessian_slots.push_back(hessian_.AtLower(i, j));
  });
  form_rows_.push_back(std::move(form_row));
  PushRow(scale, bounds, std::move(name));
}

void ProgramFunctions::PushRow(double scale, Bounds bounds, PlacedName name) {
  row_scales_.push_back(scale);
  row_lowers_.push_back(bounds.lower / scale);
  row_uppers_.push_back(bounds.upper / scale);
  row_names_.push_back(std::move(name));
}

void ProgramFunctions::AddIntegralRow(std::vector<CostTerm> terms, double scale, Bounds bounds,
                                      PlacedName name) {
  IntegralRow integral{num_rows(), 1 / scale, std::move(terms), {}, {}, name};
  std::set<int> variables;
  for (CostTerm& term : integral.terms) {
    term.FindSlots(&hessian_);
    term.ForVariables([&](int variable) { variables.insert(variable); });
  }
  integral.variables.assign(variables.begin(), variables.end());
  for (const int variable : integral.variables) {
    integral.jacobian_slots.push_back(jacobian_.At(integral.row, variable));
  }
  integral_rows_.push_back(std::move(integral));
  PushRow(scale, bounds, std::move(name));
}

void ProgramFunctions::AddBlock(ConstraintBlock block, const std::vector<Bounds>& bounds,
                                const Eigen::VectorXd& scales, PlacedName name) {
  block.FindSlots(static_cast<int>(row_lowers_.size()), &jacobian_, &hessian_);
  for (std::size_t o = 0; o < bounds.size(); ++o) {
    const double scale = scales.size() == 0 ? 1 : scales[static_cast<Eigen::Index>(o)];
    name.output = bounds.size() == 1 ? -1 : static_cast<int>(o);
    PushRow(scale, bounds[o], name);
  }
  blocks_.push_back(std::move(block));
  name.output = -1;
  block_names_.push_back(std::move(name));
}

void ProgramFunctions::AddCost(CostTerm cost, PlacedName name) {
  cost.FindSlots(&hessian_);
  costs_.push_back(std::move(cost));
  cost_names_.push_back(std::move(name));
}

template <typename Run>
void ProgramFunctions::Named(const char* kind, const PlacedName& name, const Run& run) const {
  try {
    run();
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("{} '{}': {}", kind, layout_.FullName(name), error.what()));
  }
}

void ProgramFunctions::Share(int threads) {
  if (threads <= 1) return;
  groups_ = GroupByFunction(&blocks_);
  team_ = std::make_unique<ThreadTeam>(threads);
}

template <typename Run>
void ProgramFunctions::ForEachBlock(const Run& run) {
  const auto run_named = [&](std::size_t i) {
    Named("constraint", block_names_[i], [&] { run(&blocks_[i]); });
  };
  if (team_) {
    team_->ForEach(groups_.size(), [&](std::size_t group) {
      for (const int block : groups_[group].blocks) run_named(static_cast<std::size_t>(block));
    });
  } else {
    for (std::size_t i = 0; i < blocks_.size(); ++i) run_named(i);
  }
}

void ProgramFunctions::AddBlocksHessian(const Eigen::VectorXd& x,
                                        const Eigen::VectorXd& multipliers,
                                        Eigen::VectorXd* values) {
  if (!team_) {
    ForEachBlock([&](ConstraintBlock* block) { block->AddHessian(x, multipliers, values); });
    return;
  }
  team_->ForEach(groups_.size(), [&](std::size_t i) {
    BlockGroup& group = groups_[i];
    group.hessian.setZero();
    for (const int block : group.blocks) {
      Named("constraint", block_names_[block],
            [&] { blocks_[block].AddHessian(x, multipliers, &group.hessian); });
    }
  });
  for (const BlockGroup& group : groups_) group.AddHessianTo(values);
}

template <typename Run>
void ProgramFunctions::ForEachCost(const Run& run) {
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    Named("cost", cost_names_[i], [&] { run(&costs_[i]); });
  }
}

template <typename Run>
void ProgramFunctions::ForEachIntegralTerm(const Run& run) {
  for (IntegralRow& integral : integral_rows_) {
    for (CostTerm& term : integral.terms) {
      Named("constraint", integral.name, [&] { run(integral, &term); });
    }
  }
}

double ProgramFunctions::Objective(const Eigen::VectorXd& x) {
  double sum = 0;
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    double cost = 0;
    Named("cost", cost_names_[i], [&] { cost = costs_[i].Evaluate(x); });
    if (!std::isfinite(cost)) {
      throw std::runtime_error(
          fmt::format("cost '{}' is {}", layout_.FullName(cost_names_[i]), cost));
    }
    sum += cost;
  }
  return sum;
}

void ProgramFunctions::Gradient(const Eigen::VectorXd& x, Eigen::VectorXd* gradient) {
  gradient->setZero(layout_.num_variables());
  ForEachCost([&](CostTerm* cost) { cost->AddGradient(x, gradient); });
  gradient->array() *= layout_.scale_vector().array();
  if (!gradient->allFinite()) FailForGradient(x);
}

void ProgramFunctions::FailForGradient(const Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < costs_.size(); ++i) {
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(layout_.num_variables());
    costs_[i].AddGradient(x, &gradient);
    for (int k = 0; k < layout_.num_variables(); ++k) {
      if (std::isfinite(gradient[k])) continue;
      throw std::runtime_error(fmt::format("the derivative of cost '{}' with respect to '{}' is {}",
                                           layout_.FullName(cost_names_[i]),
                                           layout_.FullName(layout_.names()[k]), gradient[k]));
    }
  }
  throw std::runtime_error("the derivative of the sum of all costs is not finite");
}

void ProgramFunctions::FailForHessian(const Eigen::VectorXd& x, double objective_factor,
                                      const Eigen::VectorXd& multipliers) {
  Eigen::VectorXd values(hessian_.pattern().size());
  const auto check = [&] {
    for (int i = 0; i < values.size(); ++i) {
      if (std::isfinite(values[i])) continue;
      const auto name = [&](int k) { return layout_.FullName(layout_.names()[k]); };
      throw std::runtime_error(fmt::format(
          "the second derivative with respect to '{}' and '{}' is {}",
          name(hessian_.pattern().rows[i]), name(hessian_.pattern().columns[i]), values[i]));
    }
  };
  const auto check_block = [&](std::size_t i, BlockGroup* group) {
    Named("constraint", block_names_[i], [&] {
      values.setZero();
      if (group) group->hessian.setZero();
      blocks_[i].AddHessian(x, multipliers, group ? &group->hessian : &values);
      if (group) group->AddHessianTo(&values);
      check();
    });
  };
  for (std::size_t i = 0; !team_ && i < blocks_.size(); ++i) check_block(i, nullptr);
  for (BlockGroup& group : groups_) {
    for (const int i : group.blocks) check_block(static_cast<std::size_t>(i), &group);
  }
  ForEachIntegralTerm([&](const IntegralRow& integral, CostTerm* term) {
    values.setZero();
    term->AddHessian(x, integral.factor * multipliers[integral.row], &values);
    check();
  });
  ForEachCost([&](CostTerm* cost) {
    values.setZero();
    cost->AddHessian(x, objective_factor, &values);
    check();
  });
}

void ProgramFunctions::Constraints(const Eigen::VectorXd& x, Eigen::VectorXd* g) {
  g->resize(num_rows());
  for (std::size_t row = 0; row < form_rows_.size(); ++row) {
    (*g)[static_cast<Eigen::Index>(row)] = form_rows_[row].form.Value(x) * form_rows_[row].factor;
  }
  ForEachBlock([&](ConstraintBlock* block) { block->AddRows(x, g); });
  for (const IntegralRow& integral : integral_rows_) (*g)[integral.row] = 0;
  ForEachIntegralTerm([&](const IntegralRow& integral, CostTerm* term) {
    (*g)[integral.row] += integral.factor * term->Evaluate(x);
  });
}

void ProgramFunctions::AddIntegralRowsJacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(layout_.num_variables());
  for (IntegralRow& integral : integral_rows_) {
    for (CostTerm& term : integral.terms) {
      Named("constraint", integral.name, [&] { term.AddGradient(x, &gradient); });
    }
    for (std::size_t i = 0; i < integral.variables.size(); ++i) {
      (*values)[integral.jacobian_slots[i]] += integral.factor * gradient[integral.variables[i]];
      gradient[integral.variables[i]] = 0;
    }
  }
}

void ProgramFunctions::Jacobian(const Eigen::VectorXd& x, Eigen::VectorXd* values) {
  values->setZero(jacobian_.pattern().size());
  for (const FormRow& row : form_rows_) {
    const int* slot = row.jacobian_slots.data();
    row.form.Gradient(
        x, [&](int, double derivative) { (*values)[*slot++] += row.factor * derivative; });
  }
  ForEachBlock([&](ConstraintBlock* block) { block->AddJacobian(x, values); });
  AddIntegralRowsJacobian(x, values);
  const std::vector<int>& columns = jacobian_.pattern().columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    (*values)[static_cast<Eigen::Index>(i)] *= layout_.scale_vector()[columns[i]];
  }
}

void ProgramFunctions::Hessian(const Eigen::VectorXd& x, double objective_factor,
                               const Eigen::VectorXd& multipliers, Eigen::VectorXd* values) {
  values->setZero(hessian_.pattern().size());
  for (std::size_t r = 0; r < form_rows_.size(); ++r) {
    const FormRow& row = form_rows_[r];
    const double factor = multipliers[static_cast<Eigen::Index>(r)] * row.factor;
    const int* slot = row.hessian_slots.data();
    row.form.Hessian(x, [&](int, int, double second) { (*values)[*slot++] += factor * second; });
  }
  AddBlocksHessian(x, multipliers, values);
  ForEachIntegralTerm([&](const IntegralRow& integral, CostTerm* term) {
    term->AddHessian(x, integral.factor * multipliers[integral.row], values);
  });
  ForEachCost([&](CostTerm* cost) { cost->AddHessian(x, objective_factor, values); });
  if (!values->allFinite() && multipliers.allFinite())
    FailForHessian(x, objective_factor, multipliers);
  const SparsityPattern& pattern = hessian_.pattern();
  for (int i = 0; i < pattern.size(); ++i) {
    (*values)[i] *=
        layout_.scale_vector()[pattern.rows[i]] * layout_.scale_vector()[pattern.columns[i]];
  }
}

}  // namespace possibility::collocation
