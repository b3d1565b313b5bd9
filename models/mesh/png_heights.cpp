#include "models/mesh/png_heights.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include "models/input/input_error.h"

namespace possibility::models {
namespace {

constexpr std::size_t kSignature = 8;  // bytes

/// Bytes that are left, and what went wrong.
struct Source {
  const char* next = nullptr;
  std::size_t left = 0;
  char error[128] = {};
};

void TakeBytes(png_structp png, png_bytep to, png_size_t count) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "it ends too early");
  std::memcpy(to, source->next, count);
  source->next += count;
  source->left -= count;
}

/// libpng's errors do not return; they go back to where setjmp was called.
void OnError(png_structp png, png_const_charp message) {
  auto* source = static_cast<Source*>(png_get_error_ptr(png));
  std::snprintf(source->error, sizeof(source->error), "%s", message);
  png_longjmp(png, 1);
}

void OnWarning(png_structp, png_const_charp) {}

/// A PNG being read. No function that calls libpng makes objects with destructors, because its
/// errors jump over them.
class PngReader {
 public:
  PngReader(const std::string& bytes, const std::filesystem::path& file) : file_(file) {
    if (bytes.size() < kSignature ||
        png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, kSignature) != 0) {
      Fail("it does not begin like one");
    }
    source_.next = bytes.data();
    source_.left = bytes.size();
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &source_, &OnError, &OnWarning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      Fail("out of memory");
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  void ReadHeader() {
    if (!ReadsHeader()) Fail(source_.error);
    const int colour = png_get_color_type(png_, info_);
    if (colour != PNG_COLOR_TYPE_GRAY) {
      const char* what = (colour & PNG_COLOR_MASK_PALETTE) != 0 ? "a palette"
                         : (colour & PNG_COLOR_MASK_COLOR) != 0 ? "colours"
                                                                : "transparency";
      throw InputError(
          fmt::format("{}: has {}, expected a picture of grey values only", file_.string(), what));
    }
    if (depth() != 8 && depth() != 16) {
      throw InputError(
          fmt::format("{}: has {} bits a sample, expected 8 or 16", file_.string(), depth()));
    }
  }

  std::size_t rows() const { return png_get_image_height(png_, info_); }
  std::size_t columns() const { return png_get_image_width(png_, info_); }
  int depth() const { return png_get_bit_depth(png_, info_); }

  /// All rows, with the high byte first.
  std::vector<unsigned char> ReadSamples() {
    const std::size_t stride = columns() * static_cast<std::size_t>(depth() / 8);
    std::vector<unsigned char> samples(stride * rows());
    std::vector<png_bytep> row_starts(rows());
    for (std::size_t row = 0; row < rows(); ++row) row_starts[row] = samples.data() + row * stride;
    if (!ReadsImage(row_starts.data())) Fail(source_.error);
    return samples;
  }

 private:
  bool ReadsHeader() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_read_fn(png_, &source_, &TakeBytes);
    png_read_info(png_, info_);
    return true;
  }

  bool ReadsImage(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  [[noreturn]] void Fail(const char* why) const {
    throw InputError(fmt::format("{}: not a valid PNG: {}", file_.string(), why));
  }

  const std::filesystem::path& file_;
  Source source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

PngSize SizeOfPng(const std::string& bytes, const std::filesystem::path& file) {
  PngReader reader(bytes, file);
  reader.ReadHeader();
  return {reader.rows(), reader.columns()};
}

Eigen::MatrixXd GreyValuesOfPng(const std::string& bytes, const std::filesystem::path& file) {
  PngReader reader(bytes, file);
  reader.ReadHeader();
  const std::vector<unsigned char> samples = reader.ReadSamples();
  const std::size_t bytes_each = reader.depth() / 8;
  Eigen::MatrixXd values(reader.rows(), reader.columns());
  std::size_t at = 0;
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      unsigned value = 0;
      for (std::size_t i = 0; i < bytes_each; ++i) value = 256 * value + samples[at++];
      values(row, column) = value;
    }
  }
  return values;
}

}  // namespace possibility::models
