#include "actions/plan/plan_json.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "actions/plan/contact_schedule_json.h"
#include "actions/plan/plan_digits.h"

namespace possibility::actions {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

Json PlanHead(const Plan& plan, const char* format, const std::filesystem::path& folder) {
  Json json;
  json["format"] = format;
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

Json PlanTail(const Plan& plan) {
  Json json;
  if (plan.schedule) json["schedule"] = actions::ToJson(*plan.schedule);
  json["explored"] = ToJson(plan.explored);
  if (plan.search) json["search"] = ToJson(*plan.search);
  if (plan.no) json["no"] = ToJson(*plan.no);
  return json;
}

}  // namespace possibility::actions
