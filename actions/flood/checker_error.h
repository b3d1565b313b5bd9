#pragma once

namespace possibility::actions {

/// The collision checker may err by 0.1 mm towards "not free". Proofs must not: they take off more
/// than that, m.
inline constexpr double kCheckerError = 0.0002;

}  // namespace possibility::actions
