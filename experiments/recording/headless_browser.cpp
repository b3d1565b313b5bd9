#include "experiments/recording/headless_browser.h"

#include <fmt/format.h>
#include <unistd.h>

#include <vector>

#include "experiments/support/base64.h"
#include "experiments/support/output_file.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kPatience = 120;  // s, for one answer
const std::vector<int> kDevTools = {3,
                                    4};  // --remote-debugging-pipe reads the one, writes the other

std::filesystem::path FindChromium() {
  const auto found = FindProgram({"chromium", "chromium-browser", "google-chrome"});
  if (!found) {
    throw InputError(
        "chromium: not found on PATH, expected Chromium to record pages (Debian package chromium)");
  }
  return *found;
}

std::vector<std::string> ArgumentsOf(PictureSize size, const std::filesystem::path& folder) {
  std::vector<std::string> arguments = {
      "--headless",
      "--no-first-run",
      "--hide-scrollbars",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--remote-debugging-pipe",
      fmt::format("--user-data-dir={}", (folder / "profile").string()),
      fmt::format("--window-size={},{}", size.width, size.height),
  };
  if (::geteuid() == 0) arguments.emplace_back("--no-sandbox");  // it refuses to start otherwise
  arguments.emplace_back("about:blank");
  return arguments;
}

}  // namespace

HeadlessBrowser::HeadlessBrowser(PictureSize size) : size_(size) {
  process_ =
      std::make_unique<ChildProcess>(FindChromium(), ArgumentsOf(size, folder_.path()), kDevTools);
  const Json targets = Call("Target.getTargets", Json::object())["targetInfos"];
  std::string page;
  for (const Json& target : targets) {
    if (target["type"] == "page") page = target["targetId"];
  }
  session_ = Call("Target.attachToTarget", {{"targetId", page}, {"flatten", true}})["sessionId"];
  Call("Emulation.setDeviceMetricsOverride", {{"width", size.width},
                                              {"height", size.height},
                                              {"deviceScaleFactor", 1},
                                              {"mobile", false}});
}

void HeadlessBrowser::Open(std::string_view page, const std::string& address) {
  const std::filesystem::path file = folder_.path() / fmt::format("page_{}.html", ++pages_);
  WriteOutput(file, page);
  Call("Page.enable", Json::object());
  Call("Page.navigate", {{"url", "file://" + file.string() + address}});
  const std::string loaded =
      "new Promise((done) => { const tell = () => done(decodeURI(location.pathname)); "
      "if (document.readyState === 'complete') tell(); else addEventListener('load', tell); })";
  while (Evaluate(loaded) != file.string()) continue;
}

Json HeadlessBrowser::Evaluate(const std::string& expression) {
  const Json answer =
      Call("Runtime.evaluate",
           {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (answer.contains("exceptionDetails")) {
    const Json& details = answer["exceptionDetails"];
    const Json exception = details.value("exception", Json::object());
    throw InputError("the page in the browser: " +
                     exception.value("description", details.value("text", "an error")));
  }
  return answer["result"].value("value", Json());
}

std::string HeadlessBrowser::Picture() {
  const Json answer = Call("Page.captureScreenshot", {{"format", "png"}});
  return FromBase64(answer["data"].get<std::string>());
}

Json HeadlessBrowser::Call(const std::string& method, const Json& parameters) {
  Json message = {{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  std::string text = message.dump();
  text += '\0';
  process_->Write(text);
  while (true) {
    const Json answer = NextMessage();
    if (answer.value("id", 0) != calls_) continue;
    if (answer.contains("error")) {
      throw InputError(fmt::format("chromium: {}: {}", method,
                                   answer["error"].value("message", "it does not know how")));
    }
    return answer["result"];
  }
}

Json HeadlessBrowser::NextMessage() {
  std::size_t end = unread_.find('\0');
  while (end == std::string::npos) {
    const std::size_t searched = unread_.size();
    unread_ += process_->Read(kPatience);
    end = unread_.find('\0', searched);
  }
  Json message = Json::parse(unread_.substr(0, end), nullptr, false);
  unread_.erase(0, end + 1);
  return message.is_object() ? message : Json::object();
}

}  // namespace possibility::experiments
