#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace possibility::experiments::testing {

/// A page in headless Chromium. Tests are skipped without it.
class BrowserTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "chromium is not installed";
    }
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void WritePage(const std::string& page) const { std::ofstream(folder_ / "plan.html") << page; }

  /// The document once its scripts have run. `script`: one more, behind the page's own.
  std::string Opened(const std::string& address, const std::string& script = "") const {
    if (!script.empty()) {
      std::ofstream(folder_ / "plan.html", std::ios::app) << "<script>" << script << "</script>";
    }
    const std::string command = fmt::format(
        "chromium --headless --no-sandbox --disable-gpu-sandbox --use-gl=angle "
        "--use-angle=swiftshader --enable-unsafe-swiftshader --user-data-dir='{0}/profile' "
        "--window-size=1000,700 --virtual-time-budget=3000 --dump-dom 'file://{0}/plan.html{1}' "
        "2>/dev/null",
        folder_.string(), address);
    std::string document;
    FILE* pipe = ::popen(command.c_str(), "r");
    if (pipe == nullptr) return document;
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof(buffer), pipe)) > 0;) {
      document.append(buffer, n);
    }
    ::pclose(pipe);
    return document;
  }

  /// Otherwise the page shows its message.
  static bool HasWebGl(const std::string& document) {
    return Between(document, "<p id=\"message\"", ">").find("hidden") != std::string::npos;
  }

  static std::string Between(const std::string& text, const std::string& begin,
                             const std::string& end) {
    const std::size_t place = text.find(begin);
    if (place == std::string::npos) return "nothing after " + begin;
    const std::size_t first = place + begin.size();
    return text.substr(first, text.find(end, first) - first);
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("viewer_browser_{}", ::getpid());
};

}  // namespace possibility::experiments::testing
