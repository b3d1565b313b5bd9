#include "models/facts/contact_points.h"

#include <tinyxml2.h>

#include <vector>

namespace possibility::models {
namespace {

using tinyxml2::XMLElement;

bool IsPoint(const XMLElement& collision) {
  const XMLElement* geometry = collision.FirstChildElement("geometry");
  const XMLElement* sphere = geometry ? geometry->FirstChildElement("sphere") : nullptr;
  double radius = 1;
  return sphere && sphere->QueryDoubleAttribute("radius", &radius) == tinyxml2::XML_SUCCESS &&
         radius == 0;
}

std::vector<XMLElement*> PointsOf(XMLElement* link) {
  std::vector<XMLElement*> points;
  for (XMLElement* collision = link->FirstChildElement("collision"); collision;
       collision = collision->NextSiblingElement("collision")) {
    if (IsPoint(*collision)) points.push_back(collision);
  }
  return points;
}

}  // namespace

UrdfWithoutPoints WithoutPoints(const std::string& urdf) {
  UrdfWithoutPoints result{urdf, {}};
  tinyxml2::XMLDocument document;
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) return result;
  XMLElement* robot = document.RootElement();
  if (!robot) return result;
  for (XMLElement* link = robot->FirstChildElement("link"); link;
       link = link->NextSiblingElement("link")) {
    const std::vector<XMLElement*> points = PointsOf(link);
    if (points.empty()) continue;
    const char* name = link->Attribute("name");
    result.points[name ? name : ""] += static_cast<int>(points.size());
    for (XMLElement* point : points) link->DeleteChild(point);
  }
  if (result.points.empty()) return result;
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  result.urdf = printer.CStr();
  return result;
}

}  // namespace possibility::models
