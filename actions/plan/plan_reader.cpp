#include "actions/plan/plan_reader.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "actions/plan/packed_reader.h"
#include "actions/plan/plain_reader.h"
#include "models/archive/zip_file.h"
#include "models/input/input_error.h"

namespace possibility::actions {
namespace {

[[noreturn]] void RefuseFile(const std::filesystem::path& file, const char* what) {
  throw InputError(fmt::format("{}: {}, expected a plan.json ({}) or a plan.zip ({})",
                               file.string(), what, kPlanFormat, kPackedPlanFormat));
}

std::string BytesOf(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) RefuseFile(file, "no such file");
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) RefuseFile(file, "cannot be read");
  return std::move(text).str();
}

}  // namespace

std::filesystem::path PlanFileOf(const std::filesystem::path& file_or_directory) {
  std::error_code error;
  if (!std::filesystem::is_directory(file_or_directory, error)) return file_or_directory;
  const std::filesystem::path plain = file_or_directory / "plan.json";
  const std::filesystem::path packed = file_or_directory / "plan.zip";
  return !std::filesystem::exists(plain, error) && std::filesystem::exists(packed, error) ? packed
                                                                                          : plain;
}

Plan ReadPlan(const std::filesystem::path& file_or_directory) {
  const std::filesystem::path file = PlanFileOf(file_or_directory);
  return ParsePlan(BytesOf(file), file);
}

Plan ParsePlan(const std::string& text, const std::filesystem::path& file) {
  return models::IsZip(text) ? ReadPackedPlan(text, file) : ReadPlainPlan(text, file);
}

}  // namespace possibility::actions
