#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

namespace possibility::models::testing {

inline std::uint32_t PngChecksum(const std::string& bytes) {
  std::uint32_t sum = 0xffffffffu;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum % 2 == 1 ? 0xedb88320u : 0u);
  }
  return ~sum;
}

/// Highest byte first.
inline std::string BigEndian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
  return bytes;
}

inline std::string PngChunk(const std::string& kind, const std::string& data) {
  return BigEndian(static_cast<std::uint32_t>(data.size())) + kind + data +
         BigEndian(PngChecksum(kind + data));
}

/// A PNG of the format's plainest kind: one uncompressed block. `colour`: 0 grey, 2 red, green and
/// blue, 3 a palette, 4 grey with transparency; every channel has the value.
inline std::string PngOf(const Eigen::MatrixXd& values, int depth, int colour) {
  const int channels = colour == 2 ? 3 : colour == 4 ? 2 : 1;
  std::string rows;
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    rows += '\0';
    std::string bits;
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      const auto value = static_cast<unsigned>(std::lround(values(row, column)));
      for (int i = 0; i < channels; ++i) {
        for (int bit = depth - 1; bit >= 0; --bit) bits += (value >> bit & 1) == 1 ? '1' : '0';
      }
    }
    bits.resize((bits.size() + 7) / 8 * 8, '0');
    for (std::size_t i = 0; i < bits.size(); i += 8) {
      rows += static_cast<char>(std::stoi(bits.substr(i, 8), nullptr, 2));
    }
  }
  std::uint32_t a = 1, b = 0;
  for (const char c : rows) {
    a = (a + static_cast<unsigned char>(c)) % 65521;
    b = (b + a) % 65521;
  }
  const auto length = static_cast<std::uint16_t>(rows.size());
  const auto low_first = [](std::uint16_t n) {
    return std::string{static_cast<char>(n & 0xff), static_cast<char>(n >> 8)};
  };
  const std::string packed = std::string("\x78\x01\x01", 3) + low_first(length) +
                             low_first(static_cast<std::uint16_t>(~length)) + rows +
                             BigEndian(b << 16 | a);
  std::string head = BigEndian(static_cast<std::uint32_t>(values.cols())) +
                     BigEndian(static_cast<std::uint32_t>(values.rows()));
  head += static_cast<char>(depth);
  head += static_cast<char>(colour);
  head += std::string(3, '\0');
  return "\x89PNG\r\n\x1a\n" + PngChunk("IHDR", head) +
         (colour == 3 ? PngChunk("PLTE", std::string(3 * 16, '\1')) : std::string()) +
         PngChunk("IDAT", packed) + PngChunk("IEND", "");
}

}  // namespace possibility::models::testing
