#include "experiments/viewer_packing.h"

#include <bit>
#include <cmath>
#include <cstdint>

#include "experiments/base64.h"

namespace possibility::experiments {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr double kMostSteps = 32767;

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

void QuantisedTable::Add(const Eigen::Ref<const Eigen::VectorXd>& row) { rows_.emplace_back(row); }

nlohmann::ordered_json QuantisedTable::ToJson() const {
  Eigen::VectorXd greatest;
  if (!rows_.empty()) greatest.setZero(rows_.front().size());
  for (const Eigen::VectorXd& row : rows_) greatest = greatest.cwiseMax(row.cwiseAbs());
  nlohmann::ordered_json steps = nlohmann::ordered_json::array();
  for (double& step : greatest) {
    step /= kMostSteps;
    steps.push_back(step);
  }
  std::vector<std::int16_t> integers;
  for (const Eigen::VectorXd& row : rows_) {
    for (Eigen::Index i = 0; i < row.size(); ++i) {
      const double count = greatest[i] > 0 ? std::round(row[i] / greatest[i]) : 0;
      integers.push_back(static_cast<std::int16_t>(count));
    }
  }
  return {{"steps", steps}, {"data", Bytes(integers)}};
}

}  // namespace possibility::experiments
