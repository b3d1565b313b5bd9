#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "models/input/input_error.h"

namespace possibility::models {

static_assert(std::endian::native == std::endian::little, "files are written as memory has them");

/// Appends the bytes of a number, the lowest first.
template <typename Number>
void AppendLittleEndian(Number number, std::string* bytes) {
  static_assert(std::is_arithmetic_v<Number>);
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  bytes->append(raw, sizeof(Number));
}

/// Reads numbers and bytes one after the other. @throws InputError naming the file beyond the end.
class LittleEndianReader {
 public:
  /// `bytes` must outlive it. `file`: for messages.
  LittleEndianReader(std::string_view bytes, std::string file)
      : bytes_(bytes), file_(std::move(file)) {}

  template <typename Number>
  Number Read() {
    static_assert(std::is_arithmetic_v<Number>);
    Number number;
    std::memcpy(&number, Bytes(sizeof(Number)).data(), sizeof(Number));
    return number;
  }

  std::string_view Bytes(std::size_t count) {
    if (count > bytes_.size()) {
      throw InputError(
          fmt::format("{}: truncated, expected {} bytes more", file_, count - bytes_.size()));
    }
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  void Skip(std::size_t count) { Bytes(count); }
  std::size_t remaining() const { return bytes_.size(); }

 private:
  std::string_view bytes_;
  std::string file_;
};

}  // namespace possibility::models
