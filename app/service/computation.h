// One long computation at a time, beside the loop that must never stop listening.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace selfcal {

class Computation {
 public:
  /// Called by the job now and then with its stage and the share done (0 to 1).
  using Tell = std::function<void(std::string_view stage, double share)>;
  /// Returns what went wrong, or nothing. It must end by itself.
  using Job = std::function<std::string(const Tell&)>;

  ~Computation();
  /// Waits for a job that was given up before it starts the next.
  void start(Job job);
  /// Its outcome is no longer asked for; it ends at the next word it tells.
  void give_up() {
    wanted_ = false;
    given_up_ = true;
  }
  bool running() const { return running_; }
  /// True once, when the job that was asked for has ended; `failure` is what it returned.
  bool take(std::string& failure);

  struct Progress {
    std::string stage;
    double share = 0;
  };
  Progress progress() const;

 private:
  std::thread thread_;
  std::atomic<bool> running_ = false, given_up_ = false;
  bool wanted_ = false;
  mutable std::mutex mutex_;
  Progress progress_;
  std::string failure_;
};

}  // namespace selfcal
