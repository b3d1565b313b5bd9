#pragma once

#include <string_view>

/// The files under experiments/viewer/ and the three.js library, as they were at build time
/// (experiments/viewer/embed.cmake writes the definitions).
namespace possibility::experiments::viewer_resources {

extern const std::string_view page;
extern const std::string_view style;
extern const std::string_view kinematics;
extern const std::string_view barrier;
extern const std::string_view drawing;
extern const std::string_view jumps;
extern const std::string_view balance;
extern const std::string_view timeline;
extern const std::string_view curves;
extern const std::string_view plots;
extern const std::string_view player;
extern const std::string_view three;
extern const std::string_view convex_hull;
extern const std::string_view convex_geometry;
extern const std::string_view orbit_controls;

}  // namespace possibility::experiments::viewer_resources
