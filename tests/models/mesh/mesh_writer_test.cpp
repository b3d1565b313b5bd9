#include "models/mesh/mesh_writer.h"

#include <gtest/gtest.h>

#include "models/mesh/mesh_reader.h"
#include "tests/models/mesh/mesh_files.h"

namespace possibility::models {
namespace {

TEST(MeshWriterTest, WritesWhatTheFormatAsksAndIsReadBack) {
  const TriangleMesh box = testing::BoxMesh({0.5, 0.25, 2});
  const std::string bytes = BinaryStl(box);
  EXPECT_EQ(bytes, testing::BinaryStl(box));
  const TriangleMesh read = ParseMesh(bytes, "box.stl");
  EXPECT_EQ(read.vertices.size(), 8u);
  EXPECT_EQ(read.triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(testing::EnclosedVolume(read), 0.25);
}

}  // namespace
}  // namespace possibility::models
