#include "models/mesh/height_map.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "models/input/input_error.h"
#include "models/mesh/flat_regions.h"
#include "tests/message_of.h"
#include "tests/models/mesh/png_files.h"
#include "tests/models/temporary_folder.h"

namespace possibility::models {
namespace {

using testing::PngOf;

std::string ErrorOfHeights(const std::string& bytes, const std::string& name) {
  return MessageOf<InputError>([&] { ParseHeights(bytes, name); });
}

TEST(HeightMap, CsvRowsAreRows) {
  const TemporaryFolder folder;
  const Eigen::MatrixXd heights =
      ReadHeights(folder.Write("map.csv", "0, 1.5,-2\r\n+3,4e-1 , 5\n\n  \n"));
  EXPECT_EQ(heights, (Eigen::MatrixXd(2, 3) << 0, 1.5, -2, 3, 0.4, 5).finished());
  EXPECT_EQ(ParseHeights("1,2\n3,4", "a.CSV"), (Eigen::MatrixXd(2, 2) << 1, 2, 3, 4).finished());
}

TEST(HeightMap, PngValuesAreRead) {
  Eigen::MatrixXd values(3, 2);
  values << 0, 255, 1, 2, 128, 77;
  EXPECT_EQ(ParseHeights(PngOf(values, 8, 0), "a.png"), values);
  values << 0, 65535, 1, 256, 40000, 300;
  EXPECT_EQ(ParseHeights(PngOf(values, 16, 0), "a.png"), values);
}

TEST(HeightMap, BrokenMapsGiveOneLine) {
  EXPECT_EQ(ErrorOfHeights("1,2\n3,4,5\n", "a.csv"),
            "a.csv:2: has 3 heights, expected 2 as in the first row");
  EXPECT_EQ(ErrorOfHeights("1,2\n3,nan\n", "a.csv"), "a.csv:2: expected a height, got 'nan'");
  EXPECT_EQ(ErrorOfHeights("1,2\n3,1e400\n", "a.csv"), "a.csv:2: expected a height, got '1e400'");
  EXPECT_EQ(ErrorOfHeights("1,2\n3,\n", "a.csv"), "a.csv:2: expected a height, got ''");
  EXPECT_EQ(ErrorOfHeights("1;2\n3;4\n", "a.csv"), "a.csv:1: expected a height, got '1;2'");
  EXPECT_EQ(ErrorOfHeights("1,2\n\n3,4\n", "a.csv"),
            "a.csv:2: expected heights, got an empty line");
  EXPECT_EQ(ErrorOfHeights("", "a.csv"), "a.csv: expected at least 2 rows of 2 heights, got 0 x 0");
  EXPECT_EQ(ErrorOfHeights("1,2,3\n", "a.csv"),
            "a.csv: expected at least 2 rows of 2 heights, got 1 x 3");
  EXPECT_EQ(ErrorOfHeights("1,2\n3,4\n", "a.txt"),
            "a.txt: expected a height map whose name ends in .png or .csv");
  std::string long_row = "0";
  for (int i = 1; i < 50001; ++i) long_row += ",0";
  EXPECT_EQ(ErrorOfHeights(long_row + "\n" + long_row + "\n", "a.csv"),
            "a.csv: expected at most 100000 heights, got 2 x 50001");
}

TEST(HeightMap, BrokenPngsGiveOneLine) {
  Eigen::MatrixXd values(3, 4);
  values.setConstant(7);
  const std::string png = PngOf(values, 8, 0);
  EXPECT_EQ(ErrorOfHeights("", "a.png"), "a.png: not a valid PNG: it does not begin like one");
  EXPECT_EQ(ErrorOfHeights(png.substr(0, 20), "a.png"),
            "a.png: not a valid PNG: it ends too early");
  EXPECT_EQ(ErrorOfHeights(png.substr(0, png.size() - 20), "a.png"),
            "a.png: not a valid PNG: it ends too early");
  EXPECT_EQ(ErrorOfHeights(PngOf(values, 8, 2), "a.png"),
            "a.png: has colours, expected a picture of grey values only");
  EXPECT_EQ(ErrorOfHeights(PngOf(values, 8, 3), "a.png"),
            "a.png: has a palette, expected a picture of grey values only");
  EXPECT_EQ(ErrorOfHeights(PngOf(values, 8, 4), "a.png"),
            "a.png: has transparency, expected a picture of grey values only");
  EXPECT_EQ(ErrorOfHeights(PngOf(values, 4, 0), "a.png"),
            "a.png: has 4 bits a sample, expected 8 or 16");
  EXPECT_EQ(ErrorOfHeights(PngOf(Eigen::MatrixXd::Zero(1, 4), 8, 0), "a.png"),
            "a.png: expected at least 2 rows of 2 heights, got 1 x 4");
  std::string spoilt = png;
  spoilt[png.size() - 20] ^= 0x55;  // within the compressed values
  EXPECT_EQ(ErrorOfHeights(spoilt, "a.png").substr(0, 23), "a.png: not a valid PNG:");
}

TEST(HeightMap, TheSurfaceGoesThroughTheSamplesWithTheFirstRowOnTop) {
  Eigen::MatrixXd heights(2, 3);
  heights << 1, 2, 3, 4, 5, 6;
  const TriangleMesh mesh = MeshOfHeights(heights, 0.5);
  ASSERT_EQ(mesh.vertices.size(), 6u);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3d(0, 0, 4));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(1, 0, 6));
  EXPECT_EQ(mesh.vertices[3], Eigen::Vector3d(0, 0.5, 1));
  ASSERT_EQ(mesh.triangles.size(), 4u);
  for (int t = 0; t < 4; ++t) EXPECT_NEAR(mesh.AreaVector(t).z(), 0.25, 1e-15);
}

TEST(HeightMap, ATiltedPlaneIsOneRegionAndACornerTakesOneTriangle) {
  Eigen::MatrixXd heights(9, 12);
  for (int row = 0; row < 9; ++row) {
    for (int column = 0; column < 12; ++column) {
      heights(row, column) = 0.05 * column + 0.02 * row;
    }
  }
  std::vector<FlatRegion> regions = FlatRegions(MeshOfHeights(heights, 0.25));
  ASSERT_EQ(regions.size(), 1u);
  EXPECT_NEAR(regions[0].normal.x() / regions[0].normal.z(), -0.2, 1e-9);
  EXPECT_NEAR(regions[0].normal.y() / regions[0].normal.z(), 0.08, 1e-9);
  EXPECT_EQ(regions[0].polygons.size(), 1u);

  Eigen::MatrixXd corner = Eigen::MatrixXd::Zero(2, 2);
  for (int sample = 0; sample < 4; ++sample) {
    corner.setZero();
    corner(sample / 2, sample % 2) = 0.2;
    const TriangleMesh mesh = MeshOfHeights(corner, 0.25);
    int flat = 0;
    for (int t = 0; t < 2; ++t) flat += mesh.AreaVector(t).normalized().z() == 1;
    EXPECT_EQ(flat, 1);
  }
}

}  // namespace
}  // namespace possibility::models
