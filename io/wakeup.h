// What a waiting loop is woken by: news from any thread, remembered until somebody waits.
#pragma once

#include <condition_variable>
#include <mutex>

#include "io/ports.h"

namespace selfcal {

class Wakeup {
 public:
  /// There is news. Never blocks for long; may be called from any thread.
  void notify();
  /// Returns true as soon as there has been news since the last wait, false after `longest`.
  bool wait(Nanoseconds longest);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool news_ = false;
};

}  // namespace selfcal
