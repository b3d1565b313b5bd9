#include "collocation/study/stored_solution_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "models/input/file_contents.h"
#include "models/input/json_cursor.h"
#include "models/input/json_text.h"

namespace possibility::collocation {
namespace {

using models::JsonCursor;

constexpr const char* kFormat = "possibility-solution/1";

void ExpectSize(const JsonCursor& place, std::size_t expected, const char* what) {
  const std::size_t size = place.ArraySize();
  if (size != expected) place.Fail(fmt::format("{} {}, expected {}", size, what, expected));
}

std::vector<std::string> Strings(const JsonCursor& place) {
  std::vector<std::string> strings;
  for (std::size_t i = 0; i < place.ArraySize(); ++i) strings.push_back(place[i].String());
  return strings;
}

std::vector<double> Numbers(const JsonCursor& place) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < place.ArraySize(); ++i) numbers.push_back(place[i].Number());
  return numbers;
}

Eigen::VectorXd Vector(const JsonCursor& place, std::size_t size) {
  ExpectSize(place, size, "numbers");
  const std::vector<double> numbers = Numbers(place);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), std::ssize(numbers));
}

/// One row per quantity, with one number per point.
Eigen::MatrixXd Matrix(const JsonCursor& place, std::size_t rows, std::size_t columns) {
  ExpectSize(place, rows, "rows");
  Eigen::MatrixXd matrix(rows, columns);
  for (std::size_t r = 0; r < rows; ++r) {
    matrix.row(static_cast<Eigen::Index>(r)) = Vector(place[r], columns).transpose();
  }
  return matrix;
}

Mesh ReadMesh(const JsonCursor& place) {
  Mesh mesh = Numbers(place);
  bool ascends = mesh.size() >= 2 && mesh.front() == 0 && mesh.back() == 1;
  for (std::size_t i = 1; i < mesh.size(); ++i) ascends = ascends && mesh[i] > mesh[i - 1];
  if (!ascends) place.Fail("expected numbers that ascend from 0 to 1");
  return mesh;
}

TranscriptionScheme ReadScheme(const JsonCursor& place) {
  constexpr std::size_t kMostNodes = 20;  // polynomials of more nodes are unreliable
  place.ExpectKeys({"name", "nodes", "separated"}, {"value_at_start", "value_at_end"});
  const JsonCursor nodes = place["nodes"];
  if (nodes.ArraySize() > kMostNodes) {
    nodes.Fail(fmt::format("{} nodes, expected at most {}", nodes.ArraySize(), kMostNodes));
  }
  const std::string name = place["name"].String();
  const bool separated = place["separated"].Bool();
  const std::vector<double> numbers = Numbers(nodes);
  const auto has_value = [&](const char* key) { return !place.Has(key) || place[key].Bool(); };
  const bool at_start = has_value("value_at_start");
  const bool at_end = has_value("value_at_end");
  if (numbers.size() == 2 && !at_start && !at_end) nodes.Fail("expected a node with a value");
  try {
    return SchemeOfNodes(name, numbers, separated, at_start, at_end);
  } catch (const std::invalid_argument&) {
    nodes.Fail("expected numbers that ascend from 0 to 1");
  }
}

void ReadPhase(const JsonCursor& place, StoredSolution* solution) {
  place.ExpectKeys({"name", "coordinates", "controls", "begin", "duration", "scheme", "mesh",
                    "coordinate_values", "control_values"},
                   {"orders"});
  PhaseNames names;
  names.phase = place["name"].String();
  names.coordinates = Strings(place["coordinates"]);
  names.controls = Strings(place["controls"]);
  PhaseTrajectory motion;
  motion.begin = place["begin"].Number();
  motion.duration = place["duration"].Number();
  if (motion.duration <= 0) place["duration"].Fail("expected a number above 0");
  motion.scheme = ReadScheme(place["scheme"]);
  motion.mesh = ReadMesh(place["mesh"]);
  const std::size_t points = (motion.mesh.size() - 1) * (motion.scheme.nodes.size() - 1) + 1;
  const JsonCursor values = place["coordinate_values"];
  if (values.ArraySize() != 2 && values.ArraySize() != 3) {
    values.Fail("expected coordinates and one or two derivatives");
  }
  names.order = static_cast<int>(values.ArraySize()) - 1;
  if (place.Has("orders")) {
    const JsonCursor orders = place["orders"];
    ExpectSize(orders, names.coordinates.size(), "numbers");
    for (std::size_t i = 0; i < orders.ArraySize(); ++i) {
      names.orders.push_back(static_cast<int>(orders[i].Integer(1, names.order)));
    }
    const auto is_of_phase = [&](int order) { return order == names.order; };
    if (std::all_of(names.orders.begin(), names.orders.end(), is_of_phase)) names.orders.clear();
    motion.orders = names.orders;
  }
  for (std::size_t order = 0; order < values.ArraySize(); ++order) {
    motion.coordinates.push_back(Matrix(values[order], names.coordinates.size(), points));
  }
  motion.controls = Matrix(place["control_values"], names.controls.size(), points);
  solution->phases.push_back(std::move(names));
  solution->trajectory.phases.push_back(std::move(motion));
}

std::vector<MultiplierSeries> ReadSeries(const JsonCursor& place, const Trajectory& trajectory) {
  std::vector<MultiplierSeries> all;
  for (std::size_t i = 0; i < place.ArraySize(); ++i) {
    const JsonCursor entry = place[i];
    entry.ExpectKeys({"phase", "name", "output", "points", "values"});
    MultiplierSeries series;
    const int phases = static_cast<int>(trajectory.phases.size());
    series.phase = static_cast<int>(entry["phase"].Integer(-1, phases - 1));
    series.name = entry["name"].String();
    series.output = static_cast<int>(entry["output"].Integer(-1, 1000000));
    const int last = series.phase < 0 ? -1 : trajectory.phases[series.phase].num_points() - 1;
    const JsonCursor points = entry["points"];
    for (std::size_t k = 0; k < points.ArraySize(); ++k) {
      const int lowest = series.phase < 0 ? -1 : k == 0 ? 0 : series.points.back() + 1;
      series.points.push_back(static_cast<int>(points[k].Integer(lowest, last)));
    }
    ExpectSize(entry["values"], series.points.size(), "numbers");
    series.values = Numbers(entry["values"]);
    all.push_back(std::move(series));
  }
  return all;
}

}  // namespace

StoredSolution ReadSolution(const std::filesystem::path& file) {
  const nlohmann::json content =
      models::ParseJson(models::ReadFileContents(file), file, fmt::format("a {} file", kFormat));
  const JsonCursor root(content, file);
  root.ExpectFormat(kFormat);
  root.ExpectKeys({"format", "problem", "parameters", "parameter_values", "phases", "multipliers"});
  StoredSolution solution;
  solution.problem = root["problem"].String();
  solution.parameters = Strings(root["parameters"]);
  solution.trajectory.parameters = Vector(root["parameter_values"], solution.parameters.size());
  const JsonCursor phases = root["phases"];
  if (phases.ArraySize() == 0) phases.Fail("expected one phase or more");
  for (std::size_t p = 0; p < phases.ArraySize(); ++p) ReadPhase(phases[p], &solution);
  const JsonCursor multipliers = root["multipliers"];
  multipliers.ExpectKeys({"constraints", "lower", "upper"});
  solution.multipliers.constraints = ReadSeries(multipliers["constraints"], solution.trajectory);
  solution.multipliers.lower = ReadSeries(multipliers["lower"], solution.trajectory);
  solution.multipliers.upper = ReadSeries(multipliers["upper"], solution.trajectory);
  return solution;
}

}  // namespace possibility::collocation
