#include "experiments/viewer/viewer_input.h"

#include "actions/plan/plan.h"
#include "models/archive/zip_file.h"
#include "models/input/file_contents.h"
#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

/// Reads on (returns true) until the outermost "format" is found.
class FormatFinder : public nlohmann::json_sax<nlohmann::json> {
 public:
  const std::string& format() const { return format_; }

  bool null() override { return Pass(); }
  bool boolean(bool) override { return Pass(); }
  bool number_integer(number_integer_t) override { return Pass(); }
  bool number_unsigned(number_unsigned_t) override { return Pass(); }
  bool number_float(number_float_t, const string_t&) override { return Pass(); }
  bool binary(binary_t&) override { return Pass(); }
  bool string(string_t& text) override {
    if (is_next_) format_ = text;
    return Pass();
  }
  bool key(string_t& name) override {
    is_next_ = depth_ == 1 && name == "format";
    return true;
  }
  bool start_object(std::size_t) override { return Enter(); }
  bool start_array(std::size_t) override { return Enter(); }
  bool end_object() override { return Leave(); }
  bool end_array() override { return Leave(); }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override {
    return false;
  }

 private:
  bool Pass() const { return !is_next_; }
  bool Enter() {
    ++depth_;
    return Pass();
  }
  bool Leave() {
    --depth_;
    return true;
  }

  int depth_ = 0;
  bool is_next_ = false;  ///< the next value is that of the outermost "format"
  std::string format_;
};

}  // namespace

std::string FormatOf(const std::filesystem::path& file) {
  const std::string text = models::ReadFileContents(file);
  if (models::IsZip(text)) return actions::kPackedPlanFormat;
  FormatFinder finder;
  nlohmann::json::sax_parse(text, &finder);
  return finder.format();
}

}  // namespace possibility::experiments
