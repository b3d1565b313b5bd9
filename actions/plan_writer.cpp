#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "actions/plan.h"
#include "models/input_error.h"

namespace possibility::actions {
namespace {

using Json = nlohmann::ordered_json;

void RequireFinite(double x) {
  if (!std::isfinite(x)) throw std::invalid_argument("a plan holds a number that is not finite");
}

constexpr int kDigits = 12;
/// As many as tell all numbers apart.
constexpr int kAllDigits = 17;

/// Significant digits; what is smaller than 1e-12 is zero.
double Rounded(double x, int digits = kDigits) {
  RequireFinite(x);
  if (std::abs(x) < 1e-12) return 0;
  char text[32];
  const auto [end, error] =
      std::to_chars(text, text + sizeof text, x, std::chars_format::scientific, digits - 1);
  double rounded = x;
  if (error == std::errc()) std::from_chars(text, end, rounded);
  return rounded;
}

double Exact(double x) {
  RequireFinite(x);
  return x;
}

Json Numbers(const double* data, Eigen::Index size) {
  Json array = Json::array();
  auto& values = array.get_ref<Json::array_t&>();
  values.reserve(size);
  for (Eigen::Index i = 0; i < size; ++i) values.emplace_back(Rounded(data[i]));
  return array;
}

/// Root positions far from the origin keep as many decimals as those 1 to 10 m from it: the
/// quintics between knots a few milliseconds apart would make accelerations of what is left out.
Json Configuration(const Eigen::VectorXd& q) {
  Json array = Numbers(q.data(), q.size());
  for (Eigen::Index i = 4; i < std::min<Eigen::Index>(7, q.size()); ++i) {
    const int more = q[i] == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(q[i]))));
    array[static_cast<std::size_t>(i)] =
        Rounded(q[i], std::clamp(kDigits + more, kDigits, kAllDigits));
  }
  return array;
}

Json ToJson(const Phase& phase) {
  Json t = Json::array();
  Json q = Json::array();
  Json v = Json::array();
  Json a = Json::array();
  Json tau = Json::array();
  Json forces = Json::array();
  for (const Knot& knot : phase.knots) {
    t.push_back(Exact(knot.t));
    q.push_back(Configuration(knot.q));
    v.push_back(Numbers(knot.v.data(), knot.v.size()));
    a.push_back(Numbers(knot.a.data(), knot.a.size()));
    tau.push_back(Numbers(knot.tau.data(), knot.tau.size()));
    forces.push_back(Numbers(knot.forces.data(), knot.forces.size()));
  }
  Json json;
  json["contacts"] = phase.contacts;
  if (phase.impulses.cols() > 0) {
    json["impulses"] = Numbers(phase.impulses.data(), phase.impulses.size());
  }
  json["t"] = std::move(t);
  json["q"] = std::move(q);
  json["v"] = std::move(v);
  json["a"] = std::move(a);
  json["tau"] = std::move(tau);
  json["forces"] = std::move(forces);
  return json;
}

Json ToJson(const Segment& segment) {
  double start = 0;
  double duration = 0;
  if (!segment.phases.empty() && !segment.phases.front().knots.empty() &&
      !segment.phases.back().knots.empty()) {
    start = segment.phases.front().knots.front().t;
    duration = segment.phases.back().knots.back().t - start;
  }
  Json json;
  json["action"] = segment.action;
  json["start_s"] = Exact(start);
  json["duration_s"] = Exact(duration);
  json["phases"] = Json::array();
  for (const Phase& phase : segment.phases) json["phases"].push_back(ToJson(phase));
  return json;
}

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

Json ToJson(const Plan& plan, const std::filesystem::path& folder) {
  Json json;
  json["format"] = "possibility-plan/1";
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
  json["segments"] = Json::array();
  for (const Segment& segment : plan.segments) json["segments"].push_back(ToJson(segment));
  json["explored"] = ToJson(plan.explored);
  if (plan.no) json["no"] = ToJson(*plan.no);
  return json;
}

std::string Serialise(const Plan& plan, const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  try {
    return ToJson(plan, folder).dump() + "\n";
  } catch (const Json::exception&) {
    throw InputError(fmt::format(
        "{}: a name or path in the plan is not valid UTF-8, which JSON requires", file.string()));
  }
}

[[noreturn]] void FailToWrite(const std::filesystem::path& file, const std::string& reason) {
  throw InputError(fmt::format("{}: cannot be written ({}), expected a path in a writable folder",
                               file.string(), reason));
}

}  // namespace

void WritePlan(const Plan& plan, const std::filesystem::path& file) {
  const std::string text = Serialise(plan, file);
  std::filesystem::path partial = file;
  partial += fmt::format(".{}.partial", ::getpid());
  std::error_code error;
  {
    std::ofstream stream(partial, std::ios::binary);
    if (!stream) FailToWrite(file, "its folder is missing or read-only");
    stream << text;
    stream.flush();
    if (!stream) {
      stream.close();
      std::filesystem::remove(partial, error);
      FailToWrite(file, "the disk is full");
    }
  }
  std::filesystem::rename(partial, file, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(partial, error);
    FailToWrite(file, reason);
  }
}

}  // namespace possibility::actions
