#pragma once

#include <condition_variable>
#include <list>
#include <mutex>

#include "common/cancellation_token.h"

namespace possibility::collocation {

/// Lets one thread at a time through, in order of arrival. Unlike with a mutex, a waiting thread
/// can give up.
class TurnQueue {
 public:
  /// One thread's place in the queue. Its turn begins when Wait returns true and ends with the
  /// ticket.
  class Ticket {
   public:
    explicit Ticket(TurnQueue* queue);
    ~Ticket();
    Ticket(const Ticket&) = delete;
    Ticket& operator=(const Ticket&) = delete;

    /// Sleeps until it is this ticket's turn, then returns true. Returns false as soon as
    /// `cancellation`, asked every few milliseconds, says so.
    bool Wait(const CancellationToken& cancellation);

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
