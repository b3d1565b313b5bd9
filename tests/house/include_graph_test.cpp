// The rooms of docs/development.md, compared with the includes of the sources.
#include "tests/house/include_graph.h"

#include <gtest/gtest.h>

namespace possibility::house {
namespace {

const std::filesystem::path kSourceRoot = POSSIBILITY_SOURCE_DIR;

const RoomGraph& Sources() {
  static const RoomGraph graph = IncludeGraph(kSourceRoot);
  return graph;
}

std::string Floor(const std::string& room) { return room.substr(0, room.find('/')); }

TEST(IncludeGraphTest, TheTableListsExactlyTheIncludesOfEveryRoom) {
  const RoomGraph documented = DocumentedGraph(kSourceRoot / "docs" / "development.md");
  for (const auto& [room, used] : Sources()) {
    ASSERT_TRUE(documented.contains(room)) << room << " is not in the table of rooms";
    EXPECT_EQ(documented.at(room), used) << room;
  }
  for (const auto& [room, used] : documented) {
    EXPECT_TRUE(Sources().contains(room)) << room << " has no sources";
  }
}

TEST(IncludeGraphTest, IncludesBetweenRoomsFormNoCircle) { EXPECT_EQ(FindCircle(Sources()), ""); }

TEST(IncludeGraphTest, FloorsIncludeFromTheSameFloorOrBelowOnly) {
  const std::map<std::string, std::set<std::string>> below = {
      {"common", {"common"}},
      {"models", {"common", "models"}},
      {"dynamics", {"common", "models", "dynamics"}},
      {"collocation", {"common", "models", "dynamics", "collocation"}},
      {"graph", {"common", "graph"}},
      {"actions", {"common", "models", "dynamics", "collocation", "graph", "actions"}},
      {"experiments",
       {"common", "models", "dynamics", "collocation", "graph", "actions", "experiments"}},
      {"python",
       {"common", "models", "dynamics", "collocation", "graph", "actions", "experiments",
        "python"}},
  };
  for (const auto& [room, used] : Sources()) {
    for (const std::string& other : used) {
      EXPECT_TRUE(below.at(Floor(room)).contains(Floor(other))) << room << " includes " << other;
    }
  }
}

TEST(IncludeGraphTest, TheVerifierUsesNothingOfThePlanner) {
  for (const std::string& room : ReachableFrom(Sources(), "actions/verify")) {
    EXPECT_TRUE(room == "actions/plan" || room == "actions/rollout" || room == "actions/evidence" ||
                room == "actions/checks" || room == "common" || Floor(room) == "models" ||
                Floor(room) == "dynamics")
        << room;
  }
}

TEST(IncludeGraphTest, ACircleOfRoomsIsFound) {
  EXPECT_EQ(FindCircle({{"a", {"b"}}, {"b", {"c"}}, {"c", {}}}), "");
  EXPECT_EQ(FindCircle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"b"}}}), "b -> c -> b");
}

}  // namespace
}  // namespace possibility::house
