#include "experiments/regression/regression_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;
using Kind = RegressionDifference::Kind;

constexpr double kMoreIterations = 1.1;
constexpr double kMoreError = 1.1;
constexpr double kLeastError = 1e-8;  // below the solver's own tolerance
constexpr double kMoreSeconds = 1.3;
constexpr double kLeastSeconds = 0.005;

/// The compared values of a problem.
struct Entry {
  std::string name;
  std::string status;
  std::string optimum;   // empty: none reached
  double objective = 0;  // NaN: none
  double error = 0;      // NaN: none
  double iterations = 0;
  double seconds = 0;
  std::string stationary_point;  // empty: the file is older than the second-order check
};

[[noreturn]] void Reject(const std::string& where, const std::string& key,
                         const std::string& expected) {
  throw InputError(fmt::format("{}: '{}' is missing or wrong, expected {}", where, key, expected));
}

const json& Member(const json& object, const std::string& where, const std::string& key,
                   bool (json::*is)() const, const std::string& expected) {
  const auto found = object.is_object() ? object.find(key) : object.end();
  if (!object.is_object() || found == object.end() || !((*found).*is)()) {
    Reject(where, key, expected);
  }
  return *found;
}

std::string TextMember(const json& object, const std::string& where, const std::string& key) {
  return Member(object, where, key, &json::is_string, "a text").get<std::string>();
}

/// Null stands for NaN, which JSON lacks.
double NumberMember(const json& object, const std::string& where, const std::string& key) {
  if (object.is_object() && object.contains(key) && object[key].is_null()) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return Member(object, where, key, &json::is_number, "a number").get<double>();
}

double AmountMember(const json& object, const std::string& where, const std::string& key) {
  const double value = NumberMember(object, where, key);
  if (!(value >= 0)) Reject(where, key, "a number of at least 0");
  return value;
}

Entry ReadEntry(const json& object, const std::string& place) {
  Entry entry;
  entry.name = TextMember(object, place, "name");
  const std::string where = fmt::format("{}, '{}'", place, entry.name);
  entry.status = TextMember(object, where, "status");
  if (!object.contains("optimum") || !object["optimum"].is_null()) {
    entry.optimum = TextMember(object, where, "optimum");
  }
  entry.objective = NumberMember(object, where, "objective");
  entry.error = NumberMember(object, where, "relative_error");
  entry.iterations = AmountMember(object, where, "iterations");
  const json& seconds = Member(object, where, "seconds", &json::is_object, "an object");
  entry.seconds = AmountMember(seconds, where + ", seconds", "total");
  if (object.contains("stationary_point")) {
    entry.stationary_point = TextMember(object, where, "stationary_point");
  }
  return entry;
}

std::vector<Entry> ReadEntries(const json& run, const std::string& where) {
  constexpr const char* kFormat = "possibility-regress/1";
  if (TextMember(run, where, "format") != kFormat) {
    Reject(where, "format", fmt::format("'{}'", kFormat));
  }
  std::vector<Entry> entries;
  for (const json& object : Member(run, where, "problems", &json::is_array, "a list")) {
    Entry entry = ReadEntry(object, fmt::format("{}, problems[{}]", where, entries.size()));
    for (const Entry& other : entries) {
      if (other.name == entry.name) {
        throw InputError(
            fmt::format("{}: problem '{}' is there twice, expected each once", where, entry.name));
      }
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

const Entry* Find(const std::vector<Entry>& entries, const std::string& name) {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const Entry& entry) { return entry.name == name; });
  return found == entries.end() ? nullptr : &*found;
}

/// Rank of a status; 0: the best.
int StatusRank(const std::string& status) {
  if (status == "solved") return 0;
  return status == "acceptable" ? 1 : 2;
}

std::string Growth(double before, double after) {
  if (before <= 0) return "from 0";
  const double percent = 100 * (after / before - 1);
  return percent < 1000 ? fmt::format("+{:.0f} %", percent)
                        : fmt::format("{:.3g} times", after / before);
}

/// Compares one problem and collects the differences.
class EntryComparison {
 public:
  EntryComparison(const Entry& before, const Entry& after,
                  std::vector<RegressionDifference>* differences)
      : before_(before), after_(after), differences_(differences) {
    Status();
    Optimum();
    Error();
    StationaryPoint();
    if (StatusRank(after_.status) < StatusRank(before_.status)) return;  // may cost more
    Iterations();
    Seconds();
  }

 private:
  void Add(Kind kind, const char* what, const std::string& text) {
    differences_->push_back({kind, before_.name, what, text});
  }

  void Status() {
    if (StatusRank(after_.status) <= StatusRank(before_.status)) return;
    Add(Kind::kWorse, "status", fmt::format("status {}, now {}", before_.status, after_.status));
  }

  /// Costs are minimised, so another optimum is worse if its cost is higher.
  void Optimum() {
    if (before_.optimum.empty() || before_.optimum == after_.optimum) return;
    if (after_.optimum.empty()) {
      Add(Kind::kWorse, "optimum",
          fmt::format("met optimum '{}', now none (objective {:.10g}, now {:.10g})",
                      before_.optimum, before_.objective, after_.objective));
      return;
    }
    Add(after_.objective > before_.objective ? Kind::kWorse : Kind::kNote, "optimum",
        fmt::format("met optimum '{}', now '{}' (objective {:.10g}, now {:.10g})", before_.optimum,
                    after_.optimum, before_.objective, after_.objective));
  }

  /// Compares errors only to the same optimum; the error to another one is meaningless.
  void Error() {
    if (before_.optimum != after_.optimum || std::isnan(before_.error)) return;
    if (after_.error <= kMoreError * before_.error || after_.error - before_.error <= kLeastError) {
      return;
    }
    if (std::isnan(after_.error)) {
      Add(Kind::kWorse, "error", fmt::format("relative error {:.2e}, now none", before_.error));
      return;
    }
    Add(Kind::kWorse, "error",
        fmt::format("relative error {:.2e}, now {:.2e} ({})", before_.error, after_.error,
                    Growth(before_.error, after_.error)));
  }

  /// A minimum that is no longer proved may still be one; a saddle is proved not to be.
  void StationaryPoint() {
    if (before_.stationary_point != "minimum") return;
    if (after_.stationary_point.empty() || after_.stationary_point == "minimum") return;
    if (StatusRank(after_.status) > StatusRank(before_.status)) return;  // said already
    Add(after_.stationary_point == "saddle" ? Kind::kWorse : Kind::kNote, "stationary point",
        fmt::format("stationary point {}, now {}", before_.stationary_point,
                    after_.stationary_point));
  }

  void Iterations() {
    if (after_.iterations <= kMoreIterations * before_.iterations) return;
    Add(Kind::kWorse, "iterations",
        fmt::format("iterations {}, now {} ({})", before_.iterations, after_.iterations,
                    Growth(before_.iterations, after_.iterations)));
  }

  void Seconds() {
    if (after_.seconds <= kMoreSeconds * before_.seconds) return;
    if (after_.seconds - before_.seconds <= kLeastSeconds) return;
    Add(Kind::kSlower, "seconds",
        fmt::format("{:.4f} s, now {:.4f} s ({})", before_.seconds, after_.seconds,
                    Growth(before_.seconds, after_.seconds)));
  }

  const Entry& before_;
  const Entry& after_;
  std::vector<RegressionDifference>* differences_;
};

/// Notes each changed member of environment and options.
void NoteSettings(const json& old_run, const json& new_run, const char* part,
                  std::vector<RegressionDifference>* differences) {
  const auto dump = [](const json& value) { return models::JsonText(value); };
  const auto members = [part](const json& run) {
    const auto found = run.find(part);
    return found != run.end() && found->is_object() ? *found : json::object();
  };
  const json before = members(old_run), after = members(new_run);
  for (const auto& [key, value] : after.items()) {
    const json old_value = before.value(key, json());
    if (old_value == value) continue;
    differences->push_back(
        {Kind::kNote, "", part,
         fmt::format("{}: {} was {}, now {}", part, key, dump(old_value), dump(value))});
  }
}

std::string KindName(Kind kind) {
  switch (kind) {
    case Kind::kWorse:
      return "worse";
    case Kind::kSlower:
      return "slower";
    case Kind::kNote:
      break;
  }
  return "note";
}

}  // namespace

bool RegressionComparison::failed() const {
  return std::any_of(differences.begin(), differences.end(),
                     [](const auto& difference) { return difference.kind == Kind::kWorse; });
}

ordered_json RegressionComparison::Json() const {
  ordered_json json = {{"failed", failed()}, {"differences", ordered_json::array()}};
  for (const RegressionDifference& difference : differences) {
    json["differences"].push_back({{"kind", KindName(difference.kind)},
                                   {"problem", difference.problem},
                                   {"what", difference.what},
                                   {"text", difference.text}});
  }
  return json;
}

std::string RegressionComparison::Text() const {
  std::string text;
  for (const RegressionDifference& difference : differences) {
    text += fmt::format("{:<8}{}{}{}\n", KindName(difference.kind), difference.problem,
                        difference.problem.empty() ? "" : ": ", difference.text);
  }
  const auto worse =
      std::count_if(differences.begin(), differences.end(),
                    [](const auto& difference) { return difference.kind == Kind::kWorse; });
  return text + (worse == 0
                     ? "nothing got worse\n"
                     : fmt::format("{} {} got worse\n", worse, worse == 1 ? "thing" : "things"));
}

json ReadRegressionFile(const std::filesystem::path& file) {
  std::error_code error;
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  if (std::filesystem::is_directory(file, error) || !stream || !(text << stream.rdbuf())) {
    throw InputError(fmt::format("{}: cannot be read, expected a file of possibility regress --out",
                                 file.string()));
  }
  json run;
  try {
    run = json::parse(text.str());
  } catch (const json::exception& failure) {
    throw InputError(fmt::format("{}: is not JSON ({})", file.string(), failure.what()));
  }
  ReadEntries(run, file.string());
  return run;
}

RegressionComparison CompareRegressions(const json& old_run, const json& new_run, bool is_whole) {
  const std::vector<Entry> before = ReadEntries(old_run, "the old run");
  const std::vector<Entry> after = ReadEntries(new_run, "the new run");
  RegressionComparison comparison;
  NoteSettings(old_run, new_run, "environment", &comparison.differences);
  NoteSettings(old_run, new_run, "options", &comparison.differences);
  for (const Entry& entry : before) {
    if (const Entry* now = Find(after, entry.name)) {
      EntryComparison(entry, *now, &comparison.differences);
    } else if (is_whole) {
      comparison.differences.push_back(
          {Kind::kWorse, entry.name, "problem", "the problem is missing"});
    }
  }
  for (const Entry& entry : after) {
    if (Find(before, entry.name) != nullptr) continue;
    comparison.differences.push_back({Kind::kNote, entry.name, "problem", "the problem is new"});
  }
  return comparison;
}

}  // namespace possibility::experiments
