// What goes wrong on a bus: counted, and said in a sentence while it lasts.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/can/frame.h"
#include "io/ports.h"

namespace selfcal {

enum class CanFault : std::uint8_t {
  missing,         ///< a joint had no frame in a cycle
  late,            ///< a joint's frame came too long after SYNC or after its last one
  duplicated,      ///< a second frame of one id in a cycle
  out_of_order,    ///< a frame stamped before the one that came before it
  malformed,       ///< a payload too short, or FD where classic was said or the reverse
  jumped,          ///< a count moved faster than the joint can
  zero_lost,       ///< a count jumped and went on from there: its zero is another one
  turns_unknown,   ///< a counter may have begun anew unseen while its joint was silent
  second_sender,   ///< an id has two frames cycle after cycle
  overrun,         ///< frames lost in the socket's queue or in the controller
  error_frame,     ///< the controller met errors on the bus
  error_passive,   ///< it met many
  bus_off,         ///< it met so many that it left the bus
  restarted,       ///< it came back
  interface_down,  ///< the interface is down or gone
  time_stepped,    ///< the wall clock stepped: frames around it are dropped
};
inline constexpr int kCanFaults = 16;
std::string_view to_string(CanFault fault);

/// Not thread-safe. Times are of the time base.
class CanFaults {
 public:
  /// A fault that comes and goes is in trouble() as long as it was met this recently.
  static constexpr Nanoseconds kRecent = kSecond;

  explicit CanFaults(std::string interface) : interface_(std::move(interface)) {}

  /// `what` is the joint or the id it concerns, or more of it; `times` may be above 1.
  void note(CanFault fault, Nanoseconds now, std::string what = {}, std::uint64_t times = 1);
  /// Begins or ends what lasts: bus_off, error_passive, interface_down, second_sender; zero_lost
  /// and turns_unknown never end. Each beginning is counted.
  void set(CanFault fault, bool lasts, Nanoseconds now, std::string what = {});
  bool lasts(CanFault fault) const { return of(fault).lasts; }
  /// While these last no sample can be trusted.
  bool readings_are_doubtful() const {
    return lasts(CanFault::second_sender) || lasts(CanFault::zero_lost) ||
           lasts(CanFault::turns_unknown);
  }
  /// Reads the controller's report.
  void note_error_frame(const CanFrame& frame, Nanoseconds now);

  std::uint64_t count(CanFault fault) const { return of(fault).count; }
  std::vector<Tally> tallies() const;
  /// What an owner should know of the readings at the moment, in a sentence; empty when there is
  /// nothing. A single lost frame or error is not told: what it touches is no sample.
  std::string trouble(Nanoseconds now) const;

 private:
  struct Entry {
    std::uint64_t count = 0;
    double recent = 0;  ///< decays by 1/e in kRecent
    Nanoseconds last = 0;
    bool lasts = false;
    std::string what;
  };
  static double recent(const Entry& entry, Nanoseconds now);
  Entry& of(CanFault fault) { return entries_[static_cast<std::size_t>(fault)]; }
  const Entry& of(CanFault fault) const { return entries_[static_cast<std::size_t>(fault)]; }

  std::string interface_;
  std::array<Entry, kCanFaults> entries_;
};

}  // namespace selfcal
