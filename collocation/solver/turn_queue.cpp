#include "collocation/solver/turn_queue.h"

#include <chrono>

namespace possibility::collocation {

TurnQueue::Ticket::Ticket(TurnQueue* queue) : queue_(queue) {
  const std::lock_guard lock(queue_->mutex_);
  place_ = queue_->tickets_.insert(queue_->tickets_.end(), this);
}

TurnQueue::Ticket::~Ticket() {
  {
    const std::lock_guard lock(queue_->mutex_);
    queue_->tickets_.erase(place_);
  }
  queue_->changed_.notify_all();
}

bool TurnQueue::Ticket::Wait(const CancellationToken& cancellation) {
  std::unique_lock lock(queue_->mutex_);
  while (queue_->tickets_.front() != this) {
    queue_->changed_.wait_for(lock, std::chrono::milliseconds(5));
    lock.unlock();
    if (!cancellation.Proceed()) return false;
    lock.lock();
  }
  return true;
}

}  // namespace possibility::collocation
