#include "common/run_on_threads.h"

#include <thread>
#include <vector>

namespace possibility {

void RunOnThreads(int threads, const std::function<void()>& work) {
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
}

}  // namespace possibility
