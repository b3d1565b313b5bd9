#include "experiments/formats/npy_array.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <optional>

#include "models/archive/little_endian.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

using models::AppendLittleEndian;

constexpr std::string_view kMagic("\x93NUMPY", 6);
constexpr std::size_t kAlignment = 64;  // of the data in the file
constexpr std::size_t kMaxElements = 1u << 30;
constexpr std::uint32_t kReplacement = 0xfffd;

[[noreturn]] void FailNpy(const std::string& where, const std::string& what) {
  throw InputError(fmt::format("{}: {}, expected an array of NumPy", where, what));
}

/// The code points of UTF-8; what is malformed becomes U+FFFD.
std::vector<std::uint32_t> CodePoints(const std::string& text) {
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first < 0x80 ? 0 : first < 0xc0 ? -1 : first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
    std::uint32_t point = more <= 0 ? first : first & (0x3f >> more);
    bool valid = more >= 0 && first < 0xf8;
    for (int k = 0; valid && k < more; ++k) {
      valid = i < text.size() && (text[i] & 0xc0) == 0x80;
      if (valid) point = point << 6 | (text[i++] & 0x3f);
    }
    points.push_back(valid ? point : kReplacement);
  }
  return points;
}

void AppendUtf8(std::uint32_t point, std::string* text) {
  if (point < 0x80) {
    *text += static_cast<char>(point);
  } else if (point < 0x800) {
    *text += static_cast<char>(0xc0 | point >> 6);
    *text += static_cast<char>(0x80 | (point & 0x3f));
  } else if (point < 0x10000) {
    *text += static_cast<char>(0xe0 | point >> 12);
    *text += static_cast<char>(0x80 | (point >> 6 & 0x3f));
    *text += static_cast<char>(0x80 | (point & 0x3f));
  } else {
    *text += static_cast<char>(0xf0 | (point >> 18 & 7));
    *text += static_cast<char>(0x80 | (point >> 12 & 0x3f));
    *text += static_cast<char>(0x80 | (point >> 6 & 0x3f));
    *text += static_cast<char>(0x80 | (point & 0x3f));
  }
}

/// The text after "'key':" in a header, which is a literal of Python.
std::string_view Value(std::string_view header, const std::string& key, const std::string& where) {
  const std::size_t place = header.find("'" + key + "'");
  const std::size_t colon = header.find(':', place == std::string_view::npos ? 0 : place);
  if (place == std::string_view::npos || colon == std::string_view::npos) {
    FailNpy(where, fmt::format("no '{}' in its header", key));
  }
  const std::string_view rest = header.substr(colon + 1);
  return rest.substr(std::min(rest.find_first_not_of(' '), rest.size()));
}

std::string TypeOf(std::string_view header, const std::string& where) {
  const std::string_view text = Value(header, "descr", where);
  const std::size_t end = text.find('\'', 1);
  if (text.empty() || text[0] != '\'' || end == std::string_view::npos) {
    FailNpy(where, "a compound type");
  }
  return std::string(text.substr(1, end - 1));
}

std::vector<std::size_t> ShapeOf(std::string_view header, const std::string& where) {
  const std::string_view text = Value(header, "shape", where);
  const std::size_t end = text.find(')');
  if (text.empty() || text[0] != '(' || end == std::string_view::npos) {
    FailNpy(where, "a shape that is no tuple");
  }
  std::vector<std::size_t> shape;
  std::size_t elements = 1;
  for (const char* place = text.data() + 1; place < text.data() + end;) {
    std::size_t extent = 0;
    const auto [next, error] = std::from_chars(place, text.data() + end, extent);
    if (error == std::errc()) {
      if (extent > 0 && elements > kMaxElements / extent) FailNpy(where, "too large");
      elements *= extent;
      shape.push_back(extent);
    } else if (*place != ',' && *place != ' ') {
      FailNpy(where, "a shape that is no tuple of numbers");
    }
    place = error == std::errc() ? next : place + 1;
  }
  return shape;
}

/// Bytes of an element; none for types that are not read.
std::optional<std::size_t> ItemSize(const std::string& type) {
  if (type.size() < 3 || (type[0] != '<' && type[0] != '|')) return std::nullopt;
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(type.data() + 2, type.data() + type.size(), count);
  if (error != std::errc() || end != type.data() + type.size()) return std::nullopt;
  if (type[1] == 'U') return count <= kMaxElements ? std::optional(4 * count) : std::nullopt;
  const bool is_float = type[1] == 'f' && (count == 4 || count == 8);
  const bool is_whole =
      (type[1] == 'i' || type[1] == 'u') && (count == 1 || count == 2 || count == 4 || count == 8);
  return is_float || is_whole || type == "|b1" ? std::optional(count) : std::nullopt;
}

template <typename Number>
std::vector<double> As(const NpyArray& array) {
  std::vector<double> numbers(array.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    Number number;
    std::memcpy(&number, array.bytes.data() + i * sizeof(Number), sizeof(Number));
    numbers[i] = static_cast<double>(number);
  }
  return numbers;
}

std::vector<double> InFileOrder(const NpyArray& array, const std::string& where) {
  const std::string kind = array.type.substr(1);
  if (kind == "f8") return As<double>(array);
  if (kind == "f4") return As<float>(array);
  if (kind == "i8") return As<std::int64_t>(array);
  if (kind == "i4") return As<std::int32_t>(array);
  if (kind == "i2") return As<std::int16_t>(array);
  if (kind == "i1") return As<std::int8_t>(array);
  if (kind == "u8") return As<std::uint64_t>(array);
  if (kind == "u4") return As<std::uint32_t>(array);
  if (kind == "u2") return As<std::uint16_t>(array);
  if (kind == "u1" || kind == "b1") return As<std::uint8_t>(array);
  throw InputError(fmt::format("{}: type '{}', expected numbers", where, array.type));
}

/// Index in Fortran order of the element with index `i` in C order.
std::size_t FortranIndex(const std::vector<std::size_t>& shape, std::size_t i) {
  std::size_t index = 0;
  std::size_t stride = 1;
  for (const std::size_t extent : shape) stride *= extent;
  for (auto extent = shape.rbegin(); extent != shape.rend(); ++extent) {
    stride /= *extent;
    index += (i % *extent) * stride;
    i /= *extent;
  }
  return index;
}

}  // namespace

std::size_t NpyArray::size() const {
  std::size_t count = 1;
  for (const std::size_t extent : shape) count *= extent;
  return count;
}

NpyArray EmptyRows(const std::string& type, const std::vector<std::size_t>& row) {
  NpyArray array;
  array.type = type;
  array.shape = {0};
  array.shape.insert(array.shape.end(), row.begin(), row.end());
  return array;
}

void AppendRow(std::string_view bytes, NpyArray* array) {
  array->bytes += bytes;
  ++array->shape[0];
}

void AppendRow(const Eigen::Ref<const Eigen::VectorXd>& numbers, NpyArray* array) {
  AppendRow(std::string_view(reinterpret_cast<const char*>(numbers.data()),
                             sizeof(double) * numbers.size()),
            array);
}

NpyArray TextArray(const std::vector<std::string>& texts, bool is_scalar) {
  std::vector<std::vector<std::uint32_t>> points;
  std::size_t longest = 1;
  for (const std::string& text : texts) {
    points.push_back(CodePoints(text));
    longest = std::max(longest, points.back().size());
  }
  NpyArray array;
  array.type = fmt::format("<U{}", longest);
  if (!is_scalar) array.shape = {texts.size()};
  for (std::vector<std::uint32_t>& text : points) {
    text.resize(longest, 0);
    for (const std::uint32_t point : text) AppendLittleEndian(point, &array.bytes);
  }
  return array;
}

NpyArray DoubleArray(const Eigen::VectorXd& numbers) {
  NpyArray array;
  array.type = "<f8";
  array.shape = {static_cast<std::size_t>(numbers.size())};
  for (const double number : numbers) AppendLittleEndian(number, &array.bytes);
  return array;
}

std::string NpyFile(const NpyArray& array) {
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': ({}{}), }}", array.type,
                  array.is_fortran ? "True" : "False", fmt::join(array.shape, ", "),
                  array.shape.size() == 1 ? "," : "");
  const std::size_t begin = kMagic.size() + 4;  // version and the header's length
  header.append(kAlignment - (begin + header.size() + 1) % kAlignment, ' ');
  header += '\n';
  std::string file(kMagic);
  file += std::string("\x01\x00", 2);
  AppendLittleEndian(static_cast<std::uint16_t>(header.size()), &file);
  return file + header + array.bytes;
}

NpyArray ReadNpy(std::string_view bytes, const std::string& where) {
  models::LittleEndianReader reader(bytes, where);
  if (!bytes.starts_with(kMagic)) FailNpy(where, "no .npy file");
  reader.Skip(kMagic.size());
  const int version = reader.Read<std::uint8_t>();
  reader.Skip(1);
  const std::string_view header =
      reader.Bytes(version == 1 ? reader.Read<std::uint16_t>() : reader.Read<std::uint32_t>());
  NpyArray array;
  array.type = TypeOf(header, where);
  array.is_fortran = Value(header, "fortran_order", where).starts_with("True");
  array.shape = ShapeOf(header, where);
  const std::optional<std::size_t> item = ItemSize(array.type);
  if (!item) FailNpy(where, fmt::format("elements of type '{}'", array.type));
  if (*item > 0 && array.size() > reader.remaining() / *item) FailNpy(where, "truncated");
  array.bytes = reader.Bytes(*item * array.size());
  return array;
}

std::vector<double> Numbers(const NpyArray& array, const std::string& where) {
  std::vector<double> numbers = InFileOrder(array, where);
  if (!array.is_fortran || array.shape.size() < 2) return numbers;
  std::vector<double> ordered(numbers.size());
  for (std::size_t i = 0; i < ordered.size(); ++i) {
    ordered[i] = numbers[FortranIndex(array.shape, i)];
  }
  return ordered;
}

std::vector<std::string> Texts(const NpyArray& array, const std::string& where) {
  if (!array.type.starts_with("<U")) {
    throw InputError(fmt::format("{}: type '{}', expected text", where, array.type));
  }
  const std::size_t length = array.size() == 0 ? 0 : array.bytes.size() / array.size() / 4;
  std::vector<std::string> texts(array.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    for (std::size_t k = 0; k < length; ++k) {
      std::uint32_t point = 0;
      std::memcpy(&point, array.bytes.data() + 4 * (i * length + k), 4);
      if (point == 0) break;
      AppendUtf8(point, &texts[i]);
    }
  }
  return texts;
}

}  // namespace possibility::experiments
