#include "actions/plan/plan_writer.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "actions/plan/plan_digits.h"
#include "actions/plan/plan_json.h"
#include "actions/plan/plan_series.h"
#include "models/input/atomic_file.h"
#include "models/input/input_error.h"
#include "models/input/json_text.h"

namespace possibility::actions {
namespace {

using Json = nlohmann::ordered_json;

/// Plans with more knots than this (about twenty minutes) are written with a table of courses.
constexpr std::size_t kMostRows = 20000;

/// "[1,2,3]"
template <typename Numbers>
void AppendList(const Numbers& numbers, int decimals, std::string* text) {
  *text += '[';
  for (const double number : numbers.reshaped()) {
    if (text->back() != '[') *text += ',';
    AppendRounded(number, decimals, text);
  }
  *text += ']';
}

/// A quantity of every knot of a phase, as a matrix with a row for each component.
struct Quantity {
  const char* key;
  int decimals;
  Eigen::MatrixXd values;
};

std::vector<Quantity> QuantitiesOf(const Phase& phase) {
  const auto stack = [&phase](const auto& of_knot) {
    const Eigen::Index size = phase.knots.empty() ? 0 : of_knot(phase.knots[0]).size();
    Eigen::MatrixXd values(size, phase.knots.size());
    for (std::size_t k = 0; k < phase.knots.size(); ++k) {
      const Eigen::VectorXd value = of_knot(phase.knots[k]);
      if (value.size() != size) {
        throw std::invalid_argument("the knots of a phase differ in their sizes");
      }
      values.col(k) = value;
    }
    return values;
  };
  if (!phase.knots.empty() && phase.knots[0].tau.size() == 0 && phase.knots[0].v.size() > 6) {
    throw std::invalid_argument("a plan without torques, which format 1 needs");
  }
  return {
      {"q", PlanDigits::kPosition, stack([](const Knot& knot) { return knot.q; })},
      {"v", PlanDigits::kRate, stack([](const Knot& knot) { return knot.v; })},
      {"a", PlanDigits::kAcceleration, stack([](const Knot& knot) { return knot.a; })},
      {"tau", PlanDigits::kForce, stack([](const Knot& knot) { return knot.tau; })},
      {"forces", PlanDigits::kForce,
       stack([](const Knot& knot) { return Eigen::VectorXd(knot.forces.reshaped()); })},
  };
}

/// A number if the component is constant over all knots, else a list.
std::string CourseOf(const Eigen::VectorXd& component, int decimals) {
  std::string course;
  AppendList(component, decimals, &course);
  std::string constant;
  AppendRounded(component[0], decimals, &constant);
  std::string repeated = "[";
  for (Eigen::Index k = 0; k < component.size(); ++k) repeated += (k > 0 ? "," : "") + constant;
  return course == repeated + "]" ? constant : course;
}

/// Writes segments as text: their numbers would take five times as much memory as JSON values.
class MotionWriter {
 public:
  MotionWriter(bool has_series, models::AtomicFile* output)
      : has_series_(has_series), output_(output) {}

  void Write(const Segment& segment) {
    double start = 0;
    double duration = 0;
    if (!segment.phases.empty() && !segment.phases.front().knots.empty() &&
        !segment.phases.back().knots.empty()) {
      start = segment.phases.front().knots.front().t;
      duration = segment.phases.back().knots.back().t - start;
    }
    std::string text = "{\"action\":" + Json(segment.action).dump() + ",\"start_s\":";
    AppendExact(start, &text);
    text += ",\"duration_s\":";
    AppendExact(duration, &text);
    if (segment.vertices[0] >= 0) {
      text += fmt::format(",\"vertices\":[{},{}]", segment.vertices[0], segment.vertices[1]);
    }
    text += ",\"phases\":[";
    for (const Phase& phase : segment.phases) {
      if (&phase != &segment.phases.front()) text += ',';
      Append(phase, &text);
      output_->Write(text);
      text.clear();
    }
    output_->Write(text + "]}");
  }

  const SeriesWriter& series() const { return series_; }

 private:
  void Append(const Phase& phase, std::string* text) {
    *text += "{\"contacts\":" + Json(phase.contacts).dump();
    if (phase.impulses.cols() > 0) {
      *text += ",\"impulses\":";
      AppendList(phase.impulses, PlanDigits::kForce, text);
    }
    *text += ",\"t\":[";
    for (const Knot& knot : phase.knots) {
      if (text->back() != '[') *text += ',';
      AppendExact(knot.t, text);
    }
    *text += ']';
    for (const Quantity& quantity : QuantitiesOf(phase)) {
      *text += fmt::format(",\"{}\":[", quantity.key);
      has_series_ ? AppendCourses(quantity, text) : AppendRows(quantity, text);
      *text += ']';
    }
    *text += '}';
  }

  static void AppendRows(const Quantity& quantity, std::string* text) {
    for (Eigen::Index k = 0; k < quantity.values.cols(); ++k) {
      if (k > 0) *text += ',';
      AppendList(quantity.values.col(k), quantity.decimals, text);
    }
  }

  void AppendCourses(const Quantity& quantity, std::string* text) {
    for (Eigen::Index i = 0; i < quantity.values.rows(); ++i) {
      if (i > 0) *text += ',';
      const std::string course = CourseOf(quantity.values.row(i), quantity.decimals);
      *text += std::to_string(series_.IndexOf(course));
    }
  }

  bool has_series_;
  models::AtomicFile* output_;
  SeriesWriter series_;
};

std::size_t CountKnots(const Plan& plan) {
  std::size_t count = 0;
  for (const Segment& segment : plan.segments) {
    for (const Phase& phase : segment.phases) count += phase.knots.size();
  }
  return count;
}

}  // namespace

void WritePlan(const Plan& plan, const std::filesystem::path& file) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  models::AtomicFile output(file);
  MotionWriter motion(CountKnots(plan) > kMostRows, &output);
  try {
    std::string head = PlanHead(plan, kPlanFormat, folder).dump();
    head.back() = ',';
    output.Write(head + "\"segments\":[");
    for (const Segment& segment : plan.segments) {
      if (&segment != &plan.segments.front()) output.Write(",");
      motion.Write(segment);
    }
    output.Write("],");
    if (!motion.series().courses().empty()) {
      output.Write("\"series\":[" + motion.series().courses() + "],");
    }
    output.Write(PlanTail(plan).dump().substr(1) + "\n");
  } catch (const Json::exception&) {
    throw InputError(fmt::format(
        "{}: a name or path in the plan is not valid UTF-8, which JSON requires", file.string()));
  }
  output.Commit();
}

}  // namespace possibility::actions
