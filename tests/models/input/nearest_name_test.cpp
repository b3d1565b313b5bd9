#include "models/input/nearest_name.h"

#include <gtest/gtest.h>

namespace possibility::models {
namespace {

const std::vector<std::string> kKnown = {"walk", "crawl", "long_jump"};

TEST(NearestName, FindsTheFewestEdits) {
  EXPECT_EQ(NearestName("wlak", kKnown), "walk");
  EXPECT_EQ(NearestName("craw", kKnown), "crawl");
  EXPECT_EQ(NearestName("jump", kKnown), "");  // five of nine letters to add
  EXPECT_EQ(NearestName("longjump", kKnown), "long_jump");
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
  EXPECT_EQ(NearestName("swim", kKnown), "");
  EXPECT_EQ(NearestName("", kKnown), "");
  EXPECT_EQ(NearestName("walk", {}), "");
  EXPECT_EQ(NearestName(std::string(10000, 'w'), kKnown), "");
}

TEST(NearestName, DidYouMeanNamesTheSuggestion) {
  EXPECT_EQ(DidYouMean("wlak", kKnown), " (did you mean 'walk'?)");
  EXPECT_EQ(DidYouMean("swim", kKnown), "");
}

}  // namespace
}  // namespace possibility::models
