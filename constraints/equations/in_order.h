// Work in parts on several processors whose results are put together in one order: sums are the
// same to the last bit however many there are.
#pragma once

#include <algorithm>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace selfcal {

/// Processors that this process may run on when it first asks (taskset and CPUAffinity= bound
/// them), at most eight.
inline int processors() {
  static const int count = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 8);
  return count;
}

/// Calls make(i) of each i below `count`, up to `at_once` at a time, and take(i, what it gave) of
/// one after another in their order.
template <class Make, class Take>
void in_order(int count, int at_once, const Make& make, const Take& take) {
  std::mutex mutex;
  std::map<int, decltype(make(0))> waiting;
  int begun = 0, taken = 0;
  const auto work = [&] {
    std::unique_lock lock(mutex);
    while (begun < count) {
      const int i = begun++;
      lock.unlock();
      auto made = make(i);
      lock.lock();
      waiting.emplace(i, std::move(made));
      for (auto next = waiting.begin(); next != waiting.end() && next->first == taken;
           next = waiting.begin(), ++taken) {
        take(taken, std::move(next->second));
        waiting.erase(next);
      }
    }
  };
  std::vector<std::jthread> others;
  for (int k = 1; k < std::min(count, at_once); ++k) others.emplace_back(work);
  work();
}

}  // namespace selfcal
