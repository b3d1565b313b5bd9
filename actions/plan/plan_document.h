#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "actions/plan/plan.h"
#include "models/input/json_cursor.h"

namespace possibility::actions {

/// Reads the next phase of a plan. `num_joints`: of the plan.
using PhaseReader = std::function<Phase(const models::JsonCursor& phase, std::size_t num_joints)>;

/// Reads what both formats of plan files share: everything but how the motion of a phase is stored.
/// `read_phase` is called for the phases in their order. `folder`: paths are resolved against it.
/// The caller checks format and keys of `root`.
/// @throws InputError with file and path.
Plan ReadPlanDocument(const models::JsonCursor& root, const std::filesystem::path& folder,
                      const PhaseReader& read_phase);

/// The contacts of a phase. Checks the form of their names only: patches and their points are known
/// to the robot alone. @throws InputError with file and path.
std::vector<std::string> ReadContacts(const models::JsonCursor& cursor);

/// Impulses at `num_points` points: 3 x points. @throws InputError with file and path.
Eigen::Matrix3Xd ReadImpulses(const models::JsonCursor& cursor, Eigen::Index num_points);

/// Fills `numbers` from a list; its size is the expected count. @throws InputError with file and
/// path.
template <typename Numbers>
void ReadNumbers(const models::JsonCursor& cursor, Numbers* numbers) {
  const std::size_t expected = numbers->size();
  if (cursor.ArraySize() != expected) {
    cursor.Fail(fmt::format("expected {} numbers, got {}", expected, cursor.ArraySize()));
  }
  for (std::size_t i = 0; i < expected; ++i) numbers->data()[i] = cursor[i].Number();
}

}  // namespace possibility::actions
