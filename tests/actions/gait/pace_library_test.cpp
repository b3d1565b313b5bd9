#include "actions/gait/pace_library.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <ostream>
#include <string>

#include "actions/gait/pace_trial.h"
#include "models/input/file_contents.h"
#include "tests/actions/drchubo1.h"
#include "tests/actions/dynamic_gaits.h"
#include "tests/models/temporary_folder.h"

namespace possibility::actions {
namespace {

const models::Gait& Walk() { return DrcHubo1().GaitNamed("walk"); }

void ExpectSame(const Pace& a, const Pace& b) {
  EXPECT_EQ(a.bounds.forward, b.bounds.forward);
  EXPECT_EQ(a.bounds.lateral, b.bounds.lateral);
  EXPECT_EQ(a.bounds.turn, b.bounds.turn);
  EXPECT_EQ(a.timing.swing, b.timing.swing);
  EXPECT_EQ(a.timing.swing_length, b.timing.swing_length);
  EXPECT_EQ(a.timing.double_support, b.timing.double_support);
  EXPECT_EQ(a.timing.start, b.timing.start);
  EXPECT_EQ(a.rise, b.rise);
  EXPECT_EQ(a.style.evenness, b.style.evenness);
  EXPECT_EQ(a.style.turn, b.style.turn);
  EXPECT_EQ(a.style.twist, b.style.twist);
  EXPECT_EQ(a.style.lean, b.style.lean);
  EXPECT_EQ(a.style.zmp_ahead, b.style.zmp_ahead);
  EXPECT_EQ(a.style.keeps_reach, b.style.keeps_reach);
}

TEST(PaceLibrary, ReadsBackTheSamePaces) {
  const models::TemporaryFolder folder;
  const PaceLibrary library(DrcHubo1(), folder.path());
  EXPECT_FALSE(library.Find(Walk()));
  const std::vector<Pace>& paces = DrcHubo1Flowing("walk").motion().paces();
  library.Save(Walk(), paces);
  const std::optional<std::vector<Pace>> found = library.Find(Walk());
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), paces.size());
  for (std::size_t i = 0; i < paces.size(); ++i) ExpectSame((*found)[i], paces[i]);
}

TEST(PaceLibrary, KeepsThatNoPaceFits) {
  const models::TemporaryFolder folder;
  const PaceLibrary library(DrcHubo1(), folder.path());
  library.Save(Walk(), {});
  const std::optional<std::vector<Pace>> found = library.Find(Walk());
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->empty());
}

TEST(PaceLibrary, ForgetsPacesOfAChangedRobot) {
  const models::TemporaryFolder folder;
  PaceLibrary(DrcHubo1(), folder.path()).Save(Walk(), {});
  models::RobotModel changed = DrcHubo1();
  changed.content_hash = std::string(64, '0');
  EXPECT_FALSE(PaceLibrary(changed, folder.path()).Find(Walk()));
}

TEST(PaceLibrary, FindsNothingInADamagedFile) {
  const models::TemporaryFolder folder;
  const PaceLibrary library(DrcHubo1(), folder.path());
  library.Save(Walk(), DrcHubo1Flowing("walk").motion().paces());
  const std::string intact = models::ReadFileContents(library.FileOf(Walk()));
  const auto find = [&](const std::string& text) {
    std::ofstream(library.FileOf(Walk())) << text;
    return library.Find(Walk());
  };
  ASSERT_TRUE(find(intact));
  for (std::size_t length = 0; length + 2 < intact.size(); length += 7) {
    EXPECT_FALSE(find(intact.substr(0, length))) << length;
  }
}

TEST(PaceLibrary, FindsNoImplausiblePaces) {
  const models::TemporaryFolder folder;
  const PaceLibrary library(DrcHubo1(), folder.path());
  for (const double wrong : {-1.0, 0.0, 1e-300, 1e300}) {
    std::vector<Pace> paces = DrcHubo1Flowing("walk").motion().paces();
    for (double* field : {&paces[0].bounds.forward, &paces[0].bounds.lateral, &paces[0].bounds.turn,
                          &paces[0].timing.swing, &paces[0].timing.swing_length,
                          &paces[0].timing.double_support, &paces[0].timing.start}) {
      const double right = *field;
      *field = wrong;
      library.Save(Walk(), paces);
      EXPECT_FALSE(library.Find(Walk())) << wrong;
      *field = right;
    }
  }
}

TEST(PaceLibrary, FindsNoImplausibleStyle) {
  const models::TemporaryFolder folder;
  const PaceLibrary library(DrcHubo1(), folder.path());
  std::vector<Pace> paces = DrcHubo1Flowing("walk").motion().paces();
  PaceStyle& style = paces[0].style;
  for (double* field :
       {&style.evenness, &style.turn, &style.twist, &style.lean, &style.zmp_ahead}) {
    for (const double wrong : {-1e300, -20.0, 1e300}) {
      const double right = *field;
      *field = wrong;
      library.Save(Walk(), paces);
      EXPECT_FALSE(library.Find(Walk())) << wrong;
      *field = right;
    }
  }
  library.Save(Walk(), paces);
  EXPECT_TRUE(library.Find(Walk()));
}

/// How many optimised paces stand before those of the fit.
struct ShippedCase {
  const char* gait;
  std::size_t optimised;
};

void PrintTo(const ShippedCase& shipped, std::ostream* stream) { *stream << shipped.gait; }

class ShippedPaces : public ::testing::TestWithParam<ShippedCase> {};

/// `possibility library` writes them anew. The search before the fit takes minutes.
TEST_P(ShippedPaces, AreThoseThatTheFitFindsWithAQuickerOneBefore) {
  const models::Gait& gait = DrcHubo1().GaitNamed(GetParam().gait);
  const NominalStance stance = SolveNominalStance(DrcHubo1(), gait);
  const auto shipped = PaceLibrary(DrcHubo1(), DrcHubo1Library()).Find(gait);
  const std::vector<Pace> fitted = DynamicGait(DrcHubo1(), stance).paces();
  ASSERT_TRUE(shipped);
  const std::size_t optimised = GetParam().optimised;
  ASSERT_EQ(shipped->size(), fitted.size() + optimised);
  for (std::size_t i = 0; i < fitted.size(); ++i) ExpectSame((*shipped)[i + optimised], fitted[i]);
  if (optimised == 0) return;
  const Pace& quickest = shipped->front();
  EXPECT_GT(quickest.speed(), 1.15 * fitted.front().speed());
  EXPECT_GE(quickest.bounds.lateral, fitted.front().bounds.lateral);
  EXPECT_GE(quickest.bounds.turn, fitted.front().bounds.turn);
  const PaceTrial trial(DrcHubo1(), stance);
  EXPECT_EQ(trial.WhyNot(quickest, {quickest.bounds.forward, 0, 0}, kFittedClearance), "");
}

INSTANTIATE_TEST_SUITE_P(Gaits, ShippedPaces,
                         ::testing::Values(ShippedCase{"walk", 1}, ShippedCase{"crawl", 1}),
                         [](const auto& info) { return std::string(info.param.gait); });

}  // namespace
}  // namespace possibility::actions
