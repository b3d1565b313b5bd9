#pragma once

#include <filesystem>

#include "tests/fuzz/case_runner.h"

namespace possibility::fuzz {

/// What `robot init` reads, used up to the robot's YAML: no gait is fitted. `folder` is where the
/// files go; it must outlive the subject.
Subject InitUrdfSubject(const std::filesystem::path& folder);
Subject InitSrdfSubject(const std::filesystem::path& folder);
/// Of a foot, in every format that URDFs name.
Subject InitMeshSubject(const std::filesystem::path& folder);

}  // namespace possibility::fuzz
