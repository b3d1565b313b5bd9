#pragma once

#include <string>

#include "actions/verify/verifier.h"

namespace possibility::actions {

/// The report as lines of text, each ended by a newline: the verdict, then one line per violation.
std::string FormatText(const VerificationReport& report);

/// The report as one JSON object without line breaks (docs/verification.md). Values and limits that
/// are not finite are null.
std::string FormatJson(const VerificationReport& report);

}  // namespace possibility::actions
