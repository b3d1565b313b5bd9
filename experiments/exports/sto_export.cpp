#include "experiments/exports/sto_export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>

#include "experiments/exports/sto_columns.h"
#include "models/input/atomic_file.h"

namespace possibility::experiments {
namespace {

constexpr double kRowPeriod = 0.01;  // s

}  // namespace

void WriteSto(const ExportSubject& subject, const ExportSampling& sampling,
              const std::filesystem::path& file) {
  StoTable table(subject.robot);
  std::string rows;
  int count = 0;
  VisitSamples(subject, {sampling.period.value_or(kRowPeriod), false},
               [&](const PlanSample& sample) {
                 rows += fmt::format("{}\n", fmt::join(table.Row(sample), "\t"));
                 ++count;
               });
  models::AtomicFile storage(file);
  storage.Write(fmt::format(
      "{}\ninDegrees=no\nnRows={}\nnColumns={}\nDataType=double\nversion=3\n"
      "OpenSimVersion=4.0\nendheader\n{}\n",
      subject.scenario.name, count, table.labels().size(), fmt::join(table.labels(), "\t")));
  storage.Write(rows);
  storage.Commit();
}

}  // namespace possibility::experiments
