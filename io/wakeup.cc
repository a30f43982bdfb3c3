// What a waiting loop is woken by.

#include "io/wakeup.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace selfcal {

void Wakeup::notify() {
  {
    const std::lock_guard lock(mutex_);
    news_ = true;
  }
  changed_.notify_all();
}

bool Wakeup::wait(Nanoseconds longest) {
  // Longer than a year would overflow the end of the wait.
  constexpr Nanoseconds kLongest = 366 * 24 * 3600 * kSecond;
  const std::chrono::nanoseconds limit(std::clamp<Nanoseconds>(longest, 0, kLongest));
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, limit, [this] { return news_; });
  return std::exchange(news_, false);
}

}  // namespace selfcal
