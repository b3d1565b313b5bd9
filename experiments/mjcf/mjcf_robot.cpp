#include "experiments/mjcf/mjcf_robot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <memory>
#include <optional>

#include "models/input/input_error.h"
#include "models/mesh/separate_process.h"
#ifdef POSSIBILITY_WITH_MUJOCO
#include <unistd.h>

#include "experiments/mjcf/mjcf_texts.h"
#include "experiments/mjcf/mujoco_urdf.h"
#endif

namespace possibility::experiments {
namespace {

#ifdef POSSIBILITY_WITH_MUJOCO

constexpr unsigned kMostSeconds = 60;  // of processor time; 100 meshes take some seconds

/// What a process says to another one: texts, each behind its length.
void Append(const std::string& text, std::string* message) {
  *message += fmt::format("{} ", text.size()) + text;
}

class Message {
 public:
  explicit Message(const std::string& bytes) : bytes_(bytes) {}
  bool AtEnd() const { return at_ >= bytes_.size(); }
  std::string Next() {
    const std::size_t length = std::stoul(bytes_.substr(at_, 20));
    const std::size_t begin = bytes_.find(' ', at_) + 1;
    at_ = begin + length;
    return bytes_.substr(begin, length);
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::string OneLine(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

/// A model, or MuJoCo's message.
const mjModel* Load(const std::filesystem::path& file, const MjcfTexts& texts,
                    std::string* message) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  for (const auto& [name, bytes] : texts.Changed()) {
    if (mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(bytes.size())) != 0)
      continue;
    const int at = mj_findFileVFS(files.get(), name.c_str());
    std::copy(bytes.begin(), bytes.end(), static_cast<char*>(files->filedata[at]));
  }
  std::array<char, 1000> error{};
  const mjModel* model =
      mj_loadXML(file.c_str(), files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteVFS(files.get());
  *message = OneLine(error.data());
  return model;
}

/// What went wrong, or nothing; then the robot.
std::string Converted(const std::filesystem::path& file, const std::string& robot) {
  // MuJoCo's own handlers write a log file into the current folder.
  mju_user_error = [](const char*) { ::_exit(1); };
  mju_user_warning = [](const char*) {};
  std::string message, error;
  MjcfTexts texts(file);
  std::vector<std::string> findings;
  const mjModel* model = nullptr;
  do {
    model = Load(file, texts, &error);
  } while (model == nullptr && texts.Mend(error, &findings));
  if (model == nullptr) {
    Append(error, &message);
    return message;
  }
  try {
    MjcfRobot converted = UrdfOfModel(*model, robot, texts.efforts());
    converted.findings.insert(converted.findings.begin(), findings.begin(), findings.end());
    for (const std::string& text : {std::string(), converted.urdf, converted.srdf}) {
      Append(text, &message);
    }
    Append(std::to_string(converted.findings.size()), &message);
    for (const std::string& finding : converted.findings) Append(finding, &message);
    for (const NamedBytes& mesh : converted.files) {
      Append(mesh.name, &message);
      Append(mesh.bytes, &message);
    }
    return message;
  } catch (const InputError& refusal) {
    std::string refused;
    Append(refusal.what(), &refused);
    return refused;
  }
}

#endif

}  // namespace

#ifdef POSSIBILITY_WITH_MUJOCO

MjcfRobot ReadMjcf(const std::filesystem::path& file, const std::string& robot) {
  if (!std::ifstream(file)) throw InputError(fmt::format("{}: cannot be read", file.string()));
  const std::optional<std::string> answer =
      models::InSeparateProcess([&] { return Converted(file, robot); }, kMostSeconds);
  if (!answer)
    throw InputError(fmt::format("{}: MuJoCo does not survive this file", file.string()));
  Message message(*answer);
  if (const std::string error = message.Next(); !error.empty()) {
    throw InputError(fmt::format("{}: {}", file.string(), error));
  }
  MjcfRobot result;
  result.urdf = message.Next();
  result.srdf = message.Next();
  for (int left = std::stoi(message.Next()); left > 0; --left) {
    result.findings.push_back(message.Next());
  }
  while (!message.AtEnd()) {
    std::string name = message.Next();
    result.files.push_back({std::move(name), message.Next()});
  }
  return result;
}

#else

MjcfRobot ReadMjcf(const std::filesystem::path& file, const std::string&) {
  throw InputError(fmt::format(
      "{}: this program was built without MuJoCo: install libmujoco-dev and build it again",
      file.string()));
}

#endif

}  // namespace possibility::experiments
