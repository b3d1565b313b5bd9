#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace possibility::house {

/// By room (a folder such as "actions/plan"): the rooms it uses.
using RoomGraph = std::map<std::string, std::set<std::string>>;

/// The includes among the sources under `root`. Every folder with sources is a room.
RoomGraph IncludeGraph(const std::filesystem::path& root);

/// The table of rooms in docs/development.md: `| `room` | what it holds | `room`, `room` |`.
RoomGraph DocumentedGraph(const std::filesystem::path& page);

/// One circle of rooms, "a -> b -> a"; empty if there is none.
std::string FindCircle(const RoomGraph& graph);

/// Rooms that a room uses, directly or not.
std::set<std::string> ReachableFrom(const RoomGraph& graph, const std::string& room);

}  // namespace possibility::house
