// The page without a mouse and without sight.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "experiments/recording/headless_browser.h"
#include "experiments/viewer/viewer_page.h"
#include "tests/experiments/sample_plan.h"

namespace possibility::experiments {
namespace {

class PageKeys : public ::testing::Test {
 protected:
  static void TearDownTestSuite() { browser_.reset(); }

  void SetUp() override {
    if (!FindProgram({"chromium", "chromium-browser", "google-chrome"})) {
      GTEST_SKIP() << "chromium is not installed";
    }
    const models::RobotModel robot = testing::SampleRobot();
    const models::Scenario yard = testing::SampleScenario();
    const actions::Plan plan = testing::SamplePlan(robot, 4, 9);
    if (!browser_) browser_ = std::make_unique<HeadlessBrowser>(PictureSize{1000, 800});
    browser_->Open(ComparisonPage({plan, robot, yard}, {plan, robot, yard}), "#t=1&plots=1");
    if (browser_->Evaluate("page === null") == true) GTEST_SKIP() << "chromium has no WebGL here";
  }

  /// Presses a key with the focus on an element ("" for none). Returns whether the page took it.
  bool Press(const std::string& key, bool shift = false, const std::string& id = "") {
    return browser_->Evaluate(fmt::format(
        "!({} || document.body).dispatchEvent(new KeyboardEvent('keydown', {{key: '{}', "
        "shiftKey: {}, bubbles: true, cancelable: true}}))",
        id.empty() ? "null" : "element('" + id + "')", key, shift));
  }
  double Number(const std::string& expression) { return browser_->Evaluate(expression); }

  static std::unique_ptr<HeadlessBrowser> browser_;
};

std::unique_ptr<HeadlessBrowser> PageKeys::browser_;

TEST_F(PageKeys, MoveInTime) {
  EXPECT_TRUE(Press("ArrowRight"));
  EXPECT_NEAR(Number("page.time"), 1.1, 1e-9);
  Press("ArrowLeft");
  Press("ArrowLeft");
  EXPECT_NEAR(Number("page.time"), 0.9, 1e-9);
  Press("End");
  EXPECT_EQ(Number("page.time"), 4);
  Press("Home");
  EXPECT_EQ(Number("page.time"), 0);
  Press("PageDown");
  EXPECT_EQ(Number("page.time"), 2);
  EXPECT_FALSE(Press("x"));
}

TEST_F(PageKeys, TurnAndApproachBothViews) {
  const std::string arm =
      "page.views[{}].drawing.camera.position.clone().sub(page.views[{}].drawing.controls.target)";
  const auto length = [&](int i) {
    return Number(fmt::format(fmt::runtime(arm + ".length()"), i, i));
  };
  const auto angle = [&](int i) {
    return Number(fmt::format(
        fmt::runtime("(() => {{ const a = " + arm + "; return Math.atan2(a.y, a.x); }})()"), i, i));
  };
  const double distance = length(0);
  const double before = angle(0);
  Press("ArrowRight", true);
  EXPECT_NEAR(Number("page.time"), 1, 1e-9) << "the key with shift is another one";
  EXPECT_NEAR(std::abs(angle(0) - before), M_PI / 24, 1e-6);
  EXPECT_NEAR(length(0), distance, 1e-6);
  Press("PageUp", true);
  EXPECT_NEAR(length(0), 0.85 * distance, 1e-6);
  EXPECT_NEAR(length(1), length(0), 1e-6);
  EXPECT_NEAR(angle(1), angle(0), 1e-6);
}

/// Space presses the button that has the focus, and the arrows choose in a list.
TEST_F(PageKeys, AreLeftToTheElementThatNeedsThem) {
  EXPECT_FALSE(Press(" ", false, "zoom-in"));
  EXPECT_FALSE(Press("ArrowRight", false, "speed"));
  EXPECT_EQ(browser_->Evaluate("page.playing"), false);
  EXPECT_TRUE(Press(" ", false, "detail"));
  EXPECT_EQ(browser_->Evaluate("page.playing"), true);
}

TEST_F(PageKeys, AreListedOnThePage) {
  EXPECT_EQ(browser_->Evaluate("[...document.querySelectorAll('#keys dt')].length"),
            browser_->Evaluate("shortcutsOf(page).length"));
  EXPECT_EQ(browser_->Evaluate("element('keys').textContent.includes('spaceplay, pause')"), true);
}

/// A name in words: neither a title alone, which not every reader says, nor a sign.
TEST_F(PageKeys, EveryControlHasANameAndCanBeReached) {
  const auto unnamed = browser_->Evaluate(
      "[...document.querySelectorAll('button, input, select, a, summary, [tabindex], [role]')]"
      ".filter((part) => part.tagName !== 'P' && part.getAttribute('role') !== 'group')"
      ".filter((part) => { const words = part.getAttribute('aria-label') || part.textContent || "
      "[...(part.labels || [])].map((label) => label.textContent).join(''); "
      "return !/[A-Za-z]{2}/.test(words); }).map((part) => part.outerHTML)");
  EXPECT_TRUE(unnamed.empty()) << unnamed;
  const auto unreachable = browser_->Evaluate(
      "[...document.querySelectorAll('button, input, select, a, summary, [role=slider]')]"
      ".filter((part) => part.tabIndex < 0).map((part) => part.outerHTML)");
  EXPECT_TRUE(unreachable.empty()) << unreachable;
}

TEST_F(PageKeys, TheTimelineIsASliderThatSaysWhereTheRobotIs) {
  Press("ArrowRight");
  EXPECT_EQ(browser_->Evaluate("element('detail').getAttribute('aria-valuenow')"), "1.10");
  EXPECT_EQ(browser_->Evaluate("element('detail').getAttribute('aria-valuemax')"), "4.00");
  const std::string said = browser_->Evaluate("element('announcer').textContent");
  EXPECT_TRUE(said.starts_with("1.1 s. walk, ")) << said;
}

/// At least 4.5, as WCAG 2 asks of small text.
TEST_F(PageKeys, WordsOnColoursAndOnWhiteAreEasyToRead) {
  browser_->Evaluate(
      "window.light = (colour) => { const {r, g, b} = new THREE.Color(colour); const l = (x) => x "
      "<= "
      "0.04045 ? x / 12.92 : Math.pow((x + 0.055) / 1.055, 2.4); return 0.2126 * l(r) + 0.7152 * "
      "l(g) "
      "+ 0.0722 * l(b); }; window.contrast = (a, b) => { const [x, y] = [light(a), light(b)]; "
      "return "
      "(Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); }; 0");
  EXPECT_NEAR(Number("contrast('#000000', '#ffffff')"), 21, 1e-9);
  EXPECT_GE(
      Number("Math.min(...Object.values(actionColours).concat(kLimbColours, "
             "Object.values(kPhaseColours)).map((colour) => contrast(inkOn(colour), colour)))"),
      4.5);
  const auto faint = browser_->Evaluate(
      "[...document.querySelectorAll('button, dt, dd, label, summary, .curve, .contacts, .action, "
      "figcaption i, .key, select, output')].filter((part) => "
      "contrast(getComputedStyle(part).color, "
      "'#ffffff') < 4.5).map((part) => part.className + ' ' + getComputedStyle(part).color)");
  EXPECT_TRUE(faint.empty()) << faint;
}

/// The sample plan's page would play at once.
TEST_F(PageKeys, NothingMovesByItselfIfTheReaderWishesSo) {
  browser_->Evaluate("window.matchMedia = (query) => ({matches: query.includes('reduce')}); 0");
  browser_->Evaluate(
      "new Promise((done) => { addEventListener('hashchange', () => setTimeout(done, 0)); "
      "location.hash = 't=1&play=1'; })");
  EXPECT_EQ(browser_->Evaluate("page.playing"), false);
  browser_->Evaluate("window.matchMedia = () => ({matches: false}); page.applyAddress(); 0");
  EXPECT_EQ(browser_->Evaluate("page.playing"), true);
}

}  // namespace
}  // namespace possibility::experiments
