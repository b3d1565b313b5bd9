#include "collocation/study/conflict_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace possibility::collocation {
namespace {

std::string TextOf(const ConflictMember& member, const Transcription& program) {
  if (member.kind == ConflictMember::Kind::kRow) return program.ConstraintGroup(member.index);
  const double scale = program.VariableScale(member.index);
  const std::string name = program.VariableGroup(member.index);
  switch (member.kind) {
    case ConflictMember::Kind::kLower:
      return fmt::format("{} is at least {:.6g}", name, scale * program.lower()[member.index]);
    case ConflictMember::Kind::kUpper:
      return fmt::format("{} is at most {:.6g}", name, scale * program.upper()[member.index]);
    default:
      return fmt::format("{} is fixed at {:.6g}", name, scale * program.lower()[member.index]);
  }
}

}  // namespace

std::vector<std::string> Describe(const Conflict& conflict, const Transcription& program) {
  std::vector<std::pair<std::string, int>> counts;
  for (const ConflictMember& member : conflict.members) {
    const std::string text = TextOf(member, program);
    const auto known = std::find_if(counts.begin(), counts.end(),
                                    [&text](const auto& count) { return count.first == text; });
    if (known == counts.end()) {
      counts.emplace_back(text, 1);
    } else {
      ++known->second;
    }
  }
  std::vector<std::string> lines;
  lines.reserve(counts.size());
  for (const auto& [text, count] : counts) {
    lines.push_back(count == 1 ? text : fmt::format("{} ({} points)", text, count));
  }
  return lines;
}

}  // namespace possibility::collocation
