#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace possibility::experiments {

/// An array of NumPy: the bytes of a .npy file without its header. Little-endian.
struct NpyArray {
  std::vector<std::size_t> shape;  ///< empty: one value
  std::string type;                ///< NumPy's name: "<f8", "<i4", "|b1", "<U12"
  bool is_fortran = false;         ///< the first index varies fastest
  std::string bytes;

  std::size_t size() const;  ///< number of elements
};

/// An empty array of rows (shape 0 x `row`...), for AppendRow.
NpyArray EmptyRows(const std::string& type, const std::vector<std::size_t>& row);
/// One more row: raises shape[0]. `bytes`: of the row.
void AppendRow(std::string_view bytes, NpyArray* array);
void AppendRow(const Eigen::Ref<const Eigen::VectorXd>& numbers, NpyArray* array);

/// Texts (UTF-8) as "<U...", one-dimensional; as one value if `is_scalar`.
NpyArray TextArray(const std::vector<std::string>& texts, bool is_scalar = false);
NpyArray DoubleArray(const Eigen::VectorXd& numbers);

/// The .npy file (NumPy's NEP 1, version 1.0).
std::string NpyFile(const NpyArray& array);

/// Inverse of NpyFile; reads versions 1 to 3. `where`: for messages, names the file and the member.
/// @throws InputError if it is malformed, big-endian, or of objects.
NpyArray ReadNpy(std::string_view bytes, const std::string& where);

/// The elements as numbers, in C order. @throws InputError unless of type f8, f4, i8, i4, i2, i1,
/// their unsigned kin, or b1.
std::vector<double> Numbers(const NpyArray& array, const std::string& where);
/// The elements as UTF-8. @throws InputError unless of type "<U...".
std::vector<std::string> Texts(const NpyArray& array, const std::string& where);

}  // namespace possibility::experiments
