#include "app/service/loop/journal.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace selfcal {

Journal::Journal(std::unique_ptr<Store> store)
    : store_(std::move(store)), thread_([this] { write(); }) {}

Journal::~Journal() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Journal::add(EventRecord event) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() == kMostWaiting) {
      waiting_.pop_front();
      ++dropped_;
    }
    waiting_.push_back(std::move(event));
  }
  changed_.notify_one();
}

void Journal::write() {
  bool failing = false;
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    EventRecord event = std::move(waiting_.front());
    waiting_.pop_front();
    const std::uint64_t dropped = std::exchange(dropped_, 0);
    lock.unlock();
    if (dropped > 0)
      event.text = std::to_string(dropped) + " lines before this one were not kept; " + event.text;
    // An event that cannot be stored must not become an event itself, nor fill the log.
    const auto kept = store_->add(event);
    if (!kept && !failing) spdlog::error("{}", kept.error().what);
    failing = !kept;
    lock.lock();
    if (!kept) dropped_ += dropped + 1;
  }
}

}  // namespace selfcal
