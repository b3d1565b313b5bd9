#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "models/input/yaml_reader.h"

namespace possibility::experiments {

/// Upright boxes and posts at random places in a rectangle, outside of clear lanes and circles. The
/// difficulty of crossing the field does not depend on the number of obstacles.
struct PostField {
  struct Circle {
    double x = 0, y = 0, radius = 0;  ///< m
  };
  int count = 0;
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;  ///< m, where obstacles may be
  double size_low = 0, size_high = 0;                   ///< m, widths
  double height = 0;                                    ///< m, above z = 0
  double pitch = 0;  ///< m, distance of lanes along x and along y; 0: no lanes
  double lane = 0;   ///< m, their width
  std::vector<Circle> clear;
};

inline constexpr int kMaxPosts = 1000000;

/// Reads {count, x: [low, high], y: [low, high], size: [low, high], height, pitch, lane, clear:
/// [[x, y, radius]...]}; pitch, lane and clear may be left out.
/// @throws InputError with file and line.
PostField ReadPostField(const models::YamlNode& node);

/// The field as obstacles of a scenario, one YAML flow map each: "{name: post_1, shape: ...}".
/// The same arguments give the same text.
/// @throws InputError if there is not enough room.
std::vector<std::string> PostsOf(const PostField& field, std::uint64_t seed);

}  // namespace possibility::experiments
