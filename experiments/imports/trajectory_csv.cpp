#include "experiments/imports/trajectory_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "experiments/imports/csv_records.h"
#include "experiments/samples/quantities.h"
#include "models/input/input_error.h"
#include "models/input/nearest_name.h"

namespace possibility::experiments {
namespace {

using Columns = std::vector<std::size_t>;  // indices of fields

/// Where the table has what.
class CsvLayout {
 public:
  CsvLayout(const std::vector<std::string>& header, const std::string& place,
            const models::RobotModel& robot)
      : header_(header), place_(place) {
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (!columns_.emplace(header[i], i).second && !header[i].empty()) {
        throw InputError(fmt::format("{}: two columns '{}'", place, header[i]));
      }
    }
    t = Required("t");
    q = All("q", ConfigurationQuantities(robot));
    if (HasAny("v_")) v = All("v", VelocityQuantities(robot));
    if (!v.empty() && HasAny("a_")) a = All("a", AccelerationQuantities(robot));
    action = Optional("action");
    segment = Optional("segment");
    if (segment && !action) throw InputError(place + ": no column 'action' beside 'segment'");
    FindContacts(robot);
  }

  std::size_t t = 0;
  Columns q, v, a;  ///< empty: the table has none
  /// By contact point; none: the table has no column for it, and it never bears.
  std::vector<std::optional<std::size_t>> contacts;
  std::optional<std::size_t> action, segment;

 private:
  std::optional<std::size_t> Optional(const std::string& name) const {
    const auto found = columns_.find(name);
    return found == columns_.end() ? std::nullopt : std::optional(found->second);
  }

  std::size_t Required(const std::string& name) const {
    if (const auto column = Optional(name)) return *column;
    throw InputError(
        fmt::format("{}: no column '{}'{}", place_, name, models::DidYouMean(name, header_)));
  }

  Columns All(const std::string& prefix, const std::vector<Quantity>& quantities) const {
    Columns columns;
    for (const Quantity& quantity : quantities) {
      columns.push_back(Required(prefix + "_" + quantity.name));
    }
    return columns;
  }

  bool HasAny(const std::string& prefix) const {
    return std::any_of(header_.begin(), header_.end(),
                       [&](const std::string& name) { return name.starts_with(prefix); });
  }

  /// A column for a whole patch stands for all its points.
  void FindContacts(const models::RobotModel& robot) {
    bool has_any = false;
    for (const actions::BearingPoint& point : AllContactPoints(robot)) {
      contacts.push_back(Optional("contact_" + ContactColumn(robot, point)));
      if (!contacts.back())
        contacts.back() = Optional("contact_" + robot.contacts[point.patch].name);
      has_any = has_any || contacts.back();
    }
    if (has_any) return;
    throw InputError(fmt::format("{}: no column of contacts, expected for instance 'contact_{}'",
                                 place_, robot.contacts.empty() ? "foot" : robot.contacts[0].name));
  }

  const std::vector<std::string>& header_;
  std::string place_;
  std::map<std::string, std::size_t> columns_;
};

Eigen::VectorXd NumbersOfColumns(const std::vector<std::string>& fields, const Columns& columns,
                                 const std::vector<std::string>& header, const std::string& place) {
  Eigen::VectorXd numbers(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    numbers[static_cast<Eigen::Index>(i)] =
        CsvNumber(fields[columns[i]], place + ": " + header[columns[i]]);
  }
  return numbers;
}

std::vector<bool> BearingOf(const std::vector<std::string>& fields, const CsvLayout& layout,
                            const std::string& place) {
  std::vector<bool> bears;
  for (const auto& column : layout.contacts) {
    const double flag = column ? CsvNumber(fields[*column], place + ": contact") : 0;
    if (flag != 0 && flag != 1) {
      throw InputError(fmt::format("{}: contact: expected 0 or 1, got {}", place, flag));
    }
    bears.push_back(flag == 1);
  }
  return bears;
}

/// Gives every stretch of rows with one action (and one number of segment) an index.
class SegmentCounter {
 public:
  int Index(const std::vector<std::string>& fields, const CsvLayout& layout,
            std::vector<std::string>* actions) {
    if (!layout.action) return 0;
    const std::string& action = fields[*layout.action];
    const std::string number = layout.segment ? fields[*layout.segment] : "";
    if (actions->empty() || action != actions->back() || number != number_) {
      actions->push_back(action);
      number_ = number;
    }
    return static_cast<int>(actions->size()) - 1;
  }

 private:
  std::string number_;
};

}  // namespace

ImportedTrajectory ParseTrajectoryCsv(const std::string& text, const std::filesystem::path& file,
                                      const models::RobotModel& robot) {
  CsvRecords records(text, file);
  std::vector<std::string> header;
  if (!records.Next(&header)) {
    throw InputError(fmt::format("{}: empty, expected a header and rows", file.string()));
  }
  const CsvLayout layout(header, records.place(), robot);
  ImportedTrajectory trajectory;
  SegmentCounter segments;
  for (std::vector<std::string> fields; records.Next(&fields);) {
    const std::string place = records.place();
    if (fields.size() != header.size()) {
      throw InputError(
          fmt::format("{}: expected {} fields, got {}", place, header.size(), fields.size()));
    }
    ImportedSample sample;
    sample.t = CsvNumber(fields[layout.t], place + ": t");
    sample.q = NumbersOfColumns(fields, layout.q, header, place);
    sample.v = NumbersOfColumns(fields, layout.v, header, place);
    sample.a = NumbersOfColumns(fields, layout.a, header, place);
    sample.bears = BearingOf(fields, layout, place);
    sample.segment = segments.Index(fields, layout, &trajectory.actions);
    trajectory.samples.push_back(std::move(sample));
  }
  return trajectory;
}

}  // namespace possibility::experiments
