// One long computation at a time, beside the loop that must never stop listening.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

namespace selfcal {

class Computation {
 public:
  /// Called by the job now and then with its stage and the share done (0 to 1). Does not return to
  /// a job that was given up.
  using Tell = std::function<void(std::string_view stage, double share)>;
  /// Returns what went wrong, or nothing. It must end by itself.
  using Job = std::function<std::string(const Tell&)>;

  Computation() = default;
  /// Waits for the job under way to end, which it does at the next word it tells.
  ~Computation();
  Computation(const Computation&) = delete;
  Computation& operator=(const Computation&) = delete;

  /// Gives up what is under way; this one begins as soon as that has ended. Never waits.
  void start(Job job);
  /// The outcome of the last job is no longer asked for.
  void give_up();
  /// The last job that was started, and not given up, has not ended.
  bool running() const;
  /// True once, when that job has ended; `failure` is what it returned.
  bool take(std::string& failure);

  struct Progress {
    std::string stage;
    double share = 0;
  };
  Progress progress() const;

 private:
  void work();
  std::string run(const Job& job, std::uint64_t number);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Job> waiting_;
  std::uint64_t last_ = 0;    ///< number of the last job that was started
  std::uint64_t wanted_ = 0;  ///< the one whose outcome is asked for; 0 for none
  std::uint64_t done_ = 0;    ///< the last one that has ended
  bool ending_ = false;
  Progress progress_;
  std::string failure_;
  std::thread thread_;
};

}  // namespace selfcal
