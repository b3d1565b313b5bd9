#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace possibility::models {

/// The name of `known` with the smallest edit distance to `name`; empty if none is close enough
/// (more than half of the longer name's letters would have to change).
std::string NearestName(std::string_view name, const std::vector<std::string>& known);

/// " (did you mean 'x'?)" with the nearest name, or an empty text if none is near.
std::string DidYouMean(std::string_view name, const std::vector<std::string>& known);

}  // namespace possibility::models
