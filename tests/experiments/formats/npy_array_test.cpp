#include "experiments/formats/npy_array.h"

#include <gtest/gtest.h>

#include <fstream>

#include "models/input/input_error.h"
#include "tests/experiments/exports/python_run.h"
#include "tests/experiments/read_text.h"

namespace possibility::experiments {
namespace {

TEST(NpyArrayTest, ReadsBackNumbersAndTexts) {
  NpyArray rows = EmptyRows("<f8", {3});
  AppendRow(Eigen::Vector3d(1, 2, 3), &rows);
  AppendRow(Eigen::Vector3d(4, 5, 1.0 / 3), &rows);
  const NpyArray numbers = ReadNpy(NpyFile(rows), "a");
  EXPECT_EQ(numbers.shape, std::vector<std::size_t>({2, 3}));
  EXPECT_EQ(Numbers(numbers, "a"), std::vector<double>({1, 2, 3, 4, 5, 1.0 / 3}));
  const std::vector<std::string> texts = {"left", "", "h\xc3\xbc\xe2\x82\xac\xf0\x9f\xa6\xbf"};
  EXPECT_EQ(Texts(ReadNpy(NpyFile(TextArray(texts)), "a"), "a"), texts);
  EXPECT_TRUE(ReadNpy(NpyFile(TextArray({"x"}, true)), "a").shape.empty());
}

TEST(NpyArrayTest, DataBeginOnMultiplesOf64Bytes) {
  for (std::size_t n = 1; n < 1000000; n *= 7) {
    NpyArray array = EmptyRows("|b1", {n});
    AppendRow(std::string(n, '\1'), &array);
    EXPECT_EQ((NpyFile(array).size() - n) % 64, 0u);
  }
}

TEST(NpyArrayTest, RefusesSpoiltFilesInOneLine) {
  const std::string file = NpyFile(DoubleArray(Eigen::Vector3d(1, 2, 3)));
  for (std::size_t length = 0; length < file.size(); ++length) {
    EXPECT_THROW(ReadNpy(file.substr(0, length), "a"), InputError) << length;
  }
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = file;
    return changed.replace(changed.find(from), from.size(), to);
  };
  for (const std::string& spoilt :
       {with("<f8", ">f8"), with("<f8", "|O8"), with("<f8", "<f7"), with("(3,)", "3   "),
        with("(3,)", "(x,)"), with("(3,)", "(9,)"), with("'shape'", "'shap_'")}) {
    EXPECT_THROW(ReadNpy(spoilt, "a"), InputError) << spoilt;
  }
  EXPECT_THROW(Numbers(TextArray({"x"}), "a"), InputError);
  EXPECT_THROW(Texts(DoubleArray(Eigen::Vector3d::Zero()), "a"), InputError);
}

TEST(NpyArrayTest, ReadsWhatNumpyWrites) {
  if (!testing::HasNumpy()) GTEST_SKIP() << "python3-numpy is not installed";
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir());
  const std::string file = (folder / "of_numpy.npy").string();
  const auto written = [&](const std::string& array) {
    const testing::PythonRun run =
        testing::RunPython("import numpy as np; np.save(\"" + file + "\", " + array + ")");
    EXPECT_EQ(run.code, 0) << run.out;
    return ReadNpy(testing::ReadText(file), file);
  };
  const std::vector<double> expected = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  for (const std::string type : {"f8", "f4", "i8", "i4", "i2", "i1", "u8", "u4", "u2", "u1"}) {
    const NpyArray array = written("np.arange(12, dtype=\"" + type + "\").reshape(2, 3, 2)");
    EXPECT_EQ(Numbers(array, file), expected) << type;
  }
  const NpyArray fortran = written("np.asfortranarray(np.arange(12.0).reshape(2, 3, 2))");
  EXPECT_TRUE(fortran.is_fortran);
  EXPECT_EQ(Numbers(fortran, file), expected);
  EXPECT_EQ(Numbers(written("np.array([True, False])"), file), std::vector<double>({1, 0}));
  EXPECT_EQ(Texts(written("np.array([\"a\", \"\\u00fc\"])"), file),
            std::vector<std::string>({"a", "\xc3\xbc"}));
}

}  // namespace
}  // namespace possibility::experiments
