#pragma once

namespace CLI {
class App;
}

namespace possibility::experiments {

/// Makes an empty value of any option of any command a usage error. It would otherwise act as if
/// the option were absent.
void RefuseEmptyValues(CLI::App* program);

}  // namespace possibility::experiments
