#pragma once

#include <filesystem>
#include <string>

#include "experiments/samples/export_subject.h"

namespace possibility::experiments {

/// A model for MuJoCo (MJCF, docs/exports.md): the scene, the robot with a motor at every joint,
/// and the motion as keyframes. Positions, velocities and controls of the keyframes are in MuJoCo's
/// coordinates.
///
/// Without a period the keyframes are 0.02 s apart.
std::string MujocoXml(const ExportSubject& subject, const ExportSampling& sampling);

/// Writes it. @throws InputError if the file cannot be written.
void WriteMujoco(const ExportSubject& subject, const ExportSampling& sampling,
                 const std::filesystem::path& file);

}  // namespace possibility::experiments
