// What the parts of the service share: the configuration, the world outside, the parameters in use,
// the state, and the events on their way to the transition.
#pragma once

#include <deque>
#include <string>
#include <string_view>

#include "app/service/config/calendar.h"
#include "app/service/config/config.h"
#include "app/service/config/schedule.h"
#include "app/service/loop/journal.h"
#include "app/service/models/models.h"
#include "app/service/transitions/transition.h"
#include "io/messages.h"

namespace selfcal {

/// How much the robot has been used, which outlives a restart.
struct Usage {
  Calendar calendar;
  double motion_hours = 0;
  /// At the last session.
  double motion_hours_then = 0;
  std::optional<double> temperature_then;
  int checks = 0;  ///< since the last full one
};

/// Names under which the store remembers: the session that is to follow by itself; whether a move
/// of ours may be under way.
inline constexpr const char* kWanted = "wanted";
inline constexpr const char* kMoves = "moves";
/// What the reason of a fault begins with where the store has failed.
inline constexpr std::string_view kStoreFailed = "store: ";

/// All references outlive it.
struct ServiceContext {
  Config config;
  Ports ports;
  Messenger& messenger;
  Store& store;
  Journal& journal;
  Models models;
  ExtendedState extended_state = {};
  Usage use = {};
  std::deque<Event> events = {};
  std::uint64_t lost_events = 0;  ///< since the start
  Nanoseconds now = 0;            ///< of the turn
  /// What was told last, the newest first.
  struct Told {
    std::string text;
    Nanoseconds at = 0;
  };
  std::deque<Told> told = {};
  std::deque<Told> store_told = {};  ///< of a store that fails, in the log
  /// False for a sentence that is not in `list` since `within`: it is from then on.
  bool told_lately(std::deque<Told>& list, const std::string& text, Nanoseconds within) const;

  /// Of more than 1024 that wait the others are lost, which is a fault.
  void put(Event event);
  void put(Event::What what, bool ok = true, std::string why = {});
  /// False, with a fault on its way, when the store has failed.
  template <class T>
  bool stored(const Result<T>& result) {
    return result ? true : store_failed(result.error());
  }
  /// To the log and, the same sentence once an hour at most, to the store.
  void tell(const std::string& level, const std::string& text);
  /// The same each time.
  void record(const std::string& level, const std::string& text);
  std::int64_t unix_ms() const { return ports.clock->unix_ms(); }
  /// The session behind the active parameters is there for a quick check to compare with.
  bool can_compare() const;
  /// Of what the touches mean; see session.h.
  std::string config_hash() const;
  /// What the schedule is measured against; whether a check is possible is for others to say.
  Since since() const;
  /// Keeps how much the robot has been used.
  void remember_use();
  /// Keeps the store within its bound. That it cannot is no reason to stop.
  void prune();

 private:
  bool store_failed(const Failure& failure);
};

}  // namespace selfcal
