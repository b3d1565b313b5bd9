#include "experiments/trials/post_field.h"

#include <fmt/format.h>

#include <cmath>
#include <random>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using models::YamlNode;

/// Uniform numbers, the same on every machine, unlike the standard library's distributions.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : generator_(seed) {}
  double operator()(double low, double high) {
    constexpr double kUnit = 1.0 / (1ULL << 53);
    return low + (high - low) * static_cast<double>(generator_() >> 11) * kUnit;
  }

 private:
  std::mt19937_64 generator_;
};

/// Distance from the nearest lane's centre line. Lanes are `pitch` apart, the first `pitch` / 2
/// from the edge.
double FromLane(double offset, double pitch) {
  return std::abs(std::remainder(offset - pitch / 2, pitch));
}

bool IsClear(const PostField& field, double x, double y, double size) {
  const double half = size / 2;
  if (field.pitch > 0) {
    const double least = field.lane / 2 + half;
    if (FromLane(x - field.x_low, field.pitch) < least) return false;
    if (FromLane(y - field.y_low, field.pitch) < least) return false;
  }
  for (const PostField::Circle& circle : field.clear) {
    // Half the diagonal of a box.
    if (std::hypot(x - circle.x, y - circle.y) < circle.radius + half * M_SQRT2) return false;
  }
  return true;
}

PostField::Circle ReadCircle(const YamlNode& node) {
  const Eigen::Vector3d values = node.Vector3();
  if (values.z() < 0) node.FailExpected("[x, y, radius], a radius of at least 0");
  return {values.x(), values.y(), values.z()};
}

}  // namespace

PostField ReadPostField(const YamlNode& node) {
  node.MapOf({"count", "x", "y", "size", "height", "pitch", "lane", "clear"});
  PostField field;
  field.count = static_cast<int>(node.At("count").Integer(0, kMaxPosts));
  const Eigen::Vector2d x = node.At("x").Interval(), y = node.At("y").Interval();
  const YamlNode size = node.At("size");
  const Eigen::Vector2d sizes = size.Interval();
  if (sizes.x() <= 0) size.FailExpected("widths above 0");
  field.x_low = x.x();
  field.x_high = x.y();
  field.y_low = y.x();
  field.y_high = y.y();
  field.size_low = sizes.x();
  field.size_high = sizes.y();
  field.height = node.At("height").Positive();
  if (const auto pitch = node.Find("pitch")) field.pitch = pitch->Positive();
  if (const auto lane = node.Find("lane")) field.lane = lane->NonNegative();
  if (const auto clear = node.Find("clear")) {
    for (const YamlNode& circle : clear->Items()) field.clear.push_back(ReadCircle(circle));
  }
  return field;
}

std::vector<std::string> PostsOf(const PostField& field, std::uint64_t seed) {
  constexpr int kTriesPerPost = 1000;
  Uniform uniform(seed);
  std::vector<std::string> posts;
  for (int tries = 0; static_cast<int>(posts.size()) < field.count;) {
    const double size = uniform(field.size_low, field.size_high);
    const double x = uniform(field.x_low, field.x_high);
    const double y = uniform(field.y_low, field.y_high);
    if (!IsClear(field, x, y, size)) {
      if (++tries < kTriesPerPost) continue;
      throw InputError(fmt::format(
          "there is no room for {} obstacles beside lanes and clear places", field.count));
    }
    tries = 0;
    const std::size_t number = posts.size() + 1;
    const std::string shape =
        number % 2 == 0
            ? fmt::format("shape: cylinder, radius: {:.4f}, length: {:g}", size / 2, field.height)
            : fmt::format("shape: box, size: [{0:.4f}, {0:.4f}, {1:g}]", size, field.height);
    posts.push_back(fmt::format("{{name: post_{}, {}, position: [{:.4f}, {:.4f}, {:g}]}}", number,
                                shape, x, y, field.height / 2));
  }
  return posts;
}

}  // namespace possibility::experiments
