#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/input/json_text.h"

namespace possibility::experiments {

/// Storage of long lists of numbers in the page.

/// Base64 of little-endian 32-bit numbers.
std::string Packed(const std::vector<float>& numbers);
std::string Packed(const std::vector<std::int32_t>& numbers);

void Append(const Eigen::Ref<const Eigen::VectorXd>& values, std::vector<float>* numbers);

/// Table of courses, each a quantity over a phase. Each distinct course is stored once, because
/// strides repeat and most joints rest.
class CourseTable {
 public:
  /// The index of a course; a constant course (also of NaN) is stored as a single number.
  std::int32_t IndexOf(const std::vector<float>& course);

  /// {"begins": base64 of 32-bit integers, "numbers": base64 of floats}: course i is the numbers
  /// from begins[i] to before begins[i + 1].
  nlohmann::ordered_json ToJson() const;

 private:
  std::map<std::string, std::int32_t> indices_;  ///< by the bytes of the course
  std::vector<std::int32_t> begins_ = {0};
  std::vector<float> numbers_;
};

}  // namespace possibility::experiments
