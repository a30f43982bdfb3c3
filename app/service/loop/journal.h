// Events on their way to the store, written by a thread of its own: a line for a person waits for
// no disk, and the loop waits for no line.
#pragma once

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

#include "io/store/store.h"

namespace selfcal {

class Journal {
 public:
  /// Lines that wait at most; beyond them the oldest are dropped, and a line says how many.
  static constexpr std::size_t kMostWaiting = 256;

  /// `store` is a connection of its own to the service's store.
  explicit Journal(std::unique_ptr<Store> store);
  /// Writes what waits.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Never blocks for the disk.
  void add(EventRecord event);

 private:
  void write();

  std::unique_ptr<Store> store_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<EventRecord> waiting_;
  std::uint64_t dropped_ = 0;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace selfcal
