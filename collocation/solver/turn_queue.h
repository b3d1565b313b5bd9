#pragma once

#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>

namespace possibility::collocation {

/// Lets one thread at a time through, in the order of arrival. Unlike a mutex, waiting for it can
/// be given up.
class TurnQueue {
 public:
  /// One thread's place in the queue, and its turn once Wait has returned true; ends with it.
  class Ticket {
   public:
    explicit Ticket(TurnQueue* queue);
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

    /// Sleeps until it is this ticket's turn: true; or `give_up`, asked every few milliseconds,
    /// says so: false.
    bool Wait(const std::function<bool()>& give_up);

   private:
    TurnQueue* queue_;
    std::list<const Ticket*>::iterator place_;
  };

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<const Ticket*> tickets_;
};

}  // namespace possibility::collocation
