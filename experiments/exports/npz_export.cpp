#include "experiments/exports/npz_export.h"

#include <limits>
#include <optional>
#include <vector>

#include "dynamics/tree/tree_kinematics.h"
#include "models/archive/little_endian.h"
#include "models/archive/zip_file.h"
#include "experiments/samples/quantities.h"
#include "experiments/samples/sample_margins.h"

namespace possibility::experiments {
namespace {

using models::AppendLittleEndian;

using Arrays = std::map<std::string, NpyArray>;

void AddNames(const std::string& name, const std::vector<Quantity>& quantities, Arrays* arrays) {
  std::vector<std::string> names;
  std::vector<std::string> units;
  for (const Quantity& quantity : quantities) {
    names.push_back(quantity.name);
    units.push_back(quantity.unit);
  }
  (*arrays)[name + "_names"] = TextArray(names);
  (*arrays)[name + "_units"] = TextArray(units);
}

/// The arrays with a row per sample.
class Rows {
 public:
  Rows(const ExportSubject& subject, bool with_margins)
      : robot_(subject.robot),
        points_(AllContactPoints(subject.robot)),
        kinematics_(subject.robot),
        t_(EmptyRows("<f8", {})),
        segment_(EmptyRows("<i4", {})),
        contact_(EmptyRows("|b1", {points_.size()})),
        places_(EmptyRows("<f8", {points_.size(), 3})),
        forces_(EmptyRows("<f8", {points_.size(), 3})),
        margins_(EmptyRows("<f8", {MarginQuantities().size()})) {
    const auto nv = static_cast<std::size_t>(robot_.nv());
    q_ = EmptyRows("<f8", {static_cast<std::size_t>(robot_.nq())});
    v_ = EmptyRows("<f8", {nv});
    a_ = EmptyRows("<f8", {nv});
    tau_ = EmptyRows("<f8", {static_cast<std::size_t>(robot_.num_joints())});
    if (with_margins) measure_.emplace(subject);
  }

  void Add(const PlanSample& sample) {
    AppendRow(Eigen::VectorXd::Constant(1, sample.knot.t), &t_);
    std::string segment;
    AppendLittleEndian(static_cast<std::int32_t>(sample.segment), &segment);
    AppendRow(segment, &segment_);
    AppendRow(sample.knot.q, &q_);
    AppendRow(sample.knot.v, &v_);
    AppendRow(sample.knot.a, &a_);
    AppendRow(sample.knot.tau, &tau_);
    AddContacts(sample);
    if (measure_) AddMargins(measure_->Of(sample));
  }

  void MoveTo(Arrays* arrays) {
    (*arrays)["t"] = std::move(t_);
    (*arrays)["segment"] = std::move(segment_);
    (*arrays)["q"] = std::move(q_);
    (*arrays)["v"] = std::move(v_);
    (*arrays)["a"] = std::move(a_);
    (*arrays)["tau"] = std::move(tau_);
    (*arrays)["contact"] = std::move(contact_);
    (*arrays)["contact_positions"] = std::move(places_);
    (*arrays)["forces"] = std::move(forces_);
    if (measure_) (*arrays)["margins"] = std::move(margins_);
  }

 private:
  void AddContacts(const PlanSample& sample) {
    kinematics_.SetPosition(sample.knot.q);
    Eigen::VectorXd places(3 * points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      places.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          kinematics_.Position(points_[i].link, points_[i].p_L);
    }
    std::string flags(points_.size(), '\0');
    Eigen::VectorXd forces = Eigen::VectorXd::Zero(places.size());
    Eigen::Index column = 0;
    for (const int point : BearingColumns(robot_, *sample.phase)) {
      flags[point] = 1;
      forces.segment<3>(3 * point) = sample.knot.forces.col(column++);
    }
    AppendRow(flags, &contact_);
    AppendRow(places, &places_);
    AppendRow(forces, &forces_);
  }

  void AddMargins(const actions::PlanMargins& margins) {
    Eigen::VectorXd row(MarginQuantities().size());
    Eigen::Index i = 0;
    for (const MarginQuantity& quantity : MarginQuantities()) {
      const actions::Margin& margin = margins.*quantity.margin;
      row[i++] = margin.segment < 0 ? std::numeric_limits<double>::quiet_NaN() : margin.value;
    }
    AppendRow(row, &margins_);
  }

  const models::RobotModel& robot_;
  const std::vector<actions::BearingPoint> points_;
  dynamics::TreeKinematics kinematics_;
  std::optional<SampleMargins> measure_;
  NpyArray t_, segment_, q_, v_, a_, tau_, contact_, places_, forces_, margins_;
};

void AddDescriptions(const ExportSubject& subject, const ExportSampling& sampling, Arrays* arrays) {
  (*arrays)["format"] = TextArray({kTrajectoryFormat}, true);
  (*arrays)["robot"] = TextArray({subject.robot.name}, true);
  (*arrays)["scenario"] = TextArray({subject.scenario.name}, true);
  AddNames("q", ConfigurationQuantities(subject.robot), arrays);
  AddNames("v", VelocityQuantities(subject.robot), arrays);
  AddNames("a", AccelerationQuantities(subject.robot), arrays);
  AddNames("tau", TorqueQuantities(subject.robot), arrays);
  std::vector<std::string> contacts;
  for (const actions::BearingPoint& point : AllContactPoints(subject.robot)) {
    contacts.push_back(ContactColumn(subject.robot, point));
  }
  (*arrays)["contact_names"] = TextArray(contacts);
  std::vector<std::string> segments;
  for (const actions::Segment& segment : subject.plan.segments) segments.push_back(segment.action);
  (*arrays)["actions"] = TextArray(segments);
  const JointGains gains = GainsOf(subject.robot);
  (*arrays)["stiffness"] = DoubleArray(gains.stiffness);
  (*arrays)["damping"] = DoubleArray(gains.damping);
  if (!sampling.margins) return;
  std::vector<Quantity> margins;
  for (const MarginQuantity& margin : MarginQuantities()) {
    margins.push_back({margin.name, margin.unit});
  }
  AddNames("margin", margins, arrays);
}

}  // namespace

std::map<std::string, NpyArray> TrajectoryArrays(const ExportSubject& subject,
                                                 const ExportSampling& sampling) {
  Rows rows(subject, sampling.margins);
  VisitSamples(subject, sampling, [&](const PlanSample& sample) { rows.Add(sample); });
  Arrays arrays;
  AddDescriptions(subject, sampling, &arrays);
  rows.MoveTo(&arrays);
  return arrays;
}

void WriteNpz(const ExportSubject& subject, const ExportSampling& sampling,
              const std::filesystem::path& file) {
  models::ZipWriter archive(file);
  for (const auto& [name, array] : TrajectoryArrays(subject, sampling)) {
    archive.Add(name + ".npy", NpyFile(array));
  }
  archive.Commit();
}

}  // namespace possibility::experiments
