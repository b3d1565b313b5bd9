#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace possibility::experiments::testing {

/// Adds to every phase where it begins in PageMotion's tables: "first" (knot) and "forces".
inline void AddPlaces(nlohmann::json* data) {
  int first = 0;
  int forces = 0;
  for (auto& segment : (*data)["segments"]) {
    for (auto& phase : segment["phases"]) {
      phase["first"] = first;
      phase["forces"] = forces;
      const int count = phase["count"];
      first += count;
      for (const auto& points : phase["points"])
        forces += 3 * count * static_cast<int>(points.size());
    }
  }
}

/// The data inside a viewer page, with places.
inline nlohmann::json EmbeddedData(const std::string& page) {
  const std::string opening = "<script type=\"application/json\" id=\"plan-data\">";
  const std::size_t begin = page.find(opening) + opening.size();
  nlohmann::json data =
      nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  AddPlaces(&data);
  return data;
}

/// Little-endian numbers decoded from base64.
template <typename Number>
std::vector<Number> Unpacked(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int count = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    bits = bits << 6 | static_cast<unsigned>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

/// The numbers of all knots of a page's motion, knot by knot, as
/// experiments/viewer/page/kinematics.js reads them.
struct PageMotion {
  explicit PageMotion(const nlohmann::json& data) : num_joints(data["joints"].size()) {
    const auto begins = Unpacked<std::int32_t>(data["courses"]["begins"]);
    const auto numbers = Unpacked<float>(data["courses"]["numbers"]);
    const auto indices = Unpacked<std::int32_t>(data["indices"]);
    std::size_t next = 0;
    for (const auto& segment : data["segments"]) {
      for (const auto& phase : segment["phases"]) {
        const std::size_t count = phase["count"];
        std::size_t num_forces = 0;
        for (const auto& points : phase["points"]) num_forces += 3 * points.size();
        const auto read = [&](std::size_t columns, std::vector<float>* table) {
          const std::size_t first = table->size();
          table->resize(first + count * columns);
          for (std::size_t i = 0; i < columns; ++i, ++next) {
            const std::int32_t begin = begins.at(indices.at(next));
            const bool stays = begins.at(indices[next] + 1) == begin + 1;
            for (std::size_t k = 0; k < count; ++k) {
              (*table)[first + k * columns + i] = numbers.at(begin + (stays ? 0 : k));
            }
          }
        };
        read(8 + num_joints, &knots);
        read(3, &centres);
        read(6, &momenta);
        read(num_joints, &rates);
        read(num_joints, &torques);
        read(6, &balance);
        read(7, &margins);
        read(num_forces, &forces);
      }
    }
  }

  std::size_t num_joints;
  std::vector<float> knots;  ///< t, q
  std::vector<float> centres, momenta, rates, torques, forces;
  std::vector<float> balance;  ///< zero moment point, its margin, capture point in the plane
  std::vector<float> margins;  ///< in the order of FrameMargins::Numbers
};

}  // namespace possibility::experiments::testing
