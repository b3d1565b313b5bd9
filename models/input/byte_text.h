#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace possibility::models {

/// Strings numbers together byte for byte, as a key of exact equality within one process.
class ByteText {
 public:
  template <typename Number>
  requires std::is_arithmetic_v<Number> ByteText& Add(Number number) {
    text_.append(reinterpret_cast<const char*>(&number), sizeof(number));
    return *this;
  }

  /// Of a vector or matrix: its size, then its numbers by column.
  template <typename Derived>
  ByteText& Add(const Eigen::PlainObjectBase<Derived>& matrix) {
    Add(matrix.rows()).Add(matrix.cols());
    const auto size = static_cast<std::size_t>(matrix.size());
    text_.append(reinterpret_cast<const char*>(matrix.data()),
                 size * sizeof(typename Derived::Scalar));
    return *this;
  }

  /// Its length, then its bytes.
  ByteText& Add(std::string_view words) {
    Add(words.size());
    text_.append(words);
    return *this;
  }

  const std::string& text() const { return text_; }
  std::string Take() { return std::move(text_); }

 private:
  std::string text_;
};

}  // namespace possibility::models
