#include "models/mesh/mesh_reader.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <optional>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "models/input/file_contents.h"
#include "models/input/input_error.h"
#include "models/mesh/file_error.h"
#include "models/mesh/separate_process.h"
#include "models/mesh/triangulation.h"

namespace possibility::models {
namespace {

using Eigen::Vector3d;

/// Nested deeper than this no scene of the three formats is.
constexpr int kDeepest = 64;

/// Processor time; a mesh of kMostTriangles takes less than a second.
constexpr unsigned kMostSeconds = 5;

/// Corners of a polygon: the time to cut it grows with their square or faster.
constexpr unsigned kMostCorners = 1000;

/// The ending of the file's name in lower case, without the dot.
std::string EndingOf(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  if (!ending.empty()) ending.erase(0, 1);
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending != "stl" && ending != "obj" && ending != "ply" && ending != "dae") {
    FailAt(file, "expected a mesh whose name ends in .stl, .obj, .ply or .dae");
  }
  return ending;
}

/// One line of at most `kLongest` printable characters of what the library says.
std::string OneLine(std::string text) {
  constexpr std::size_t kLongest = 120;
  if (text.size() > kLongest) text.resize(kLongest);
  for (char& c : text) {
    if (const auto u = static_cast<unsigned char>(c); u < 0x20 || u >= 0x7f) c = ' ';
  }
  return text;
}

/// A file system without files: a mesh that names others must not open them.
class NoFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

/// An importer that knows one format only: others must not be guessed from the contents.
class OneFormat {
 public:
  explicit OneFormat(const std::string& ending) {
    importer_.SetIOHandler(new NoFiles);  // the importer owns it
    // Coordinates as the file has them, as programs of robots read it (but in metres).
    importer_.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    const Assimp::BaseImporter* wanted = importer_.GetImporter(ending.c_str());
    for (std::size_t i = importer_.GetImporterCount(); i > 0; --i) {
      Assimp::BaseImporter* other = importer_.GetImporter(i - 1);
      if (other == wanted) continue;
      importer_.UnregisterLoader(other);
      delete other;
    }
  }

  /// Null if the file is malformed; then Error() says why.
  const aiScene* Read(const std::string& bytes, const std::string& ending) {
    return importer_.ReadFileFromMemory(bytes.data(), bytes.size(), 0, ending.c_str());
  }
  std::string Error() const { return importer_.GetErrorString(); }

 private:
  Assimp::Importer importer_;
};

/// The reader does not end without the header's end. No element takes less than a byte: larger
/// numbers would only keep the reader busy.
void CheckPlyHeader(const std::string& bytes, const std::filesystem::path& file) {
  const std::size_t end = bytes.find("\nend_header");
  if (end == std::string::npos) FailAt(file, "expected a line 'end_header'");
  std::istringstream header(bytes.substr(0, end));
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string keyword, name;
    double count = 0;
    if (!(words >> keyword >> name >> count) || keyword != "element") continue;
    if (count <= static_cast<double>(bytes.size())) continue;
    FailAt(file, fmt::format("cannot hold {:.0f} elements '{}' in {} bytes", count, OneLine(name),
                             bytes.size()));
  }
}

/// The lists of indices of a Collada file. The reader does not end over one that holds anything but
/// numbers.
class IndexLists : public tinyxml2::XMLVisitor {
 public:
  bool VisitEnter(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute*) override {
    const std::string_view name = element.Name();
    if (name != "p" && name != "vcount" && name != "v" && name != "h") return true;
    const char* text = element.GetText();
    const std::string_view indices = text == nullptr ? "" : text;
    if (bad_line_ == 0 && indices.find_first_not_of("0123456789- \t\r\n") != indices.npos) {
      bad_line_ = element.GetLineNum();
    }
    return true;
  }
  int bad_line() const { return bad_line_; }  ///< 0: none

 private:
  int bad_line_ = 0;
};

/// What the reader does not end over.
void CheckCollada(const std::string& bytes, const std::filesystem::path& file) {
  tinyxml2::XMLDocument document;
  if (const auto error = document.Parse(bytes.data(), bytes.size());
      error != tinyxml2::XML_SUCCESS) {
    FailAt(file, fmt::format("not a valid mesh: no XML ({}, line {})",
                             tinyxml2::XMLDocument::ErrorIDToName(error), document.ErrorLineNum()));
  }
  IndexLists lists;
  document.Accept(&lists);
  if (lists.bad_line() > 0) {
    FailAt(file,
           fmt::format("not a valid mesh: line {}: expected whole numbers", lists.bad_line()));
  }
}

/// What later steps rely on: indices in range and finite numbers.
void CheckScene(const aiScene& scene, const std::filesystem::path& file) {
  std::size_t triangles = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (mesh.mNumVertices > 0 && mesh.mVertices == nullptr) FailAt(file, "has no corners");
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& p = mesh.mVertices[v];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
        FailAt(file, fmt::format("corner {} is not finite, expected numbers", v));
      }
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices > kMostCorners) {
        FailAt(file, fmt::format("face {} has {} corners, expected at most {}", f, face.mNumIndices,
                                 kMostCorners));
      }
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        if (face.mIndices[i] < mesh.mNumVertices) continue;
        FailAt(file, fmt::format("face {} names corner {}, but there are {}", f, face.mIndices[i],
                                 mesh.mNumVertices));
      }
      if (face.mNumIndices >= 3) triangles += face.mNumIndices - 2;
    }
  }
  if (triangles == 0) FailAt(file, "has no triangles");
  if (triangles > kMostTriangles) {
    FailAt(file,
           fmt::format("has {} triangles, expected at most {}: thin it out or cut it into parts",
                       triangles, kMostTriangles));
  }
}

struct PlaceHash {
  std::size_t operator()(const std::array<double, 3>& place) const {
    const auto* bytes = reinterpret_cast<const char*>(place.data());
    return std::hash<std::string_view>()(std::string_view(bytes, sizeof(place)));
  }
};

/// Collects triangles; corners at the same place become one vertex.
class Joiner {
 public:
  explicit Joiner(TriangleMesh* mesh) : mesh_(mesh) {}

  void Add(const std::array<Vector3d, 3>& corners) {
    const Vector3d area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    double longest = 0;
    for (int i = 0; i < 3; ++i) {
      longest = std::max(longest, (corners[(i + 1) % 3] - corners[i]).squaredNorm());
    }
    // As thin as the rounding of single-precision coordinates: without a direction.
    constexpr double kThin = 1e-7;
    if (!(area.norm() > kThin * longest)) return;
    mesh_->triangles.push_back({IndexOf(corners[0]), IndexOf(corners[1]), IndexOf(corners[2])});
  }

 private:
  int IndexOf(const Vector3d& p) {
    // Adding zero makes -0 a 0.
    const std::array<double, 3> place = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};
    const auto [known, is_new] = indices_.try_emplace(place, mesh_->vertices.size());
    if (is_new) mesh_->vertices.push_back(p);
    return static_cast<int>(known->second);
  }

  TriangleMesh* mesh_;
  std::unordered_map<std::array<double, 3>, std::size_t, PlaceHash> indices_;
};

Eigen::Affine3d ToEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d X;
  X.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return X;
}

void AddNode(const aiScene& scene, const aiNode& node, const Eigen::Affine3d& X_MP, int depth,
             const std::filesystem::path& file, Joiner* joiner) {
  if (depth > kDeepest) FailAt(file, "its parts are nested too deeply");
  const Eigen::Affine3d X_MN = X_MP * ToEigen(node.mTransformation);
  const bool is_mirrored = X_MN.linear().determinant() < 0;
  for (unsigned m = 0; m < node.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      std::vector<Vector3d> corners;
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        const aiVector3D& p = mesh.mVertices[face.mIndices[i]];
        corners.push_back(X_MN * Vector3d(p.x, p.y, p.z));
      }
      for (const auto& [a, b, c] : Triangulated(corners)) {
        joiner->Add({corners[a], corners[is_mirrored ? c : b], corners[is_mirrored ? b : c]});
      }
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    AddNode(scene, *node.mChildren[i], X_MN, depth + 1, file, joiner);
  }
}

TriangleMesh ReadInProcess(const std::string& bytes, const std::filesystem::path& file) {
  const std::string ending = EndingOf(file);
  OneFormat importer(ending);
  const aiScene* scene = importer.Read(bytes, ending);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    FailAt(file, fmt::format("not a valid mesh: {}", OneLine(importer.Error())));
  }
  CheckScene(*scene, file);
  TriangleMesh mesh;
  Joiner joiner(&mesh);
  AddNode(*scene, *scene->mRootNode, Eigen::Affine3d::Identity(), 0, file, &joiner);
  if (mesh.triangles.empty()) FailAt(file, "no triangle has an area");
  return mesh;
}

/// What one process sends to the other: a letter, the number of vertices, the vertices and the
/// triangles; or another letter and a message.
constexpr char kMesh = 'M';
constexpr char kError = 'E';

std::string Packed(const TriangleMesh& mesh) {
  const std::uint64_t count = mesh.vertices.size();
  std::string parcel(1, kMesh);
  parcel.append(reinterpret_cast<const char*>(&count), sizeof(count));
  for (const Vector3d& vertex : mesh.vertices) {
    parcel.append(reinterpret_cast<const char*>(vertex.data()), sizeof(vertex));
  }
  for (const auto& triangle : mesh.triangles) {
    parcel.append(reinterpret_cast<const char*>(triangle.data()), sizeof(triangle));
  }
  return parcel;
}

TriangleMesh Unpacked(const std::string& parcel) {
  TriangleMesh mesh;
  std::uint64_t count = 0;
  const char* at = parcel.data() + 1;
  std::memcpy(&count, at, sizeof(count));
  at += sizeof(count);
  mesh.vertices.resize(count);
  for (Vector3d& vertex : mesh.vertices) {
    std::memcpy(vertex.data(), at, sizeof(vertex));
    at += sizeof(vertex);
  }
  mesh.triangles.resize((parcel.data() + parcel.size() - at) / sizeof(std::array<int, 3>));
  for (auto& triangle : mesh.triangles) {
    std::memcpy(triangle.data(), at, sizeof(triangle));
    at += sizeof(triangle);
  }
  return mesh;
}

}  // namespace

TriangleMesh ReadMesh(const std::filesystem::path& file) {
  EndingOf(file);
  return ParseMesh(ReadFileContents(file), file);
}

TriangleMesh ParseMesh(const std::string& bytes, const std::filesystem::path& file) {
  const std::string ending = EndingOf(file);
  if (bytes.empty()) FailAt(file, "is empty, expected a mesh");
  if (ending == "ply") CheckPlyHeader(bytes, file);
  if (ending == "dae") CheckCollada(bytes, file);
  const std::optional<std::string> parcel = InSeparateProcess(
      [&] {
        try {
          return Packed(ReadInProcess(bytes, file));
        } catch (const InputError& error) {
          return kError + std::string(error.what());
        } catch (const std::exception& error) {
          return kError +
                 fmt::format("{}: not a valid mesh: {}", file.string(), OneLine(error.what()));
        }
      },
      kMostSeconds);
  if (!parcel) FailAt(file, "not a valid mesh: the reader breaks down over it");
  if (parcel->starts_with(kError)) throw InputError(parcel->substr(1));
  return Unpacked(*parcel);
}

}  // namespace possibility::models
