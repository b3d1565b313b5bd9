#include "experiments/recording/page_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr int kMostPictures = 1000000;

std::map<std::string, std::string> ParametersOf(const std::string& link) {
  std::map<std::string, std::string> parameters;
  std::istringstream parts(link);
  for (std::string part; std::getline(parts, part, '&');) {
    const std::size_t equals = part.find('=');
    if (equals != std::string::npos) parameters[part.substr(0, equals)] = part.substr(equals + 1);
  }
  return parameters;
}

std::optional<double> NumberNamed(const std::string& name,
                                  const std::map<std::string, std::string>& parameters) {
  const auto found = parameters.find(name);
  if (found == parameters.end()) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(found->second.c_str(), &end);
  if (found->second.empty() || *end != '\0' || !std::isfinite(number)) {
    throw InputError(fmt::format("--link: {}: expected a number, got '{}'", name, found->second));
  }
  return number;
}

/// The link without what would let the page play by itself.
std::string AddressOf(const std::string& link) {
  std::string address = "#play=0";
  std::istringstream parts(link);
  for (std::string part; std::getline(parts, part, '&');) {
    if (!part.starts_with("play=")) address += "&" + part;
  }
  return address;
}

/// Begin and end of the page's time.
std::pair<double, double> RangeOf(HeadlessBrowser* browser) {
  const auto range = browser->Evaluate(
      "page ? page.moves ? [page.begin, page.end] : 'no motion' : "
      "document.getElementById('message').textContent");
  if (range.is_array()) return {range[0].get<double>(), range[1].get<double>()};
  throw InputError("--record: the page cannot be recorded: " + range.get<std::string>());
}

void ShowTime(double t, HeadlessBrowser* browser) {
  browser->Evaluate(
      fmt::format("new Promise((done) => {{ page.setTime({}); requestAnimationFrame(() => "
                  "requestAnimationFrame(() => done(true))); }})",
                  t));
}

}  // namespace

RecordedTimes ParseTimes(const std::string& link) {
  const auto parameters = ParametersOf(link);
  RecordedTimes times;
  times.begin = NumberNamed("t", parameters);
  times.end = NumberNamed("until", parameters);
  times.speed = NumberNamed("speed", parameters).value_or(1);
  if (!(times.speed > 0)) {
    throw InputError(fmt::format("--link: speed: expected more than 0, got {}", times.speed));
  }
  if (times.begin && times.end && *times.end < *times.begin) {
    throw InputError(
        fmt::format("--link: until: expected at least t={}, got {}", *times.begin, *times.end));
  }
  return times;
}

void RecordPage(std::string_view page, const RecordingSettings& settings, Film* film,
                const std::function<void(int, int)>& progress) {
  const RecordedTimes times = ParseTimes(settings.link);
  HeadlessBrowser browser(settings.size);
  browser.Open(page, AddressOf(settings.link));
  const auto [least, greatest] = RangeOf(&browser);
  const double begin = std::clamp(times.begin.value_or(least), least, greatest);
  const double end = std::clamp(times.end.value_or(greatest), begin, greatest);
  const double step = times.speed / settings.rate;
  const double count = std::floor((end - begin) / step + 1e-9) + 1;
  if (count > kMostPictures) {
    throw InputError(
        fmt::format("--record: {:.0f} pictures, expected at most {}", count, kMostPictures));
  }
  const int all = static_cast<int>(count);
  for (int i = 0; i < all; ++i) {
    ShowTime(begin + i * step, &browser);
    film->Add(browser.Picture());
    progress(i + 1, all);
  }
  film->Finish();
}

}  // namespace possibility::experiments
