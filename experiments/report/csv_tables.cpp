#include "experiments/report/csv_tables.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "actions/plan/contact_name.h"
#include "models/input/input_error.h"

namespace possibility::experiments {
namespace {

constexpr double kMaxSamples = 1e8;
constexpr const char* kRootRates[] = {"root_wx", "root_wy", "root_wz",
                                      "root_x",  "root_y",  "root_z"};
constexpr const char* kRootPose[] = {"root_qw", "root_qx", "root_qy", "root_qz",
                                     "root_x",  "root_y",  "root_z"};

/// Quoted if necessary (RFC 4180).
std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

template <typename RootNames>
void AppendNames(const char* prefix, const RootNames& root, const models::RobotModel& robot,
                 std::string* row) {
  for (const char* name : root) *row += fmt::format(",{}_{}", prefix, name);
  for (const models::Joint& joint : robot.joints) {
    *row += "," + Field(fmt::format("{}_{}", prefix, joint.name));
  }
}

void AppendNumbers(const Eigen::VectorXd& numbers, std::string* row) {
  for (const double number : numbers) fmt::format_to(std::back_inserter(*row), ",{}", number);
}

actions::Knot KnotAt(const actions::Phase& phase, double t) {
  const auto after =
      std::upper_bound(phase.knots.begin() + 1, phase.knots.end() - 1, t,
                       [](double time, const actions::Knot& knot) { return time < knot.t; });
  return actions::Interpolate(*(after - 1), *after, std::clamp(t, (after - 1)->t, after->t));
}

}  // namespace

void VisitKnots(const actions::Plan& plan, const VisitSample& visit) {
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    for (const actions::Phase& phase : plan.segments[i].phases) {
      for (const actions::Knot& knot : phase.knots) visit({static_cast<int>(i), &phase, knot});
    }
  }
}

void VisitEvery(const actions::Plan& plan, double step, const VisitSample& visit) {
  if (plan.duration() / step > kMaxSamples) {
    throw InputError(
        fmt::format("--step: {} s gives over {} rows, expected a longer step", step, kMaxSamples));
  }
  std::int64_t index = 0;
  double begin = 0;
  PlanSample last;
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    for (const actions::Phase& phase : plan.segments[i].phases) {
      if (last.phase == nullptr) begin = phase.knots.front().t;
      for (double t = begin + index * step; t < phase.knots.back().t; t = begin + index * step) {
        visit({static_cast<int>(i), &phase, KnotAt(phase, t)});
        ++index;
      }
      last = {static_cast<int>(i), &phase, phase.knots.back()};
    }
  }
  if (last.phase != nullptr) visit(last);
}

std::string TrajectoryTable::Header() const {
  std::string text = "t,segment,action";
  AppendNames("q", kRootPose, robot_, &text);
  AppendNames("v", kRootRates, robot_, &text);
  AppendNames("a", kRootRates, robot_, &text);
  AppendNames("tau", std::initializer_list<const char*>{}, robot_, &text);
  return text + "\n";
}

std::string TrajectoryTable::Rows(const PlanSample& sample) const {
  std::string text = fmt::format("{},{},{}", sample.knot.t, sample.segment,
                                 Field(plan_.segments[sample.segment].action));
  for (const auto* numbers : {&sample.knot.q, &sample.knot.v, &sample.knot.a, &sample.knot.tau}) {
    AppendNumbers(*numbers, &text);
  }
  return text + "\n";
}

std::string ContactForceTable::Header() const {
  return "t,segment,action,patch,point,x,y,z,fx,fy,fz\n";
}

std::string ContactForceTable::Rows(const PlanSample& sample) {
  std::string text;
  kinematics_.SetPosition(sample.knot.q);
  Eigen::Index column = 0;
  for (const actions::BearingPatch& bearing : actions::BearingPatches(robot_, *sample.phase)) {
    const models::ContactPatch& patch = robot_.contacts[bearing.patch];
    for (const int i : bearing.points) {
      text += fmt::format("{},{},{},{},{}", sample.knot.t, sample.segment,
                          Field(plan_.segments[sample.segment].action), Field(patch.name), i);
      AppendNumbers(kinematics_.Position(patch.link, patch.points[i]), &text);
      AppendNumbers(sample.knot.forces.col(column++), &text);
      text += "\n";
    }
  }
  return text;
}

}  // namespace possibility::experiments
