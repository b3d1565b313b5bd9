#include "experiments/robots/seen_meshes.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <map>
#include <utility>

#include "experiments/support/file_name.h"
#include "experiments/viewer/robot_look.h"
#include "experiments/viewer/simpler_mesh.h"
#include "models/input/input_error.h"
#include "models/mesh/mesh_reader.h"
#include "models/mesh/mesh_writer.h"
#include "models/robot/mesh_path.h"

namespace possibility::experiments {
namespace {

namespace fs = std::filesystem;

/// The number keeps the name from another's.
std::string FileName(const fs::path& source, std::size_t number) {
  return fmt::format("meshes/{}_{}.stl", number, SafeFileName(source.stem().string()));
}

class Copier {
 public:
  Copier(const fs::path& urdf_file, const std::vector<fs::path>& packages)
      : urdf_file_(urdf_file), packages_(packages) {}

  SeenMeshes Copy(const std::string& urdf) {
    SeenMeshes copied;
    copied.urdf = urdf;
    tinyxml2::XMLDocument document;
    if (document.Parse(urdf.c_str(), urdf.size()) != tinyxml2::XML_SUCCESS) return copied;
    for (auto* link = document.RootElement()->FirstChildElement("link"); link != nullptr;
         link = link->NextSiblingElement("link")) {
      Visit(link);
    }
    copied.warnings = std::move(warnings_);
    if (names_.empty()) return copied;
    SimplifyTogether(kMostSeenTriangles, &meshes_);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      copied.triangles += meshes_[i].triangles.size();
      copied.files.push_back({names_[i], models::BinaryStl(meshes_[i])});
    }
    tinyxml2::XMLPrinter printer;
    document.Print(&printer);
    copied.urdf = printer.CStr();
    return copied;
  }

 private:
  void Visit(tinyxml2::XMLElement* link) {
    const char* name = link->Attribute("name");
    for (auto* visual = link->FirstChildElement("visual"); visual != nullptr;
         visual = visual->NextSiblingElement("visual")) {
      tinyxml2::XMLElement* geometry = visual->FirstChildElement("geometry");
      tinyxml2::XMLElement* mesh =
          geometry != nullptr ? geometry->FirstChildElement("mesh") : nullptr;
      const char* file = mesh != nullptr ? mesh->Attribute("filename") : nullptr;
      if (file == nullptr) continue;
      const std::string owner = fmt::format("link '{}'", name != nullptr ? name : "");
      try {
        mesh->SetAttribute("filename", NameOf(file, owner).c_str());
      } catch (const InputError& error) {
        warnings_.push_back(fmt::format("not drawn on pages: {}", error.what()));
      }
    }
  }

  /// The copy's name. @throws InputError if the mesh cannot be read.
  const std::string& NameOf(const std::string& mesh, const std::string& owner) {
    const fs::path file = models::ResolveMeshPath(mesh, urdf_file_, packages_, owner);
    const auto known = number_.find(file);
    if (known != number_.end()) return names_[known->second];
    meshes_.push_back(models::ReadMesh(file));
    number_[file] = names_.size();
    names_.push_back(FileName(file, names_.size()));
    return names_.back();
  }

  const fs::path& urdf_file_;
  const std::vector<fs::path>& packages_;
  std::map<fs::path, std::size_t> number_;
  std::vector<std::string> names_;
  std::vector<models::TriangleMesh> meshes_;
  std::vector<std::string> warnings_;
};

}  // namespace

SeenMeshes CopySeenMeshes(const std::string& urdf, const fs::path& urdf_file,
                          const std::vector<fs::path>& packages) {
  return Copier(urdf_file, packages).Copy(urdf);
}

}  // namespace possibility::experiments
