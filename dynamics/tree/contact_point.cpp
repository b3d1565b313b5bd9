#include "dynamics/tree/contact_point.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace possibility::dynamics {
namespace {

// Tolerance of a normal's length.
constexpr double kUnit = 1e-9;

}  // namespace

void CheckContactPoints(const char* caller, int num_links,
                        const std::vector<ContactPoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ContactPoint& point = points[i];
    const auto fail = [&](const std::string& what) {
      throw std::invalid_argument(fmt::format("{}: point {} {}", caller, i, what));
    };
    if (point.link < 0 || point.link >= num_links) {
      fail(fmt::format("is on link {}, expected 0 to {}", point.link, num_links - 1));
    }
    if (!point.p_L.allFinite()) fail("has a position that is not finite");
    if (!(std::abs(point.normal_W.norm() - 1) <= kUnit)) {
      fail("has a normal that is no unit vector");
    }
    if (!(point.friction > 0)) {
      fail(fmt::format("has friction {}, expected a positive number", point.friction));
    }
  }
}

}  // namespace possibility::dynamics
