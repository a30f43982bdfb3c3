// From contact to stop, with nothing else on the way: no disk, no other message, no computation.
//
//   trigger → debounce → stop            in a thread of its own, at real-time priority where
//   allowed
//                      ↘ what was felt → the service's next turn
//
// A move that ends at a contact is guarded from the moment it is asked for: the first closing that
// has settled stops it, whatever the service's loop is doing. The loop hears of it afterwards and
// decides what it means.
#pragma once

#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/service/front_end/debounce.h"

namespace selfcal {

/// What the trigger is and has been, as the loop hears of it.
struct TriggerNews {
  std::vector<Edge> settled;  ///< levels that have held, since the last news, oldest first
  std::optional<bool> level;  ///< the last of them; nothing before the first
  bool known = false;         ///< the port tells its level at the moment
  bool chatters = false;
  int senders = 1;
  std::uint64_t glitches = 0, dropped = 0, strange = 0;
  std::string trouble;  ///< of the port, in a sentence; empty when there is none
  std::string broken;   ///< why the trigger or the stop has failed; empty when it has not
};

class Reflex {
 public:
  /// Watches from now on, in a thread of its own when the ports have a `trigger_clock`. What the
  /// ports point to outlives it.
  Reflex(const Ports& ports, Nanoseconds debounce);
  ~Reflex();
  Reflex(const Reflex&) = delete;
  Reflex& operator=(const Reflex&) = delete;

  /// Asks for a move, which the trigger's next change to `until` stops; at once where it is there
  /// already, though the loop has not heard of it yet.
  Result<void> request(const MotionRequest& request, std::optional<bool> until);
  Result<void> stop(const std::string& why);
  /// The last move has ended: no change of the trigger stops anything before the next one.
  void unguard();
  /// Whether a contact stopped this move: the robot's word that it was stopped is then no refusal.
  bool has_stopped(std::uint64_t id) const { return stopped_ == id; }

  /// For the loop, in every turn. Without a thread it looks at the trigger now.
  TriggerNews take(Nanoseconds now);

  /// Whether the thread has looked at the trigger within the last second.
  bool alive(Nanoseconds now) const { return !thread_.joinable() || now - looked_ < kSecond; }
  /// Longest time from the edge to the stop request beyond the debounce, since the start (ns).
  Nanoseconds slowest() const { return slowest_; }

 private:
  static constexpr std::size_t kMostSettled = 256;

  void watch();
  void look(Nanoseconds now);
  void listen(Nanoseconds now);
  void settle(Nanoseconds now);
  void guard(const Edge& edge);
  void tell();

  Ports ports_;

  // Of whoever looks, the thread or the loop.
  Debouncer debouncer_;
  Nanoseconds quiet_;
  bool known_ = false;
  std::optional<bool> level_;
  std::vector<Edge> edges_;
  std::optional<Edge> settled_;
  std::string broken_;

  std::mutex motion_;          ///< requests and stops in their order
  std::uint64_t guarded_ = 0;  ///< the move that the next change to until_ stops; 0 for none
  bool until_ = true;          ///< closed
  std::optional<bool> held_;   ///< the last level that has settled; nothing before the first

  std::mutex news_mutex_;
  TriggerNews news_;

  std::atomic<std::uint64_t> stopped_ = 0;
  std::atomic<Nanoseconds> looked_ = 0, slowest_ = 0;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace selfcal
