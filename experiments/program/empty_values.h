#pragma once

namespace CLI {
class App;
}

namespace possibility::experiments {

/// Makes an empty value of any option of any command a usage error: it would otherwise mean what
/// the option means when it is left out.
void RefuseEmptyValues(CLI::App* program);

}  // namespace possibility::experiments
