#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "models/input/json_cursor.h"

namespace possibility::actions {

/// The table of a long plan's file: what one component of q, v, a, tau or forces does through a
/// phase, each course once. Strides repeat, and most joints rest.
class SeriesWriter {
 public:
  /// The index of a course, given as JSON: a number, or one for each knot.
  int IndexOf(const std::string& course);

  /// "[course, course, ...]" without the brackets.
  const std::string& courses() const { return courses_; }

 private:
  std::map<std::string, int> indices_;
  std::string courses_;
};

/// The same table as it was read.
class SeriesReader {
 public:
  /// No table. Whatever is read from it is refused.
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
