// The page in a browser: what its address asks for, and the address that it offers.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "experiments/viewer/viewer_page.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class ViewerAddress : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0) {
      GTEST_SKIP() << "chromium is not installed";
    }
    std::filesystem::create_directories(folder_);
    const models::RobotModel robot = testing::SampleRobot();
    std::ofstream(folder_ / "plan.html")
        << ViewerPage(testing::SamplePlan(robot, 4, 9), robot, testing::SampleScenario());
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// The document once its scripts have run.
  std::string Opened(const std::string& address) const {
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
    return document.find("<p id=\"message\" hidden=\"\">") != std::string::npos;
  }

  static std::string Between(const std::string& text, const std::string& begin,
                             const std::string& end) {
    const std::size_t place = text.find(begin);
    if (place == std::string::npos) return "nothing after " + begin;
    const std::size_t first = place + begin.size();
    return text.substr(first, text.find(end, first) - first);
  }

  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / fmt::format("viewer_address_{}", ::getpid());
};

TEST_F(ViewerAddress, TheLinkLeadsToTheTimeAndViewThatAreShown) {
  const std::string document = Opened("#t=1.5&camera=3,-2,1.5,0.5,0.25,0.75&graph=0");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "<output id=\"clock\">", "<"), "1.50 / 4.00 s");
  EXPECT_EQ(Between(document, "<a id=\"link\" href=\"", "\""),
            "#t=1.500&amp;camera=3.000,-2.000,1.500,0.500,0.250,0.750&amp;graph=0");
}

TEST_F(ViewerAddress, ACameraThatIsNoPlaceIsIgnored) {
  const std::string document = Opened("#t=9&camera=1,2,x&view=top");
  if (!HasWebGl(document)) GTEST_SKIP() << "chromium has no WebGL here";
  EXPECT_EQ(Between(document, "<output id=\"clock\">", "<"), "4.00 / 4.00 s");
  const std::string link = Between(document, "<a id=\"link\" href=\"", "\"");
  EXPECT_TRUE(link.starts_with("#t=4.000&amp;camera=")) << link;
  EXPECT_EQ(link.find("nan"), std::string::npos);
  EXPECT_EQ(link.find("x"), std::string::npos);
}

}  // namespace
}  // namespace possibility::experiments
