#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "models/input/json_cursor.h"

namespace possibility::actions {

/// Table of courses in a long plan's file. A course is one component of q, v, a, tau or forces over
/// a phase. Each distinct course is stored once, because strides repeat and most joints rest.
class SeriesWriter {
 public:
  /// Index of a course given as JSON: one number, or one per knot.
  int IndexOf(const std::string& course);

  /// "[course, course, ...]" without the brackets.
  const std::string& courses() const { return courses_; }

 private:
  std::map<std::string, int> indices_;
  std::string courses_;
};

/// The same table, read from a file.
class SeriesReader {
 public:
  /// No table: Read throws.
  SeriesReader() = default;
  /// @throws InputError if it is not a list of numbers and lists of numbers.
  explicit SeriesReader(const models::JsonCursor& table);

  /// The courses of `size` components that `indices` lists: size x num_knots.
  /// @throws InputError if an index or the length of a course is wrong.
  Eigen::MatrixXd Read(const models::JsonCursor& indices, std::size_t num_knots) const;

 private:
  std::vector<Eigen::VectorXd> courses_;  ///< one number: constant
};

}  // namespace possibility::actions
