#include "actions/plan/segment_action.h"

#include <gtest/gtest.h>

namespace possibility::actions {
namespace {

TEST(SegmentAction, ParsesANameOrATransitionBetweenTwo) {
  const auto walk = ParseSegmentAction("walk");
  ASSERT_TRUE(walk);
  EXPECT_EQ(walk->from, "walk");
  EXPECT_EQ(walk->to, "walk");
  EXPECT_FALSE(walk->is_transition);
  const auto sit = ParseSegmentAction("walk->crawl");
  ASSERT_TRUE(sit);
  EXPECT_EQ(sit->from, "walk");
  EXPECT_EQ(sit->to, "crawl");
  EXPECT_TRUE(sit->is_transition);
}

TEST(SegmentAction, RefusesMalformedNamesAndTransitions) {
  for (const std::string& text :
       {std::string(), std::string("->"), std::string("walk->"), std::string("->walk"),
        std::string("walk->crawl->walk"), std::string("walk ->crawl"), std::string("<b>"),
        std::string("walk->\0", 7), std::string("../walk")}) {
    EXPECT_FALSE(ParseSegmentAction(text)) << text;
  }
}

}  // namespace
}  // namespace possibility::actions
