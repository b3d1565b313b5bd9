#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "common/run_on_threads.h"

namespace possibility {

/// Threads that wait for work, for calls that are too short to begin a thread for. Work is begun by
/// one thread at a time.
class ThreadTeam {
 public:
  /// `threads`: those that work, the calling one included; at least 1.
  explicit ThreadTeam(int threads);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  /// As ForEachOnThreads. A thread that wakes too late to help is not waited for.
  void ForEach(std::size_t count, const std::function<void(std::size_t)>& work);

 private:
  void Help();

  std::mutex mutex_;
  std::condition_variable has_work_, is_done_;
  SharedCalls* calls_ = nullptr;  ///< to be helped with
  int helping_ = 0;
  bool ends_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace possibility
