#include "actions/plan/plain_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <optional>

#include "actions/plan/plan_document.h"
#include "actions/plan/plan_series.h"
#include "models/input/json_cursor.h"
#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

using models::JsonCursor;

constexpr double kMostNumbers = 2e8;  // in a plan with a table of courses

Eigen::VectorXd ReadVector(const JsonCursor& cursor, std::size_t size) {
  Eigen::VectorXd numbers(size);
  ReadNumbers(cursor, &numbers);
  return numbers;
}

Eigen::Matrix3Xd ReadForces(const JsonCursor& cursor) {
  const std::size_t size = cursor.ArraySize();
  if (size % 3 != 0) cursor.Fail(fmt::format("expected 3 numbers per contact point, got {}", size));
  Eigen::Matrix3Xd forces(3, size / 3);
  ReadNumbers(cursor, &forces);
  return forces;
}

Knot ReadKnot(const JsonCursor& phase, std::size_t i, std::size_t num_joints) {
  const JsonCursor t = phase["t"];
  const JsonCursor q = phase["q"];
  const JsonCursor v = phase["v"];
  const JsonCursor a = phase["a"];
  const JsonCursor tau = phase["tau"];
  const JsonCursor forces = phase["forces"];
  Knot knot;
  knot.t = t[i].Number();
  knot.q = ReadVector(q[i], 7 + num_joints);
  knot.v = ReadVector(v[i], 6 + num_joints);
  knot.a = ReadVector(a[i], 6 + num_joints);
  knot.tau = ReadVector(tau[i], num_joints);
  knot.forces = ReadForces(forces[i]);
  return knot;
}

/// Reads phases that store the numbers of every knot.
std::vector<Knot> ReadRows(const JsonCursor& phase, std::size_t num_knots, std::size_t num_joints) {
  for (const char* key : {"q", "v", "a", "tau", "forces"}) {
    const JsonCursor array = phase[key];
    if (array.ArraySize() != num_knots) {
      array.Fail(fmt::format("expected {} knots as in t, got {}", num_knots, array.ArraySize()));
    }
  }
  std::vector<Knot> knots;
  for (std::size_t i = 0; i < num_knots; ++i) {
    knots.push_back(ReadKnot(phase, i, num_joints));
    if (knots[i].forces.cols() != knots[0].forces.cols()) {
      const JsonCursor forces = phase["forces"];
      forces[i].Fail(fmt::format("expected {} numbers as in the first knot, got {}",
                                 knots[0].forces.size(), knots[i].forces.size()));
    }
  }
  return knots;
}

/// Reads phases that store for each component the index of its course.
std::vector<Knot> ReadCourses(const JsonCursor& phase, const SeriesReader& series,
                              std::size_t num_knots, std::size_t num_joints) {
  const auto read = [&](const char* key, std::size_t size) {
    const JsonCursor indices = phase[key];
    if (indices.ArraySize() != size) {
      indices.Fail(fmt::format("expected {} indices, got {}", size, indices.ArraySize()));
    }
    return series.Read(indices, num_knots);
  };
  const JsonCursor forces_cursor = phase["forces"];
  const std::size_t num_forces = forces_cursor.ArraySize();
  if (num_forces % 3 != 0) {
    forces_cursor.Fail(fmt::format("expected 3 indices per contact point, got {}", num_forces));
  }
  const Eigen::MatrixXd q = read("q", 7 + num_joints);
  const Eigen::MatrixXd v = read("v", 6 + num_joints);
  const Eigen::MatrixXd a = read("a", 6 + num_joints);
  const Eigen::MatrixXd tau = read("tau", num_joints);
  const Eigen::MatrixXd forces = read("forces", num_forces);
  const JsonCursor t = phase["t"];
  std::vector<Knot> knots;
  for (std::size_t i = 0; i < num_knots; ++i) {
    knots.push_back({t[i].Number(), q.col(i), v.col(i), a.col(i), tau.col(i),
                     forces.col(i).reshaped(3, num_forces / 3)});
  }
  return knots;
}

/// `series`: null if knots are rows.
Phase ReadPhase(const JsonCursor& cursor, const SeriesReader* series, std::size_t num_joints) {
  const bool has_impact = cursor.value().is_object() && cursor.value().contains("impulses");
  if (has_impact) {
    cursor.ExpectKeys({"contacts", "impulses", "t", "q", "v", "a", "tau", "forces"});
  } else {
    cursor.ExpectKeys({"contacts", "t", "q", "v", "a", "tau", "forces"});
  }
  Phase phase;
  phase.contacts = ReadContacts(cursor["contacts"]);
  const std::size_t num_knots = cursor["t"].ArraySize();
  if (num_knots < 2) cursor["t"].Fail(fmt::format("expected at least 2 knots, got {}", num_knots));
  phase.knots = series != nullptr ? ReadCourses(cursor, *series, num_knots, num_joints)
                                  : ReadRows(cursor, num_knots, num_joints);
  for (std::size_t i = 0; i < num_knots; ++i) {
    const Knot& knot = phase.knots[i];
    if (!(std::abs(knot.q.head<4>().norm() - 1) <= 1e-6)) {
      const JsonCursor q = cursor["q"];
      (series != nullptr ? q : q[i])
          .Fail("expected a unit quaternion (w, x, y, z) in front of every knot");
    }
    if (i > 0 && knot.t <= phase.knots[i - 1].t) {
      const JsonCursor t = cursor["t"];
      t[i].Fail(fmt::format("{:.9g} s, expected more than {:.9g} s, the time of the knot before",
                            knot.t, phase.knots[i - 1].t));
    }
  }
  if (has_impact) phase.impulses = ReadImpulses(cursor["impulses"], phase.knots[0].forces.cols());
  return phase;
}

/// Guards against a few bytes of indices that stand for gigabytes of numbers.
void RequireFewNumbers(const JsonCursor& segments) {
  double count = 0;
  for (const nlohmann::json& segment : segments.value()) {
    if (!segment.is_object() || !segment.contains("phases")) continue;
    for (const nlohmann::json& phase : segment["phases"]) {
      if (!phase.is_object() || !phase.contains("t")) continue;
      for (const char* key : {"q", "v", "a", "tau", "forces"}) {
        if (phase.contains(key))
          count += static_cast<double>(phase["t"].size()) * phase[key].size();
      }
    }
  }
  if (count > kMostNumbers) {
    segments.Fail(fmt::format("expected at most {:g} numbers, got {:g}", kMostNumbers, count));
  }
}

}  // namespace

Plan ReadPlainPlan(const std::string& text, const std::filesystem::path& file) {
  const nlohmann::json document = models::ParseJson(
      text, file, fmt::format("a complete {} or {} file", kPlanFormat, kPackedPlanFormat));
  const JsonCursor root(document, file);
  root.ExpectFormat(kPlanFormat);
  root.ExpectKeys({"format", "robot", "scenario", "seed", "goal", "timings", "statistics", "joints",
                   "segments", "explored"},
                  {"series", "schedule", "search", "no"});
  std::optional<SeriesReader> series;
  if (root.Has("series")) {
    series.emplace(root["series"]);
    RequireFewNumbers(root["segments"]);
  }
  return ReadPlanDocument(root, std::filesystem::absolute(file).parent_path(),
                          [&](const JsonCursor& phase, std::size_t num_joints) {
                            return ReadPhase(phase, series ? &*series : nullptr, num_joints);
                          });
}

}  // namespace possibility::actions
