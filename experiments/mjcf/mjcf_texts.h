#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "experiments/mjcf/mjcf_robot.h"

namespace possibility::experiments {

/// The texts of an MJCF file and of the files that it includes. MuJoCo refuses attributes and
/// keywords of later versions; here they are blanked out, so that lines keep their numbers.
class MjcfTexts {
 public:
  /// Files that cannot be read or are no XML are left to MuJoCo.
  explicit MjcfTexts(const std::filesystem::path& file) { Add(file, 0); }

  /// Changes what a message of MuJoCo complains of: blanks what it does not know, and materials
  /// that nothing defines, and says so in `findings`. False if the message is of anything else, or
  /// nothing was found.
  bool Mend(const std::string& message, std::vector<std::string>* findings);

  /// The texts that have changed, by file name without folder.
  std::vector<NamedBytes> Changed() const;

  /// N m or N: what joints bear by their own attribute `actuatorfrcrange`, by name.
  const std::map<std::string, double>& efforts() const { return efforts_; }

 private:
  struct Text {
    std::string name, bytes;
    bool has_changed = false;
  };

  /// Newer versions limit what has a range; older ones want to be told so.
  bool LimitByRanges();
  bool LeaveOutMaterial(const std::string& material, std::vector<std::string>* findings);
  void Add(const std::filesystem::path& file, int depth);

  std::vector<Text> texts_;
  std::map<std::string, double> efforts_;
};

}  // namespace possibility::experiments
