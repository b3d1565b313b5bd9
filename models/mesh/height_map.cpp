#include "models/mesh/height_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/mesh/file_error.h"
#include "models/mesh/png_heights.h"

namespace possibility::models {
namespace {

/// Heights beyond this are typing errors, as in YAML.
constexpr double kHighest = 1e6;

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::string Printable(std::string_view text) {
  std::string shown(text.substr(0, 30));
  for (char& c : shown) {
    if (const auto u = static_cast<unsigned char>(c); u < 0x20 || u >= 0x7f) c = ' ';
  }
  return shown;
}

void CheckSize(std::size_t rows, std::size_t columns, const std::filesystem::path& file) {
  if (rows < 2 || columns < 2) {
    FailAt(file, fmt::format("expected at least 2 rows of 2 heights, got {} x {}", rows, columns));
  }
  if (rows > kMostSamples / columns) {
    FailAt(file,
           fmt::format("expected at most {} heights, got {} x {}", kMostSamples, rows, columns));
  }
}

double ParseHeight(std::string_view text, int line, const std::filesystem::path& file) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  double height = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), height);
  const bool is_number = error == std::errc() && end == digits.data() + digits.size();
  if (!is_number || !(std::abs(height) <= kHighest)) {
    throw InputError(
        fmt::format("{}:{}: expected a height, got '{}'", file.string(), line, Printable(text)));
  }
  return height;
}

Eigen::MatrixXd ParseCsv(std::string_view text, const std::filesystem::path& file) {
  std::vector<double> heights;
  std::size_t rows = 0, columns = 0;
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t stop = std::min(text.find('\n'), text.size());
    const std::string_view line = Trimmed(text.substr(0, stop));
    text.remove_prefix(std::min(stop + 1, text.size()));
    if (line.empty()) {
      if (!Trimmed(text.substr(0, text.find_last_not_of(" \t\r\n") + 1)).empty()) {
        throw InputError(
            fmt::format("{}:{}: expected heights, got an empty line", file.string(), number));
      }
      break;
    }
    std::size_t count = 0;
    for (std::size_t begin = 0; begin <= line.size(); ++count) {
      const std::size_t comma = std::min(line.find(',', begin), line.size());
      heights.push_back(ParseHeight(Trimmed(line.substr(begin, comma - begin)), number, file));
      begin = comma + 1;
    }
    if (rows == 0) columns = count;
    if (count != columns) {
      throw InputError(fmt::format("{}:{}: has {} heights, expected {} as in the first row",
                                   file.string(), number, count, columns));
    }
    ++rows;
  }
  CheckSize(rows, columns, file);
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(heights.data(), static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(columns));
}

std::string EndingInSmallLetters(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending;
}

std::string EndingOfMap(const std::filesystem::path& file) {
  std::string ending = EndingInSmallLetters(file);
  if (ending != ".png" && ending != ".csv") {
    FailAt(file, "expected a height map whose name ends in .png or .csv");
  }
  return ending;
}

}  // namespace

bool EndsInPng(const std::filesystem::path& file) { return EndingInSmallLetters(file) == ".png"; }

Eigen::MatrixXd ReadHeights(const std::filesystem::path& file) {
  EndingOfMap(file);
  return ParseHeights(ReadFileContents(file), file);
}

Eigen::MatrixXd ParseHeights(const std::string& bytes, const std::filesystem::path& file) {
  if (EndingOfMap(file) == ".csv") return ParseCsv(bytes, file);
  const PngSize size = SizeOfPng(bytes, file);
  CheckSize(size.rows, size.columns, file);
  return GreyValuesOfPng(bytes, file);
}

TriangleMesh MeshOfHeights(const Eigen::MatrixXd& heights, double cell) {
  TriangleMesh mesh;
  const auto rows = static_cast<int>(heights.rows());
  const auto columns = static_cast<int>(heights.cols());
  mesh.vertices.reserve(heights.size());
  mesh.triangles.reserve(2 * static_cast<std::size_t>(heights.size()));
  // From the bottom row up.
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      mesh.vertices.emplace_back(column * cell, row * cell, heights(rows - 1 - row, column));
    }
  }
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int a = row * columns + column, b = a + 1, c = b + columns, d = a + columns;
      const auto z = [&](int vertex) { return mesh.vertices[vertex].z(); };
      if (std::abs(z(a) - z(c)) <= std::abs(z(b) - z(d))) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({b, c, d});
      }
    }
  }
  return mesh;
}

}  // namespace possibility::models
