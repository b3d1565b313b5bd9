#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>

namespace possibility::models {

struct PngSize {
  std::size_t rows = 0;
  std::size_t columns = 0;
};

/// @throws InputError unless the bytes begin like a PNG of plain grey values of 8 or 16 bits.
PngSize SizeOfPng(const std::string& bytes, const std::filesystem::path& file);

/// The values as they are stored, 0 to 255 or 0 to 65535, whatever gamma the file names.
/// @throws InputError as SizeOfPng, and for spoilt data.
Eigen::MatrixXd GreyValuesOfPng(const std::string& bytes, const std::filesystem::path& file);

}  // namespace possibility::models
