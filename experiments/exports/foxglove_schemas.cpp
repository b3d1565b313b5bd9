#include "experiments/exports/foxglove_schemas.h"

#include <vector>

#include "models/input/json_text.h"

namespace possibility::experiments {
namespace {

using Json = nlohmann::ordered_json;

Json TypeOf(const char* type) { return {{"type", type}}; }

/// An object whose members are all required.
Json Object(const Json& members) {
  Json names = Json::array();
  for (const auto& member : members.items()) names.push_back(member.key());
  return {{"type", "object"}, {"properties", members}, {"required", names}};
}

Json ListOf(const Json& items) { return {{"type", "array"}, {"items", items}}; }

Json NumbersNamed(const std::vector<std::string>& names) {
  Json members = Json::object();
  for (const std::string& name : names) members[name] = TypeOf("number");
  return Object(members);
}

Json Time() { return Object({{"sec", TypeOf("integer")}, {"nsec", TypeOf("integer")}}); }
Json Vector() { return NumbersNamed({"x", "y", "z"}); }
Json Rotation() { return NumbersNamed({"x", "y", "z", "w"}); }
Json Color() { return NumbersNamed({"r", "g", "b", "a"}); }
Json Pose() { return Object({{"position", Vector()}, {"orientation", Rotation()}}); }

/// A primitive of a scene: pose, color and `members`.
Json Primitive(Json members) {
  members["pose"] = Pose();
  members["color"] = Color();
  return Object(members);
}

Json SceneEntity() {
  const Json number = TypeOf("number");
  return Object({
      {"timestamp", Time()},
      {"frame_id", TypeOf("string")},
      {"id", TypeOf("string")},
      {"lifetime", Time()},
      {"frame_locked", TypeOf("boolean")},
      {"metadata", ListOf(Object({{"key", TypeOf("string")}, {"value", TypeOf("string")}}))},
      {"arrows", ListOf(Primitive({{"shaft_length", number},
                                   {"shaft_diameter", number},
                                   {"head_length", number},
                                   {"head_diameter", number}}))},
      {"cubes", ListOf(Primitive({{"size", Vector()}}))},
      {"spheres", ListOf(Primitive({{"size", Vector()}}))},
      {"cylinders",
       ListOf(Primitive({{"size", Vector()}, {"bottom_scale", number}, {"top_scale", number}}))},
      {"lines", ListOf(TypeOf("object"))},
      {"triangles", ListOf(Primitive({{"points", ListOf(Vector())},
                                      {"colors", ListOf(Color())},
                                      {"indices", ListOf(TypeOf("integer"))}}))},
      {"texts", ListOf(TypeOf("object"))},
      {"models", ListOf(TypeOf("object"))},
  });
}

}  // namespace

std::string FrameTransformsSchema() {
  return models::JsonText(
      Object({{"transforms", ListOf(Object({{"timestamp", Time()},
                                            {"parent_frame_id", TypeOf("string")},
                                            {"child_frame_id", TypeOf("string")},
                                            {"translation", Vector()},
                                            {"rotation", Rotation()}}))}}));
}

std::string SceneUpdateSchema() {
  const Json deletion =
      Object({{"timestamp", Time()}, {"type", TypeOf("integer")}, {"id", TypeOf("string")}});
  return models::JsonText(
      Object({{"deletions", ListOf(deletion)}, {"entities", ListOf(SceneEntity())}}));
}

std::string JointStatesSchema() {
  const Json number = TypeOf("number");
  return models::JsonText(Object({{"timestamp", Time()},
                                  {"joints", ListOf(Object({{"name", TypeOf("string")},
                                                            {"position", number},
                                                            {"velocity", number},
                                                            {"effort", number}}))}}));
}

std::string TextSchema() { return models::JsonText(Object({{"data", TypeOf("string")}})); }

std::string ContactForcesSchema() {
  return models::JsonText(Object({{"timestamp", Time()},
                                  {"points", ListOf(Object({{"name", TypeOf("string")},
                                                            {"bears", TypeOf("boolean")},
                                                            {"force", Vector()}}))}}));
}

}  // namespace possibility::experiments
