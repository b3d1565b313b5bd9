#include "actions/plan/plan_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "actions/plan/contact_schedule_json.h"
#include "actions/plan/plan_digits.h"
#include "actions/plan/plan_series.h"
#include "models/input/atomic_file.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

using Json = nlohmann::ordered_json;

/// Plans with more knots than this (about twenty minutes) are written with a table of courses.
constexpr std::size_t kMostRows = 20000;

double Exact(double x) {
  if (!std::isfinite(x)) throw std::invalid_argument("a plan holds a number that is not finite");
  return x;
}

/// Exact to the last bit, so that a page made from the plan equals one made from its file.
Json Numbers(const double* data, Eigen::Index size) {
  Json array = Json::array();
  for (Eigen::Index i = 0; i < size; ++i) array.push_back(Exact(data[i]));
  return array;
}

/// "[1,2,3]"
template <typename Numbers>
void AppendList(const Numbers& numbers, int decimals, std::string* text) {
  *text += '[';
  for (const double number : numbers.reshaped()) {
    if (text->back() != '[') *text += ',';
    AppendRounded(number, decimals, text);
  }
  *text += ']';
}

/// A quantity of every knot of a phase, as a matrix with a row for each component.
struct Quantity {
  const char* key;
  int decimals;
  Eigen::MatrixXd values;
};

std::vector<Quantity> QuantitiesOf(const Phase& phase) {
  const auto stack = [&phase](const auto& of_knot) {
    const Eigen::Index size = phase.knots.empty() ? 0 : of_knot(phase.knots[0]).size();
    Eigen::MatrixXd values(size, phase.knots.size());
    for (std::size_t k = 0; k < phase.knots.size(); ++k) {
      const Eigen::VectorXd value = of_knot(phase.knots[k]);
      if (value.size() != size) {
        throw std::invalid_argument("the knots of a phase differ in their sizes");
      }
      values.col(k) = value;
    }
    return values;
  };
  return {
      {"q", PlanDigits::kPosition, stack([](const Knot& knot) { return knot.q; })},
      {"v", PlanDigits::kRate, stack([](const Knot& knot) { return knot.v; })},
      {"a", PlanDigits::kAcceleration, stack([](const Knot& knot) { return knot.a; })},
      {"tau", PlanDigits::kForce, stack([](const Knot& knot) { return knot.tau; })},
      {"forces", PlanDigits::kForce,
       stack([](const Knot& knot) { return Eigen::VectorXd(knot.forces.reshaped()); })},
  };
}

/// A number if the component is constant over all knots, else a list.
std::string CourseOf(const Eigen::VectorXd& component, int decimals) {
  std::string course;
  AppendList(component, decimals, &course);
  std::string constant;
  AppendRounded(component[0], decimals, &constant);
  std::string repeated = "[";
  for (Eigen::Index k = 0; k < component.size(); ++k) repeated += (k > 0 ? "," : "") + constant;
  return course == repeated + "]" ? constant : course;
}

/// Writes segments as text: their numbers would take five times as much memory as JSON values.
class MotionWriter {
 public:
  MotionWriter(bool has_series, models::AtomicFile* output)
      : has_series_(has_series), output_(output) {}

  void Write(const Segment& segment) {
    double start = 0;
    double duration = 0;
    if (!segment.phases.empty() && !segment.phases.front().knots.empty() &&
        !segment.phases.back().knots.empty()) {
      start = segment.phases.front().knots.front().t;
      duration = segment.phases.back().knots.back().t - start;
    }
    std::string text = "{\"action\":" + Json(segment.action).dump() + ",\"start_s\":";
    AppendExact(start, &text);
    text += ",\"duration_s\":";
    AppendExact(duration, &text);
    if (segment.vertices[0] >= 0) {
      text += fmt::format(",\"vertices\":[{},{}]", segment.vertices[0], segment.vertices[1]);
    }
    text += ",\"phases\":[";
    for (const Phase& phase : segment.phases) {
      if (&phase != &segment.phases.front()) text += ',';
      Append(phase, &text);
      output_->Write(text);
      text.clear();
    }
    output_->Write(text + "]}");
  }

  const SeriesWriter& series() const { return series_; }

 private:
  void Append(const Phase& phase, std::string* text) {
    *text += "{\"contacts\":" + Json(phase.contacts).dump();
    if (phase.impulses.cols() > 0) {
      *text += ",\"impulses\":";
      AppendList(phase.impulses, PlanDigits::kForce, text);
    }
    *text += ",\"t\":[";
    for (const Knot& knot : phase.knots) {
      if (text->back() != '[') *text += ',';
      AppendExact(knot.t, text);
    }
    *text += ']';
    for (const Quantity& quantity : QuantitiesOf(phase)) {
      *text += fmt::format(",\"{}\":[", quantity.key);
      has_series_ ? AppendCourses(quantity, text) : AppendRows(quantity, text);
      *text += ']';
    }
    *text += '}';
  }

  static void AppendRows(const Quantity& quantity, std::string* text) {
    for (Eigen::Index k = 0; k < quantity.values.cols(); ++k) {
      if (k > 0) *text += ',';
      AppendList(quantity.values.col(k), quantity.decimals, text);
    }
  }

  void AppendCourses(const Quantity& quantity, std::string* text) {
    for (Eigen::Index i = 0; i < quantity.values.rows(); ++i) {
      if (i > 0) *text += ',';
      const std::string course = CourseOf(quantity.values.row(i), quantity.decimals);
      *text += std::to_string(series_.IndexOf(course));
    }
  }

  bool has_series_;
  models::AtomicFile* output_;
  SeriesWriter series_;
};

Json ToJson(const PlanTimings& timings, double plan_duration) {
  Json json;
  json["preparation_s"] = Exact(timings.preparation_s);
  json["graph_s"] = Exact(timings.graph_s);
  json["confirmation_s"] = Exact(timings.confirmation_s);
  json["motion_s"] = Exact(timings.motion_s);
  json["verification_s"] = Exact(timings.verification_s);
  json["plan_duration_s"] = Exact(plan_duration);
  // Confirmation jobs run beside the exploration, inside graph_s.
  const double planning = timings.preparation_s + timings.graph_s + timings.motion_s;
  json["real_time_ratio"] = planning > 0 ? Json(Exact(plan_duration / planning)) : Json(nullptr);
  return json;
}

Json ToJson(const ExploredGraph& graph) {
  Json json;
  json["vertices"] = Json::array();
  for (const ExploredGraph::Vertex& vertex : graph.vertices) {
    const Eigen::Vector4d numbers(vertex.position.x(), vertex.position.y(), vertex.position.z(),
                                  vertex.yaw);
    json["vertices"].push_back(Numbers(numbers.data(), 4));
  }
  json["edges"] = Json::array();
  for (const ExploredGraph::Edge& edge : graph.edges) {
    json["edges"].push_back(Json::array({edge.from, edge.to, edge.action}));
  }
  return json;
}

Json ToJson(const SearchReport& search) {
  Json json;
  json["explorers"] = search.explorers;
  json["first_duration_s"] = Rounded(search.first_duration);
  json["expected_duration_s"] = Rounded(search.duration);
  json["lower_bound_s"] = Rounded(search.lower_bound);
  return json;
}

Json ToJson(const ReachedRegion& region) {
  Json json;
  json["action"] = region.action;
  json["z"] = Rounded(region.z);
  json["outlines"] = Json::array();
  for (const std::vector<Eigen::Vector2d>& outline : region.outlines) {
    Json corners = Json::array();
    for (const Eigen::Vector2d& corner : outline) corners.push_back(Numbers(corner.data(), 2));
    json["outlines"].push_back(std::move(corners));
  }
  return json;
}

Json ToJson(const NarrowPassage& passage) {
  Json json;
  json["place"] = Numbers(passage.place.data(), 2);
  json["missing"] = Rounded(passage.missing);
  json["between"] = passage.between;
  json["needs"] = Json::array();
  for (const PassageNeed& need : passage.needs) {
    json["needs"].push_back({{"action", need.action},
                             {"dimension", ToString(need.dimension)},
                             {"available", Rounded(need.available)},
                             {"needed", Rounded(need.needed)}});
  }
  return json;
}

Json ToJson(const NoPlan& no) {
  Json json;
  json["status"] = no.status;
  json["explanation"] = no.explanation;
  if (no.passage) json["passage"] = ToJson(*no.passage);
  if (!no.barrier) return json;
  Json& barrier = json["barrier"];
  barrier["closest"] = Numbers(no.barrier->closest.data(), 2);
  barrier["distance"] = Rounded(no.barrier->distance);
  barrier["closed_by"] = no.barrier->closed_by;
  barrier["reached"] = Json::array();
  for (const ReachedRegion& region : no.barrier->reached) {
    barrier["reached"].push_back(ToJson(region));
  }
  return json;
}

/// `file` as seen from `folder` if there is a relative path between them, else absolute.
std::string PathFrom(const std::filesystem::path& folder, const std::filesystem::path& file) {
  if (file.empty()) return {};
  return std::filesystem::proximate(std::filesystem::absolute(file), folder).generic_string();
}

/// The part of the file before the segments.
Json Head(const Plan& plan, const std::filesystem::path& folder) {
  Json json;
  json["format"] = kPlanFormat;
  json["robot"]["file"] = PathFrom(folder, plan.robot_file);
  json["robot"]["hash"] = plan.robot_hash;
  json["scenario"]["file"] = PathFrom(folder, plan.scenario_file);
  json["scenario"]["hash"] = plan.scenario_hash;
  json["seed"] = plan.seed;
  json["goal"] = plan.goal;
  json["timings"] = ToJson(plan.timings, plan.duration());
  json["statistics"] = Json::object();
  for (const auto& [name, count] : plan.statistics) json["statistics"][name] = count;
  json["joints"] = plan.joints;
  return json;
}

/// The part of the file after the segments.
Json Tail(const Plan& plan) {
  Json json;
  if (plan.schedule) json["schedule"] = actions::ToJson(*plan.schedule);
  json["explored"] = ToJson(plan.explored);
  if (plan.search) json["search"] = ToJson(*plan.search);
  if (plan.no) json["no"] = ToJson(*plan.no);
  return json;
}

std::size_t CountKnots(const Plan& plan) {
  std::size_t count = 0;
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) count += phase.knots.size();
  }
  return count;
}

}  // namespace

void WritePlan(const Plan& plan, const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  models::AtomicFile output(file);
  MotionWriter motion(CountKnots(plan) > kMostRows, &output);
  try {
    std::string head = Head(plan, folder).dump();
    head.back() = ',';
    output.Write(head + "\"segments\":[");
    for (const Segment& segment : plan.segments) {
      if (&segment != &plan.segments.front()) output.Write(",");
      motion.Write(segment);
    }
    output.Write("],");
    if (!motion.series().courses().empty()) {
      output.Write("\"series\":[" + motion.series().courses() + "],");
    }
    output.Write(Tail(plan).dump().substr(1) + "\n");
  } catch (const Json::exception&) {
    throw InputError(fmt::format(
        "{}: a name or path in the plan is not valid UTF-8, which JSON requires", file.string()));
  }
  output.Commit();
}

}  // namespace possibility::actions
