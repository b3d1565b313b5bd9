#include "experiments/viewer/viewer_packing.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "experiments/support/base64.h"

namespace possibility::experiments {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename Number>
std::string Bytes(const std::vector<Number>& numbers) {
  return Base64({reinterpret_cast<const char*>(numbers.data()), sizeof(Number) * numbers.size()});
}

}  // namespace

std::string Packed(const std::vector<float>& numbers) { return Bytes(numbers); }
std::string Packed(const std::vector<std::int32_t>& numbers) { return Bytes(numbers); }

void Append(const Eigen::Ref<const Eigen::VectorXd>& values, std::vector<float>* numbers) {
  for (const double value : values) numbers->push_back(static_cast<float>(value));
}

std::int32_t CourseTable::IndexOf(const std::vector<float>& course) {
  const auto same = [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  const bool stays = std::equal(course.begin() + 1, course.end(), course.begin(), same);
  const std::size_t size = stays ? 1 : course.size();
  const std::string bytes(reinterpret_cast<const char*>(course.data()), sizeof(float) * size);
  const auto index = static_cast<std::int32_t>(indices_.size());
  const auto [found, is_new] = indices_.emplace(bytes, index);
  if (is_new) {
    numbers_.insert(numbers_.end(), course.begin(), course.begin() + size);
    begins_.push_back(static_cast<std::int32_t>(numbers_.size()));
  }
  return found->second;
}

nlohmann::ordered_json CourseTable::ToJson() const {
  return {{"begins", Packed(begins_)}, {"numbers", Packed(numbers_)}};
}

}  // namespace possibility::experiments
