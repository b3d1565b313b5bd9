#pragma once

#include <string_view>

/// The files under experiments/viewer/ and the three.js library, as they were at build time
/// (experiments/viewer/embed.cmake writes the definitions).
namespace possibility::experiments::viewer_resources {

extern const std::string_view page;
extern const std::string_view style;
extern const std::string_view scripts;  ///< all *.js, one after the other
extern const std::string_view three;
extern const std::string_view convex_hull;
extern const std::string_view convex_geometry;
extern const std::string_view orbit_controls;

}  // namespace possibility::experiments::viewer_resources
