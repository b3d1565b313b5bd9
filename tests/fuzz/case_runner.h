#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/fuzz/mutator.h"

namespace possibility::fuzz {

/// Files of one kind that are spoilt, and the code that must handle them.
struct Subject {
  std::string name;       ///< of the kind of file
  std::string extension;  ///< e.g. ".yaml"
  Syntax syntax = Syntax::kYaml;
  /// The whole text of case `seed` before it is spoilt.
  std::function<std::string(std::uint64_t seed)> text;
  /// Reads the spoilt text and uses its contents. It may throw InputError only.
  std::function<void(std::uint64_t seed, const std::string& text)> use;
  /// Processor time of one case, s.
  double limit_s = 20;
};

/// A case that did not end properly.
struct Finding {
  std::uint64_t seed = 0;
  std::string what;  ///< "signal 11", "another exception: ...", ...
};

struct Findings {
  std::vector<Finding> failures;  ///< at most 20
  int used = 0;                   ///< cases whose text was read and used
  int refused = 0;                ///< by InputError
};

/// Uses `count` spoilt texts of a subject, in a process of its own. A failure is a signal, a
/// sanitizer's finding, another exception, a message of more than one line, or a case that takes
/// too long. The next case runs all the same.
Findings FindFailures(const Subject& subject, std::uint64_t first_seed, int count);

/// The same as a test. Failed texts are kept in the folder fuzz_failures of the build tree.
void RunCases(const Subject& subject, std::uint64_t first_seed, int count);

/// The text of one case, as RunCases spoils it.
std::string SpoiltText(const Subject& subject, std::uint64_t seed);

/// Writes a text that failed and returns its path.
std::filesystem::path KeepFailure(const std::string& name, std::uint64_t seed,
                                  const std::string& extension, const std::string& text);

}  // namespace possibility::fuzz
