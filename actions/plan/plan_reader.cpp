#include "actions/plan/plan_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>
#include <sstream>

#include "actions/plan/contact_name.h"
#include "actions/plan/contact_schedule_json.h"
#include "actions/plan/plan_series.h"
#include "actions/plan/segment_action.h"
#include "models/input/action_name.h"
#include "models/input/input_error.h"
#include "models/input/json_cursor.h"
#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

using models::JsonCursor;

constexpr double kMostNumbers = 2e8;     // in a plan with a table of courses
constexpr double kTimeTolerance = 1e-6;  // s, of durations that repeat the knots' times

std::string ReadText(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw InputError(
        fmt::format("{}: no such file, expected a plan.json ({})", file.string(), kPlanFormat));
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) {
    throw InputError(
        fmt::format("{}: cannot be read, expected a plan.json ({})", file.string(), kPlanFormat));
  }
  return text.str();
}

/// nlohmann checks that strings are UTF-8; an embedded zero would cut a path short.
std::filesystem::path ReadPath(const JsonCursor& cursor, const std::filesystem::path& folder) {
  const std::string text = cursor.String();
  if (text.find('\0') != std::string::npos) cursor.Fail("expected a path, got a zero byte");
  if (text.empty()) return {};
  std::error_code error;
  const std::filesystem::path joined = folder / text;
  const std::filesystem::path resolved = std::filesystem::weakly_canonical(joined, error);
  return error ? joined : resolved;
}

/// Rejects other text, which would end up in pages, tables and terminals.
std::string ReadAction(const JsonCursor& cursor) {
  std::string action = cursor.String();
  if (!ParseSegmentAction(action)) {
    cursor.Fail(
        fmt::format("expected {}, or two such names with \"->\" between", models::kActionNameRule));
  }
  return action;
}

std::vector<std::string> ReadStrings(const JsonCursor& cursor) {
  std::vector<std::string> strings;
  for (std::size_t i = 0, n = cursor.ArraySize(); i < n; ++i) {
    strings.push_back(cursor[i].String());
  }
  return strings;
}

/// Fills `numbers`; its size is the expected count.
template <typename Numbers>
void ReadNumbers(const JsonCursor& cursor, Numbers* numbers) {
  const std::size_t expected = numbers->size();
  if (cursor.ArraySize() != expected) {
    cursor.Fail(fmt::format("expected {} numbers, got {}", expected, cursor.ArraySize()));
  }
  for (std::size_t i = 0; i < expected; ++i) numbers->data()[i] = cursor[i].Number();
}

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

/// Checks the form of contact names only: patches and their points are known to the robot alone.
std::vector<std::string> ReadContacts(const JsonCursor& cursor) {
  std::vector<std::string> contacts = ReadStrings(cursor);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    std::string patch;
    try {
      patch = ParseContactName(contacts[i]).patch;
    } catch (const InputError& error) {
      cursor[i].Fail(error.what());
    }
    if (!seen.insert(patch).second) {
      cursor[i].Fail(fmt::format("patch {:?} stands twice in a phase, expected once", patch));
    }
  }
  return contacts;
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

Eigen::Matrix3Xd ReadImpulses(const JsonCursor& cursor, Eigen::Index num_points) {
  if (num_points == 0) cursor.Fail("expected none where nothing touches the ground");
  Eigen::Matrix3Xd impulses(3, num_points);
  ReadNumbers(cursor, &impulses);
  return impulses;
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

void ExpectTime(const JsonCursor& cursor, double expected) {
  const double time = cursor.Number();
  if (!(std::abs(time - expected) <= kTimeTolerance)) {
    cursor.Fail(fmt::format("{:.9g} s, expected {:.9g} s, as the knots say", time, expected));
  }
}

Segment ReadSegment(const JsonCursor& cursor, const SeriesReader* series, std::size_t num_joints) {
  cursor.ExpectKeys({"action", "start_s", "duration_s", "phases"}, {"vertices"});
  Segment segment;
  if (cursor.Has("vertices")) {
    const JsonCursor vertices = cursor["vertices"];
    if (vertices.ArraySize() != 2) vertices.Fail("expected [from, to]");
    for (std::size_t i = 0; i < 2; ++i) {
      segment.vertices[i] =
          static_cast<int>(vertices[i].Integer(0, std::numeric_limits<int>::max()));
    }
  }
  segment.action = ReadAction(cursor["action"]);
  const JsonCursor phases = cursor["phases"];
  if (phases.ArraySize() == 0) phases.Fail("expected at least one phase");
  for (std::size_t i = 0; i < phases.value().size(); ++i) {
    segment.phases.push_back(ReadPhase(phases[i], series, num_joints));
  }
  const double start = segment.phases.front().knots.front().t;
  ExpectTime(cursor["start_s"], start);
  ExpectTime(cursor["duration_s"], segment.phases.back().knots.back().t - start);
  return segment;
}

double ReadSeconds(const JsonCursor& cursor) {
  const double seconds = cursor.Number();
  if (seconds < 0) cursor.Fail(fmt::format("{:.9g} s, expected zero or more", seconds));
  return seconds;
}

PlanTimings ReadTimings(const JsonCursor& cursor) {
  cursor.ExpectKeys({"preparation_s", "graph_s", "confirmation_s", "motion_s", "verification_s",
                     "plan_duration_s", "real_time_ratio"});
  PlanTimings timings;
  timings.preparation_s = ReadSeconds(cursor["preparation_s"]);
  timings.graph_s = ReadSeconds(cursor["graph_s"]);
  timings.confirmation_s = ReadSeconds(cursor["confirmation_s"]);
  timings.motion_s = ReadSeconds(cursor["motion_s"]);
  timings.verification_s = ReadSeconds(cursor["verification_s"]);
  const JsonCursor ratio = cursor["real_time_ratio"];
  if (!ratio.value().is_null()) ratio.Number();
  return timings;
}

std::map<std::string, std::int64_t> ReadStatistics(const JsonCursor& cursor) {
  if (!cursor.value().is_object()) cursor.Fail("expected an object of integers");
  std::map<std::string, std::int64_t> statistics;
  for (const auto& [name, ignored] : cursor.value().items()) {
    if (name.find('\0') != std::string::npos) cursor.Fail("expected names, got a zero byte");
    statistics[name] = cursor[name.c_str()].Integer(std::numeric_limits<std::int64_t>::min(),
                                                    std::numeric_limits<std::int64_t>::max());
  }
  return statistics;
}

ExploredGraph ReadExplored(const JsonCursor& cursor) {
  cursor.ExpectKeys({"vertices", "edges"});
  ExploredGraph graph;
  const JsonCursor vertices = cursor["vertices"];
  for (std::size_t i = 0, n = vertices.ArraySize(); i < n; ++i) {
    Eigen::Vector4d numbers;
    ReadNumbers(vertices[i], &numbers);
    graph.vertices.push_back({numbers.head<3>(), numbers[3]});
  }
  const JsonCursor edges = cursor["edges"];
  const std::int64_t last = static_cast<std::int64_t>(graph.vertices.size()) - 1;
  for (std::size_t i = 0, n = edges.ArraySize(); i < n; ++i) {
    const JsonCursor edge = edges[i];
    if (edge.ArraySize() != 3) edge.Fail("expected [from, to, action]");
    graph.edges.push_back({static_cast<int>(edge[std::size_t{0}].Integer(0, last)),
                           static_cast<int>(edge[1].Integer(0, last)), ReadAction(edge[2])});
  }
  return graph;
}

ReachedRegion ReadRegion(const JsonCursor& cursor) {
  cursor.ExpectKeys({"action", "z", "outlines"});
  ReachedRegion region;
  const JsonCursor action = cursor["action"];
  if (!action.String().empty()) region.action = ReadAction(action);
  region.z = cursor["z"].Number();
  const JsonCursor outlines = cursor["outlines"];
  for (std::size_t i = 0, n = outlines.ArraySize(); i < n; ++i) {
    const JsonCursor outline = outlines[i];
    if (outline.ArraySize() < 3) outline.Fail("expected at least 3 corners");
    region.outlines.emplace_back(outline.ArraySize());
    for (std::size_t k = 0; k < outline.ArraySize(); ++k) {
      ReadNumbers(outline[k], &region.outlines.back()[k]);
    }
  }
  return region;
}

Barrier ReadBarrier(const JsonCursor& cursor) {
  cursor.ExpectKeys({"closest", "distance", "closed_by", "reached"});
  Barrier barrier;
  ReadNumbers(cursor["closest"], &barrier.closest);
  barrier.distance = cursor["distance"].Number();
  barrier.closed_by = ReadStrings(cursor["closed_by"]);
  const JsonCursor reached = cursor["reached"];
  for (std::size_t i = 0, n = reached.ArraySize(); i < n; ++i) {
    barrier.reached.push_back(ReadRegion(reached[i]));
  }
  return barrier;
}

SearchReport ReadSearch(const JsonCursor& cursor) {
  cursor.ExpectKeys({"explorers", "first_duration_s", "expected_duration_s", "lower_bound_s"});
  return {ReadStrings(cursor["explorers"]), ReadSeconds(cursor["first_duration_s"]),
          ReadSeconds(cursor["expected_duration_s"]), ReadSeconds(cursor["lower_bound_s"])};
}

/// Requires that segments refer to vertices of the plan's graph.
void CheckVertices(const JsonCursor& segments, const Plan& plan) {
  const int last = static_cast<int>(plan.explored.vertices.size()) - 1;
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    if (plan.segments[i].vertices[0] < 0) continue;
    for (std::size_t end = 0; end < 2; ++end) segments[i]["vertices"][end].Integer(0, last);
  }
}

PassageDimension ReadDimension(const JsonCursor& cursor) {
  const std::string name = cursor.String();
  for (const PassageDimension dimension :
       {PassageDimension::kWidth, PassageDimension::kHeight, PassageDimension::kGap}) {
    if (ToString(dimension) == name) return dimension;
  }
  cursor.Fail("expected \"width\", \"height\" or \"gap\"");
}

NarrowPassage ReadPassage(const JsonCursor& cursor) {
  cursor.ExpectKeys({"place", "missing", "between", "needs"});
  NarrowPassage passage;
  ReadNumbers(cursor["place"], &passage.place);
  passage.missing = cursor["missing"].Number();
  passage.between = ReadStrings(cursor["between"]);
  const JsonCursor needs = cursor["needs"];
  for (std::size_t i = 0, n = needs.ArraySize(); i < n; ++i) {
    const JsonCursor need = needs[i];
    need.ExpectKeys({"action", "dimension", "available", "needed"});
    passage.needs.push_back({need["action"].String(), ReadDimension(need["dimension"]),
                             need["available"].Number(), need["needed"].Number()});
  }
  return passage;
}

NoPlan ReadNo(const JsonCursor& cursor) {
  NoPlan no;
  cursor.ExpectKeys({"status", "explanation"}, {"barrier", "passage"});
  if (cursor.Has("barrier")) no.barrier = ReadBarrier(cursor["barrier"]);
  if (cursor.Has("passage")) no.passage = ReadPassage(cursor["passage"]);
  no.status = cursor["status"].String();
  no.explanation = cursor["explanation"].String();
  return no;
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

Plan ReadPlan(const JsonCursor& root, const std::filesystem::path& folder) {
  root.ExpectFormat(kPlanFormat);
  root.ExpectKeys({"format", "robot", "scenario", "seed", "goal", "timings", "statistics", "joints",
                   "segments", "explored"},
                  {"series", "schedule", "search", "no"});
  Plan plan;
  const JsonCursor robot = root["robot"];
  robot.ExpectKeys({"file", "hash"});
  plan.robot_file = ReadPath(robot["file"], folder);
  plan.robot_hash = robot["hash"].String();
  const JsonCursor scenario = root["scenario"];
  scenario.ExpectKeys({"file", "hash"});
  plan.scenario_file = ReadPath(scenario["file"], folder);
  plan.scenario_hash = scenario["hash"].String();
  plan.seed = root["seed"].Unsigned();
  plan.goal = static_cast<int>(root["goal"].Integer(0, std::numeric_limits<int>::max()));
  plan.timings = ReadTimings(root["timings"]);
  plan.statistics = ReadStatistics(root["statistics"]);
  plan.joints = ReadStrings(root["joints"]);
  std::optional<SeriesReader> series;
  if (root.Has("series")) series.emplace(root["series"]);
  const JsonCursor segments = root["segments"];
  if (series) RequireFewNumbers(segments);
  for (std::size_t i = 0, n = segments.ArraySize(); i < n; ++i) {
    plan.segments.push_back(
        ReadSegment(segments[i], series ? &*series : nullptr, plan.joints.size()));
  }
  const JsonCursor timings = root["timings"];
  ExpectTime(timings["plan_duration_s"], plan.duration());
  if (root.Has("schedule")) plan.schedule = ReadContactSchedule(root["schedule"]);
  plan.explored = ReadExplored(root["explored"]);
  CheckVertices(segments, plan);
  if (root.Has("search")) plan.search = ReadSearch(root["search"]);
  if (root.Has("no")) plan.no = ReadNo(root["no"]);
  if (plan.no && !plan.segments.empty()) {
    root["no"].Fail("expected none where there are segments");
  }
  return plan;
}

}  // namespace

Plan ReadPlan(const std::filesystem::path& file_or_directory) {
  std::error_code error;
  const bool is_directory = std::filesystem::is_directory(file_or_directory, error);
  const std::filesystem::path file =
      is_directory ? file_or_directory / "plan.json" : file_or_directory;
  return ParsePlan(ReadText(file), file);
}

Plan ParsePlan(const std::string& text, const std::filesystem::path& file) {
  const nlohmann::json document =
      models::ParseJson(text, file, fmt::format("a complete {} file", kPlanFormat));
  return ReadPlan(JsonCursor(document, file), std::filesystem::absolute(file).parent_path());
}

}  // namespace possibility::actions
