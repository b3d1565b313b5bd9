#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace possibility::experiments::testing {

/// The data that a viewer page holds.
inline nlohmann::json EmbeddedData(const std::string& page) {
  const std::string opening = "<script type=\"application/json\" id=\"plan-data\">";
  const std::size_t begin = page.find(opening) + opening.size();
  return nlohmann::json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// Little-endian numbers out of base64.
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

/// A table of the page: {"steps", "data"}, row by row.
inline std::vector<double> UnpackedTable(const nlohmann::json& table) {
  const std::vector<double> steps = table["steps"];
  std::vector<double> numbers;
  for (const std::int16_t integer : Unpacked<std::int16_t>(table["data"])) {
    numbers.push_back(integer * steps[numbers.size() % steps.size()]);
  }
  return numbers;
}

}  // namespace possibility::experiments::testing
