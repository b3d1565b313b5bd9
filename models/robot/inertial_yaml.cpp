#include "models/robot/inertial_yaml.h"

#include <fmt/format.h>

#include <set>

#include "models/input/named_lookup.h"

namespace possibility::models {

void ReadInertials(const YamlNode& list, UrdfTree* tree) {
  std::set<int> seen;
  for (const YamlNode& node : list.Items()) {
    node.MapOf({"link", "mass", "com", "moments", "products", "reason"});
    node.At("reason").String();
    const int index = IndexOfNamed(node.At("link"), tree->links, "link");
    UrdfLink& link = tree->links[index];
    if (!seen.insert(index).second) {
      node.At("link").Fail(fmt::format("link '{}' is listed twice", link.name));
    }
    Inertial inertial;
    inertial.mass = node.At("mass").Positive();
    inertial.p_LC = node.At("com").Vector3();
    const Eigen::Vector3d products = node.At("products").Vector3();
    inertial.I_LC = node.At("moments").PositiveVector3().asDiagonal();
    inertial.I_LC(0, 1) = inertial.I_LC(1, 0) = products[0];
    inertial.I_LC(0, 2) = inertial.I_LC(2, 0) = products[1];
    inertial.I_LC(1, 2) = inertial.I_LC(2, 1) = products[2];
    link.inertial = inertial;
  }
}

}  // namespace possibility::models
