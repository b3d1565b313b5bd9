#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "experiments/recording/film.h"
#include "experiments/recording/headless_browser.h"

namespace possibility::experiments {

struct RecordingSettings {
  int rate = 25;  ///< pictures per second of the film
  PictureSize size;
  std::string link;  ///< parameters of the page's address (docs/viewer.md), without '#'
};

/// Which times of the page a link asks for.
struct RecordedTimes {
  std::optional<double> begin;  ///< s, `t`; the plan's
  std::optional<double> end;    ///< s, `until`; the plan's
  double speed = 1;             ///< `speed`
};

/// @throws InputError naming --link unless the three are numbers, `speed` above 0 and `until` not
/// before `t`.
RecordedTimes ParseTimes(const std::string& link);

/// Shows the page's times one after the other and adds what it shows to a film. `progress(done,
/// all)` counts pictures.
/// @throws InputError if the page has no motion, or what the browser and the film throw.
void RecordPage(std::string_view page, const RecordingSettings& settings, Film* film,
                const std::function<void(int, int)>& progress);

}  // namespace possibility::experiments
