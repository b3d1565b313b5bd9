#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "experiments/exports/csv_export.h"
#include "experiments/exports/mcap_export.h"
#include "experiments/exports/mujoco_export.h"
#include "experiments/exports/npz_export.h"
#include "experiments/exports/sto_export.h"
#include "experiments/support/output_file.h"
#include "experiments/viewer/viewer_page.h"
#include "models/input/input_error.h"
#include "python/bindings.h"

namespace possibility::python {
namespace {

namespace py = pybind11;
using experiments::ExportSampling;
using experiments::ExportSubject;
using experiments::LoadedPlan;

void WriteKind(const std::string& kind, const ExportSubject& subject,
               const ExportSampling& sampling, const std::filesystem::path& path) {
  if (kind == "csv") {
    experiments::PrepareOutputFolder("csv", path);
    experiments::WriteCsv(subject, sampling, path);
  } else if (kind == "npz") {
    experiments::WriteNpz(subject, sampling, path);
  } else if (kind == "mcap") {
    experiments::WriteMcap(subject, sampling, path);
  } else if (kind == "mujoco") {
    experiments::WriteMujoco(subject, sampling, path);
  } else if (kind == "sto") {
    experiments::WriteSto(subject, sampling, path);
  } else {
    throw InputError("export: no format '" + kind + "', expected csv, npz, mcap, mujoco or sto");
  }
}

void Export(const LoadedPlan& loaded, const std::string& kind, const std::string& path,
            std::optional<double> period, bool margins) {
  const py::gil_scoped_release release;
  experiments::RequireMotion(loaded);
  WriteKind(kind, {loaded.plan, loaded.robot, loaded.scenario}, {period, margins}, path);
}

std::string Page(const LoadedPlan& loaded) {
  const py::gil_scoped_release release;
  return experiments::ViewerPage(loaded.plan, loaded.robot, loaded.scenario);
}

}  // namespace

void BindFiles(py::module_& module) {
  module.def("export", &Export);
  module.def("page", &Page);
  module.def("write_page", [](const LoadedPlan& loaded, const std::string& file) {
    experiments::WriteOutput(file, Page(loaded));
  });
}

}  // namespace possibility::python
