#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "experiments/recording/child_process.h"
#include "experiments/support/temporary_folder.h"
#include "models/input/json_text.h"

namespace possibility::experiments {

struct PictureSize {
  int width = 1280;  ///< pixels
  int height = 720;
};

/// A Chromium without a window, which draws in software, so that pictures do not depend on the
/// graphics card. It is spoken to by the DevTools protocol.
class HeadlessBrowser {
 public:
  /// @throws InputError if no Chromium is found on PATH or it does not start.
  explicit HeadlessBrowser(PictureSize size);

  /// Opens a page that is given as text. `address`: what follows its name, "#t=5". @throws
  /// InputError if the browser fails.
  void Open(std::string_view page, const std::string& address);
  /// The value of a JavaScript expression; a promise's value once it has one. @throws InputError
  /// with the page's message if the expression throws.
  nlohmann::ordered_json Evaluate(const std::string& expression);
  /// What the page shows, as a PNG. @throws InputError if the browser fails.
  std::string Picture();

 private:
  nlohmann::ordered_json Call(const std::string& method, const nlohmann::ordered_json& parameters);
  nlohmann::ordered_json NextMessage();

  PictureSize size_;
  TemporaryFolder folder_;  ///< profile and page
  std::unique_ptr<ChildProcess> process_;
  std::string session_;
  std::string unread_;
  int calls_ = 0;
  int pages_ = 0;  ///< a name of its own makes the browser read each anew
};

}  // namespace possibility::experiments
