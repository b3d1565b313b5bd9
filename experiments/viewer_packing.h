#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace possibility::experiments {

/// Long lists of numbers as the page holds them.

/// Base64 of little-endian 32-bit numbers.
std::string Packed(const std::vector<float>& numbers);
std::string Packed(const std::vector<std::int32_t>& numbers);

void Append(const Eigen::Ref<const Eigen::VectorXd>& values, std::vector<float>* numbers);

/// A table for curves: every column in steps of 1/32767 of its greatest magnitude.
class QuantisedTable {
 public:
  /// All rows have one size; numbers are finite.
  void Add(const Eigen::Ref<const Eigen::VectorXd>& row);
  std::size_t size() const { return rows_.size(); }

  /// {"steps": [one per column], "data": base64 of little-endian 16-bit integers, row by row}: a
  /// number is its integer times its column's step.
  nlohmann::ordered_json ToJson() const;

 private:
  std::vector<Eigen::VectorXd> rows_;
};

}  // namespace possibility::experiments
