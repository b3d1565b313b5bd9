#include "actions/plan/plan_series.h"

#include <fmt/format.h>

namespace possibility::actions {

int SeriesWriter::IndexOf(const std::string& course) {
  const auto [found, is_new] = indices_.emplace(course, static_cast<int>(indices_.size()));
  if (is_new) courses_ += (courses_.empty() ? "" : ",") + course;
  return found->second;
}

SeriesReader::SeriesReader(const models::JsonCursor& table) {
  const std::size_t size = table.ArraySize();
  courses_.reserve(size);
  for (std::size_t i = 0; i < size; ++i) {
    const models::JsonCursor course = table[i];
    if (!course.value().is_array()) {
      courses_.push_back(Eigen::VectorXd::Constant(1, course.Number()));
      continue;
    }
    const std::size_t length = course.ArraySize();
    if (length < 2) course.Fail(fmt::format("expected a number or at least two, got {}", length));
    Eigen::VectorXd numbers(length);
    for (std::size_t k = 0; k < length; ++k) numbers[k] = course[k].Number();
    courses_.push_back(std::move(numbers));
  }
}

Eigen::MatrixXd SeriesReader::Read(const models::JsonCursor& indices, std::size_t num_knots) const {
  const std::size_t size = indices.ArraySize();
  Eigen::MatrixXd rows(size, num_knots);
  for (std::size_t i = 0; i < size; ++i) {
    const models::JsonCursor index = indices[i];
    const Eigen::VectorXd& course =
        courses_[index.Integer(0, static_cast<std::int64_t>(courses_.size()) - 1)];
    if (course.size() == 1) {
      rows.row(i).setConstant(course[0]);
    } else if (static_cast<std::size_t>(course.size()) == num_knots) {
      rows.row(i) = course;
    } else {
      index.Fail(fmt::format("expected the index of a series of {} numbers as in t, got one of {}",
                             num_knots, course.size()));
    }
  }
  return rows;
}

}  // namespace possibility::actions
