#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "tests/fuzz/mutator.h"

namespace possibility::fuzz {

/// Files of one kind that are spoilt, and what has to cope with them.
struct Subject {
  std::string name;       ///< of the kind
  std::string extension;  ///< ".yaml"
  Syntax syntax = Syntax::kYaml;
  /// The whole text of case `seed` before it is spoilt.
  std::function<std::string(std::uint64_t seed)> text;
  /// Reads the spoilt text and uses what it says. Nothing but InputError may come out.
  std::function<void(std::uint64_t seed, const std::string& text)> use;
  /// Processor time of one case, s.
  double limit_s = 20;
};

/// Uses `count` spoilt texts of a subject, in a process of its own: a signal, a sanitizer's
/// finding, another exception, a message that is not one line or a case that takes too long fails
/// the test and leaves the text in the folder fuzz_failures of the build tree. Then the next case
/// has its turn.
void RunCases(const Subject& subject, std::uint64_t first_seed, int count);

/// The text of one case, as RunCases spoils it.
std::string SpoiltText(const Subject& subject, std::uint64_t seed);

/// Writes a text that failed, and says where.
std::filesystem::path KeepFailure(const std::string& name, std::uint64_t seed,
                                  const std::string& extension, const std::string& text);

}  // namespace possibility::fuzz
