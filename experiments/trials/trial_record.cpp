#include "experiments/trials/trial_record.h"

#include <algorithm>
#include <tuple>

#include "models/input/file_contents.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }
Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

template <typename Value>
std::optional<Value> Find(const Json& json, const char* key) {
  const Json& value = json.at(key);
  if (value.is_null()) return std::nullopt;
  return value.get<Value>();
}

void AppendBytes(const double* data, Eigen::Index size, std::string* bytes) {
  bytes->append(reinterpret_cast<const char*>(data), static_cast<std::size_t>(size) * sizeof *data);
}

std::string Bytes(const actions::Phase& phase) {
  std::string bytes;
  for (const std::string& contact : phase.contacts) bytes += contact + '\n';
  AppendBytes(phase.impulses.data(), phase.impulses.size(), &bytes);
  for (const actions::Knot& knot : phase.knots) {
    AppendBytes(&knot.t, 1, &bytes);
    for (const Eigen::VectorXd* part : {&knot.q, &knot.v, &knot.a, &knot.tau}) {
      AppendBytes(part->data(), part->size(), &bytes);
    }
    AppendBytes(knot.forces.data(), knot.forces.size(), &bytes);
  }
  return bytes;
}

}  // namespace

std::optional<double> TrialRecord::speed() const {
  if (plan_duration <= 0) return std::nullopt;
  return length / plan_duration;
}

Json TrialRecord::Json() const {
  experiments::Json json;
  json["experiment"] = identity.experiment;
  json["row"] = key.row;
  json["preset"] = key.preset;
  json["seed"] = key.seed;
  if (!parameter.empty()) {
    json["parameter"] = parameter;
    json["value"] = value;
  }
  json["success"] = success;
  json["verified"] = verified;
  json["no"] = OrNull(no);
  json["preparation_s"] = timings.preparation_s;
  json["graph_s"] = timings.graph_s;
  json["confirmation_s"] = timings.confirmation_s;
  json["motion_s"] = timings.motion_s;
  json["verification_s"] = timings.verification_s;
  json["memory_mb"] = memory_mb;
  json["real_time_ratio"] = OrNull(real_time_ratio);
  json["plan_duration_s"] = plan_duration;
  json["length_m"] = length;
  json["speed_m_s"] = OrNull(speed());
  json["counters"] = counters;
  json["explorers"] = explorers;
  json["plan_hash"] = OrNull(plan_hash);
  json["scenario_hash"] = identity.scenario_hash;
  json["robot_hash"] = identity.robot_hash;
  json["settings_hash"] = identity.settings_hash;
  json["machine"] = machine;
  return json;
}

TrialRecord TrialRecord::FromJson(const experiments::Json& json) {
  TrialRecord record;
  record.identity = {json.at("experiment"), json.at("scenario_hash"), json.at("robot_hash"),
                     json.at("settings_hash")};
  record.key = {json.at("row"), json.at("preset"), json.at("seed")};
  if (json.contains("parameter")) {
    record.parameter = json.at("parameter");
    record.value = json.at("value");
  }
  record.success = json.at("success");
  record.verified = json.at("verified");
  record.no = Find<std::string>(json, "no").value_or("");
  record.timings = {json.at("preparation_s"), json.at("graph_s"), json.at("confirmation_s"),
                    json.at("motion_s"), json.at("verification_s")};
  record.memory_mb = json.at("memory_mb");
  record.real_time_ratio = Find<double>(json, "real_time_ratio");
  record.plan_duration = json.at("plan_duration_s");
  record.length = json.at("length_m");
  record.counters = json.at("counters").get<std::map<std::string, std::int64_t>>();
  record.explorers = Find<std::string>(json, "explorers").value_or("");
  record.plan_hash = Find<std::string>(json, "plan_hash").value_or("");
  record.machine = json.at("machine");
  return record;
}

bool SameButTimings(const TrialRecord& a, const TrialRecord& b) {
  const auto facts = [](const TrialRecord& r) {
    return std::tie(r.key, r.identity.experiment, r.identity.scenario_hash, r.identity.robot_hash,
                    r.identity.settings_hash, r.parameter, r.value, r.success, r.verified, r.no,
                    r.counters, r.explorers, r.plan_duration, r.length, r.plan_hash);
  };
  return facts(a) == facts(b);
}

void SortRecords(const std::vector<std::string>& row_order, std::vector<TrialRecord>* records) {
  const auto rank = [&](const TrialRecord& record) {
    const auto row = std::find(row_order.begin(), row_order.end(), record.key.row);
    return std::make_tuple(row - row_order.begin(), record.value, record.key);
  };
  std::sort(records->begin(), records->end(),
            [&](const TrialRecord& a, const TrialRecord& b) { return rank(a) < rank(b); });
}

std::string MotionHash(const actions::Plan& plan) {
  std::vector<std::string> parts;
  for (const actions::Segment& segment : plan.segments) {
    parts.push_back(segment.action + '\n');
    for (const actions::Phase& phase : segment.phases) parts.push_back(Bytes(phase));
  }
  return models::HashOfParts({parts.begin(), parts.end()});
}

}  // namespace possibility::experiments
