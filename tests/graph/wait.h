#pragma once

#include <chrono>
#include <thread>

namespace possibility::graph::test {

/// Waits until `done`, at most 5 s, and returns whether it came.
template <typename Done>
bool Wait(Done done) {
  const auto begin = std::chrono::steady_clock::now();
  while (!done() && std::chrono::steady_clock::now() - begin < std::chrono::seconds(5)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return done();
}

}  // namespace possibility::graph::test
