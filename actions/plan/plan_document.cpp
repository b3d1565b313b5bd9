#include "actions/plan/plan_document.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <set>

#include "actions/plan/contact_name.h"
#include "actions/plan/contact_schedule_json.h"
#include "actions/plan/segment_action.h"
#include "models/input/action_name.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

using models::JsonCursor;

constexpr double kTimeTolerance = 1e-6;  // s, of durations that repeat the knots' times

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

void ExpectTime(const JsonCursor& cursor, double expected) {
  const double time = cursor.Number();
  if (!(std::abs(time - expected) <= kTimeTolerance)) {
    cursor.Fail(fmt::format("{:.9g} s, expected {:.9g} s, as the knots say", time, expected));
  }
}

Segment ReadSegment(const JsonCursor& cursor, const PhaseReader& read_phase,
                    std::size_t num_joints) {
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
    segment.phases.push_back(read_phase(phases[i], num_joints));
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

}  // namespace

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

Eigen::Matrix3Xd ReadImpulses(const JsonCursor& cursor, Eigen::Index num_points) {
  if (num_points == 0) cursor.Fail("expected none where nothing touches the ground");
  Eigen::Matrix3Xd impulses(3, num_points);
  ReadNumbers(cursor, &impulses);
  return impulses;
}

Plan ReadPlanDocument(const JsonCursor& root, const std::filesystem::path& folder,
                      const PhaseReader& read_phase) {
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
  const JsonCursor segments = root["segments"];
  for (std::size_t i = 0, n = segments.ArraySize(); i < n; ++i) {
    plan.segments.push_back(ReadSegment(segments[i], read_phase, plan.joints.size()));
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

}  // namespace possibility::actions
