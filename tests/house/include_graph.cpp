#include "tests/house/include_graph.h"

#include <fstream>
#include <functional>
#include <regex>
#include <sstream>
#include <vector>

namespace possibility::house {
namespace {

namespace fs = std::filesystem;

const char* const kFloors[] = {"common", "models",  "dynamics",    "collocation",
                               "graph",  "actions", "experiments", "python"};

std::string TextOf(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> Matches(const std::string& text, const std::regex& pattern) {
  std::vector<std::string> found;
  for (std::sregex_iterator i(text.begin(), text.end(), pattern), end; i != end; ++i) {
    found.push_back((*i)[1]);
  }
  return found;
}

}  // namespace

RoomGraph IncludeGraph(const fs::path& root) {
  static const std::regex kInclude("#include \"([^\"]+)/[^/\"]+\"");
  RoomGraph graph;
  for (const char* floor : kFloors) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / floor)) {
      const std::string kind = entry.path().extension();
      if (kind != ".h" && kind != ".cpp") continue;
      const std::string room = fs::relative(entry.path().parent_path(), root);
      std::set<std::string>& used = graph[room];
      for (const std::string& folder : Matches(TextOf(entry.path()), kInclude)) {
        if (folder != room) used.insert(folder);
      }
    }
  }
  return graph;
}

RoomGraph DocumentedGraph(const fs::path& page) {
  static const std::regex kRoom("`([a-z]+(?:/[a-z]+)?)`");
  RoomGraph graph;
  std::istringstream lines(TextOf(page));
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, '|');) cells.push_back(cell);
    if (cells.size() != 4) continue;
    const std::vector<std::string> room = Matches(cells[1], kRoom);
    if (room.size() != 1) continue;
    const std::vector<std::string> used = Matches(cells[3], kRoom);
    graph[room.front()] = {used.begin(), used.end()};
  }
  return graph;
}

std::string FindCircle(const RoomGraph& graph) {
  std::set<std::string> done;
  std::vector<std::string> path;
  const std::function<std::string(const std::string&)> visit = [&](const std::string& room) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (path[i] != room) continue;
      std::string circle;
      for (; i < path.size(); ++i) circle += path[i] + " -> ";
      return circle + room;
    }
    if (!done.insert(room).second) return std::string();
    path.push_back(room);
    if (const auto found = graph.find(room); found != graph.end()) {
      for (const std::string& used : found->second) {
        if (const std::string circle = visit(used); !circle.empty()) return circle;
      }
    }
    path.pop_back();
    return std::string();
  };
  for (const auto& [room, used] : graph) {
    if (const std::string circle = visit(room); !circle.empty()) return circle;
  }
  return {};
}

std::set<std::string> ReachableFrom(const RoomGraph& graph, const std::string& room) {
  std::set<std::string> reached;
  const std::function<void(const std::string&)> visit = [&](const std::string& from) {
    const auto found = graph.find(from);
    if (found == graph.end()) return;
    for (const std::string& used : found->second) {
      if (reached.insert(used).second) visit(used);
    }
  };
  visit(room);
  return reached;
}

}  // namespace possibility::house
