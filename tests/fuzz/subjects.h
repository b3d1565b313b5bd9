#pragma once

#include <filesystem>

#include "tests/fuzz/case_runner.h"

namespace possibility::fuzz {

/// The files that users give the program. Each kind comes with whole files of the other kinds.
/// `folder` is where the spoilt files go; it must outlive the subject.
Subject ScenarioSubject(const std::filesystem::path& folder);
/// Meshes in every format, and height maps.
Subject MeshSubject(const std::filesystem::path& folder);
Subject HeightMapSubject(const std::filesystem::path& folder);
Subject RobotSubject(const std::filesystem::path& folder);
Subject UrdfSubject(const std::filesystem::path& folder);
Subject PlanSubject(const std::filesystem::path& folder);
/// Plans of format 2: their documents, their motion, or the whole archive.
Subject PackedPlanSubject(const std::filesystem::path& folder);
/// Motions to import, as tables and as arrays.
Subject TrajectorySubject(const std::filesystem::path& folder);
Subject SolutionSubject(const std::filesystem::path& folder);
Subject LibrarySubject(const std::filesystem::path& folder);

}  // namespace possibility::fuzz
