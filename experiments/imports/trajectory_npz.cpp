#include "experiments/imports/trajectory_npz.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <vector>

#include "experiments/formats/npy_array.h"
#include "models/archive/zip_file.h"
#include "experiments/samples/quantities.h"
#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::experiments {
namespace {

/// Rows x components.
using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class TrajectoryArchive {
 public:
  TrajectoryArchive(const std::string& bytes, const std::filesystem::path& file)
      : file_(file.string()), members_(models::ReadZip(bytes, file)) {}

  bool Has(const std::string& name) const { return members_.contains(name + ".npy"); }
  std::string Where(const std::string& name) const { return file_ + ": " + name; }

  NpyArray Read(const std::string& name) const {
    if (!Has(name)) throw InputError(fmt::format("{}: no array '{}'", file_, name));
    return ReadNpy(members_.at(name + ".npy"), Where(name));
  }

  std::vector<std::string> ReadTexts(const std::string& name) const {
    return Texts(Read(name), Where(name));
  }

  /// An array of `rows` rows; one-dimensional arrays are one column.
  Table ReadTable(const std::string& name, std::size_t rows) const {
    const NpyArray array = Read(name);
    const std::size_t columns = array.shape.size() == 2 ? array.shape[1] : 1;
    if (array.shape.empty() || array.shape.size() > 2 || array.shape[0] != rows) {
      throw InputError(fmt::format("{}: expected {} rows", Where(name), rows));
    }
    const std::vector<double> numbers = Numbers(array, Where(name));
    return Eigen::Map<const Table>(numbers.data(), static_cast<Eigen::Index>(rows),
                                   static_cast<Eigen::Index>(columns));
  }

  /// The columns of a table that are called `names`, in this order.
  Table ReadNamed(const std::string& name, const std::vector<std::string>& names,
                  std::size_t rows) const {
    const Table table = ReadTable(name, rows);
    std::vector<std::string> found = names;
    if (Has(name + "_names")) found = ReadTexts(name + "_names");
    if (static_cast<std::size_t>(table.cols()) != found.size()) {
      throw InputError(
          fmt::format("{}: expected {} columns, got {}", Where(name), found.size(), table.cols()));
    }
    Table ordered(table.rows(), static_cast<Eigen::Index>(names.size()));
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto column = std::find(found.begin(), found.end(), names[i]);
      if (column == found.end()) {
        throw InputError(fmt::format("{}: no component '{}'{}", Where(name + "_names"), names[i],
                                     models::DidYouMean(names[i], found)));
      }
      ordered.col(static_cast<Eigen::Index>(i)) = table.col(column - found.begin());
    }
    return ordered;
  }

 private:
  std::string file_;
  std::map<std::string, std::string> members_;
};

std::vector<std::string> NamesOf(const std::vector<Quantity>& quantities) {
  std::vector<std::string> names;
  for (const Quantity& quantity : quantities) names.push_back(quantity.name);
  return names;
}

void ReadMotion(const TrajectoryArchive& archive, const models::RobotModel& robot,
                ImportedTrajectory* trajectory) {
  const std::size_t n = trajectory->samples.size();
  const Table q = archive.ReadNamed("q", NamesOf(ConfigurationQuantities(robot)), n);
  const bool has_v = archive.Has("v");
  const bool has_a = has_v && archive.Has("a");
  Table v, a;
  if (has_v) v = archive.ReadNamed("v", NamesOf(VelocityQuantities(robot)), n);
  if (has_a) a = archive.ReadNamed("a", NamesOf(AccelerationQuantities(robot)), n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    trajectory->samples[i].q = q.row(row);
    if (has_v) trajectory->samples[i].v = v.row(row);
    if (has_a) trajectory->samples[i].a = a.row(row);
  }
}

void ReadContacts(const TrajectoryArchive& archive, const models::RobotModel& robot,
                  ImportedTrajectory* trajectory) {
  std::vector<std::string> names;
  for (const actions::BearingPoint& point : AllContactPoints(robot)) {
    names.push_back(ContactColumn(robot, point));
  }
  const Table contact = archive.ReadNamed("contact", names, trajectory->samples.size());
  for (Eigen::Index row = 0; row < contact.rows(); ++row) {
    for (const double flag : contact.row(row)) {
      trajectory->samples[row].bears.push_back(flag != 0);
    }
  }
}

void ReadSegments(const TrajectoryArchive& archive, ImportedTrajectory* trajectory) {
  if (!archive.Has("segment")) return;
  trajectory->actions = archive.ReadTexts("actions");
  const Table segment = archive.ReadTable("segment", trajectory->samples.size());
  const auto count = static_cast<double>(trajectory->actions.size());
  double before = 0;
  for (Eigen::Index row = 0; row < segment.rows(); ++row) {
    const double index = segment(row, 0);
    if (!(index >= before && index < count) || index != std::floor(index)) {
      throw InputError(fmt::format("{}: row {}: expected indices into 'actions', ascending",
                                   archive.Where("segment"), row));
    }
    trajectory->samples[row].segment = static_cast<int>(index);
    before = index;
  }
}

}  // namespace

ImportedTrajectory ParseTrajectoryNpz(const std::string& bytes, const std::filesystem::path& file,
                                      const models::RobotModel& robot) {
  const TrajectoryArchive archive(bytes, file);
  const std::vector<double> times = Numbers(archive.Read("t"), archive.Where("t"));
  ImportedTrajectory trajectory;
  trajectory.samples.resize(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) trajectory.samples[i].t = times[i];
  ReadMotion(archive, robot, &trajectory);
  ReadContacts(archive, robot, &trajectory);
  ReadSegments(archive, &trajectory);
  return trajectory;
}

}  // namespace possibility::experiments
