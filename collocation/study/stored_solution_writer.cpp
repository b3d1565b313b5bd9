#include "collocation/study/stored_solution_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "models/input/atomic_file.h"
#include "models/input/json_text.h"

namespace possibility::collocation {
namespace {

using Json = nlohmann::ordered_json;

double Finite(double x) {
  if (!std::isfinite(x))
    throw std::invalid_argument("a solution holds a number that is not finite");
  return x;
}

template <typename Range>
Json Numbers(const Range& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(Finite(value));
  return array;
}

/// One row per quantity.
Json Rows(const Eigen::MatrixXd& values) {
  Json rows = Json::array();
  for (Eigen::Index r = 0; r < values.rows(); ++r) {
    rows.push_back(Numbers(Eigen::VectorXd(values.row(r))));
  }
  return rows;
}

Json ToJson(const PhaseNames& names, const PhaseTrajectory& motion) {
  Json json;
  json["name"] = names.phase;
  json["coordinates"] = names.coordinates;
  if (!names.orders.empty()) json["orders"] = names.orders;
  json["controls"] = names.controls;
  json["begin"] = Finite(motion.begin);
  json["duration"] = Finite(motion.duration);
  json["scheme"] = {{"name", motion.scheme.name},
                    {"nodes", Numbers(motion.scheme.nodes)},
                    {"separated", motion.scheme.separated}};
  if (!motion.scheme.IsClosed()) {
    json["scheme"]["value_at_start"] = motion.scheme.value_at_start;
    json["scheme"]["value_at_end"] = motion.scheme.value_at_end;
  }
  json["mesh"] = Numbers(motion.mesh);
  json["coordinate_values"] = Json::array();
  for (const auto& values : motion.coordinates) json["coordinate_values"].push_back(Rows(values));
  json["control_values"] = Rows(motion.controls);
  return json;
}

Json ToJson(const std::vector<MultiplierSeries>& all) {
  Json json = Json::array();
  for (const MultiplierSeries& series : all) {
    json.push_back({{"phase", series.phase},
                    {"name", series.name},
                    {"output", series.output},
                    {"points", series.points},
                    {"values", Numbers(series.values)}});
  }
  return json;
}

Json ToJson(const StoredSolution& solution) {
  Json json;
  json["format"] = "possibility-solution/1";
  json["problem"] = solution.problem;
  json["parameters"] = solution.parameters;
  json["parameter_values"] = Numbers(solution.trajectory.parameters);
  json["phases"] = Json::array();
  for (std::size_t p = 0; p < solution.phases.size(); ++p) {
    json["phases"].push_back(ToJson(solution.phases[p], solution.trajectory.phases.at(p)));
  }
  json["multipliers"] = {{"constraints", ToJson(solution.multipliers.constraints)},
                         {"lower", ToJson(solution.multipliers.lower)},
                         {"upper", ToJson(solution.multipliers.upper)}};
  return json;
}

}  // namespace

void WriteSolution(const std::filesystem::path& file, const StoredSolution& solution) {
  const std::string text = models::JsonText(ToJson(solution)) + "\n";
  models::WriteAtomically(file, text);
}

}  // namespace possibility::collocation
