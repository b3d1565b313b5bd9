#include "experiments/exports/csv_export.h"

#include <optional>

#include "experiments/exports/csv_tables.h"
#include "experiments/samples/sample_margins.h"
#include "models/input/atomic_file.h"

namespace possibility::experiments {
namespace {

/// margins.csv, if asked for.
class MarginFile {
 public:
  MarginFile(const ExportSubject& subject, const std::filesystem::path& file)
      : margins_(subject), file_(file) {
    file_.Write(MarginTable::Header());
  }
  void Write(const PlanSample& sample) {
    file_.Write(MarginTable::Row(sample.knot.t, margins_.Of(sample)));
  }
  void Commit() { file_.Commit(); }

 private:
  SampleMargins margins_;
  models::AtomicFile file_;
};

}  // namespace

std::vector<std::filesystem::path> WriteCsv(const ExportSubject& subject,
                                            const ExportSampling& sampling,
                                            const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files = {folder / "trajectory.csv",
                                              folder / "contact_forces.csv", folder / "units.csv",
                                              folder / "gains.csv"};
  const TrajectoryTable trajectory(subject.plan, subject.robot);
  ContactForceTable forces(subject.plan, subject.robot);
  models::AtomicFile trajectory_file(files[0]);
  models::AtomicFile forces_file(files[1]);
  std::optional<MarginFile> margins;
  if (sampling.margins) margins.emplace(subject, files.emplace_back(folder / "margins.csv"));
  trajectory_file.Write(trajectory.Header());
  forces_file.Write(forces.Header());
  VisitSamples(subject, sampling, [&](const PlanSample& sample) {
    trajectory_file.Write(trajectory.Rows(sample));
    forces_file.Write(forces.Rows(sample));
    if (margins) margins->Write(sample);
  });
  trajectory_file.Commit();
  forces_file.Commit();
  if (margins) margins->Commit();
  models::WriteAtomically(files[2], UnitTable(subject.robot));
  models::WriteAtomically(files[3], GainTable(subject.robot));
  return files;
}

}  // namespace possibility::experiments
