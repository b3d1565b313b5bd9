#include "actions/gait/pace_library.h"

#include <fmt/format.h>

#include <cmath>

#include "actions/motion/motion_folder.h"
#include "models/input/atomic_file.h"
#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/input/json_cursor.h"
#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

constexpr const char* kFormat = "possibility-paces/2";

/// Goes up when the family of paces or their fit changes: earlier paces are stale.
constexpr const char* kFit = "2";

nlohmann::json ToJson(const Pace& pace) {
  return {{"forward", pace.bounds.forward},
          {"lateral", pace.bounds.lateral},
          {"turn", pace.bounds.turn},
          {"swing", pace.timing.swing},
          {"swing_length", pace.timing.swing_length},
          {"double_support", pace.timing.double_support},
          {"start", pace.timing.start},
          {"rise", pace.rise},
          {"evenness", pace.style.evenness},
          {"body_turn", pace.style.turn},
          {"twist", pace.style.twist},
          {"lean", pace.style.lean},
          {"zmp_ahead", pace.style.zmp_ahead},
          {"keeps_reach", pace.style.keeps_reach}};
}

/// A kept figure differs from the gait's own by less than this factor. Others are damage: steps of
/// a nanometre would take for ever.
constexpr double kPlausible = 20;
constexpr double kHighest = 10;   // m
constexpr double kMostAngle = 1;  // rad
constexpr double kGreatestEvenness = 100;

/// A number of at most this magnitude.
double Within(const models::JsonCursor& value, double most) {
  const double number = value.Number();
  if (!(std::abs(number) <= most)) value.Fail(fmt::format("expected at most {}", most));
  return number;
}

double Plausible(const models::JsonCursor& value, double unit) {
  const double number = value.Number();
  const bool plausible = number > unit / kPlausible && number < unit * kPlausible;
  if (!plausible) value.Fail(fmt::format("expected about {}", unit));
  return number;
}

Pace ToPace(const models::JsonCursor& value, const models::GaitParameters& gait) {
  value.ExpectKeys({"forward", "lateral", "turn", "swing", "swing_length", "double_support",
                    "start", "rise", "evenness", "body_turn", "twist", "lean", "zmp_ahead",
                    "keeps_reach"});
  Pace pace;
  pace.bounds.forward = Plausible(value["forward"], gait.forward);
  pace.bounds.lateral = Plausible(value["lateral"], gait.lateral);
  pace.bounds.turn = Plausible(value["turn"], gait.turn);
  pace.timing.swing = Plausible(value["swing"], gait.swing_time);
  pace.timing.swing_length = Plausible(value["swing_length"], gait.forward);
  pace.timing.double_support = Plausible(value["double_support"], gait.swing_time);
  pace.timing.start = Plausible(value["start"], gait.swing_time);
  pace.rise = Within(value["rise"], kHighest);
  pace.style.evenness = Within(value["evenness"], kGreatestEvenness);
  if (pace.style.evenness < 1) value["evenness"].Fail("expected at least 1");
  pace.style.turn = Within(value["body_turn"], kMostAngle);
  pace.style.twist = Within(value["twist"], kMostAngle);
  pace.style.lean = Within(value["lean"], kMostAngle);
  pace.style.zmp_ahead = Within(value["zmp_ahead"], kHighest);
  pace.style.keeps_reach = value["keeps_reach"].Bool();
  return pace;
}

std::vector<Pace> ReadPaces(const std::filesystem::path& file, const std::string& identity,
                            const models::GaitParameters& gait) {
  const nlohmann::json document =
      models::ParseJson(models::ReadFileContents(file), file, "a file of paces");
  const models::JsonCursor root(document, file);
  root.ExpectFormat(kFormat);
  root.ExpectKeys({"format", "identity", "paces"});
  if (root["identity"].String() != identity) root["identity"].Fail("is another robot's");
  std::vector<Pace> paces;
  const models::JsonCursor list = root["paces"];
  for (std::size_t i = 0; i < list.ArraySize(); ++i) paces.push_back(ToPace(list[i], gait));
  return paces;
}

}  // namespace

PaceLibrary::PaceLibrary(const models::RobotModel& robot, const std::filesystem::path& library)
    : identity_(models::HashOfParts({robot.content_hash, kFormat, kFit})),
      folder_(MotionFolder(library, identity_)) {}

std::filesystem::path PaceLibrary::FileOf(const models::Gait& gait) const {
  return folder_ / fmt::format("paces_{}.json", gait.name);
}

std::optional<std::vector<Pace>> PaceLibrary::Find(const models::Gait& gait) const {
  if (folder_.empty() || !std::filesystem::exists(FileOf(gait))) return std::nullopt;
  try {
    return ReadPaces(FileOf(gait), identity_, gait.parameters);
  } catch (const InputError&) {
    return std::nullopt;  // Paces that cannot be read are fitted again.
  }
}

void PaceLibrary::Save(const models::Gait& gait, const std::vector<Pace>& paces) const {
  if (folder_.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  nlohmann::json list = nlohmann::json::array();
  for (const Pace& pace : paces) list.push_back(ToJson(pace));
  const nlohmann::json document = {{"format", kFormat}, {"identity", identity_}, {"paces", list}};
  models::WriteAtomically(FileOf(gait), models::JsonText(document, 1) + "\n");
}

}  // namespace possibility::actions
