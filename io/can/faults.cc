// What goes wrong on a bus.

#include "io/can/faults.h"

#include <linux/can/error.h>

#include <cmath>

namespace selfcal {
namespace {

struct Telling {
  std::string_view name;
  std::string_view sentence;  ///< what is the matter
  double enough;              ///< this many recent ones are trouble; 0: only while it lasts
};

// One lost frame costs one sample of hundreds: three in a second are no accident any more.
constexpr double kSeveral = 2.5, kMany = 10, kOne = 0.3;
constexpr std::array<Telling, kCanFaults> kTellings = {{
    {"missing", "frames are missing", kSeveral},
    {"late", "frames come late", kSeveral},
    {"duplicated", "frames come twice", kSeveral},
    {"out_of_order", "frames come out of order", kSeveral},
    {"malformed", "frames are not as the map says", kOne},
    {"jumped", "a counter jumped", kOne},
    {"zero_lost", "a counter jumped and stayed: find its zero, then restart the service", 0},
    {"turns_unknown",
     "turns may have been missed: bring it near its zero, then restart the service", 0},
    {"second_sender", "a second sender", 0},
    {"overrun", "frames were lost in the queue", kOne},
    {"error_frame", "errors on the bus", kMany},
    {"error_passive", "the controller is error passive", 0},
    {"bus_off", "the controller is off the bus", 0},
    {"restarted", "the controller restarted", kOne},
    {"interface_down", "the interface is down", 0},
    {"time_stepped", "the wall clock stepped", kOne},
}};

}  // namespace

std::string_view to_string(CanFault fault) {
  return kTellings[static_cast<std::size_t>(fault)].name;
}

double CanFaults::recent(const Entry& entry, Nanoseconds now) {
  return entry.recent * std::exp(-static_cast<double>(now - entry.last) / kRecent);
}

void CanFaults::note(CanFault fault, Nanoseconds now, std::string what, std::uint64_t times) {
  Entry& entry = of(fault);
  entry.count += times;
  entry.recent = recent(entry, now) + static_cast<double>(times);
  entry.last = now;
  entry.what = std::move(what);
}

void CanFaults::set(CanFault fault, bool lasts, Nanoseconds now, std::string what) {
  if (lasts && !of(fault).lasts)
    note(fault, now, std::move(what));
  else if (lasts)
    of(fault).what = std::move(what);
  of(fault).lasts = lasts;
}

void CanFaults::note_error_frame(const CanFrame& frame, Nanoseconds now) {
  const std::uint32_t classes = frame.id.value;
  note(CanFault::error_frame, now);
  if (classes & CAN_ERR_CRTL) {
    const std::uint8_t state = frame.data[1];
    if (state & CAN_ERR_CRTL_RX_OVERFLOW)
      note(CanFault::overrun, now, "in the controller, how many is not known");
    const bool warning = state & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING);
    const bool passive = state & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE);
    if (passive) set(CanFault::error_passive, true, now);
    if ((state & CAN_ERR_CRTL_ACTIVE) || (warning && !passive))
      set(CanFault::error_passive, false, now);
  }
  if (classes & CAN_ERR_BUSOFF) set(CanFault::bus_off, true, now);
  if (classes & CAN_ERR_RESTARTED) {
    set(CanFault::bus_off, false, now);
    set(CanFault::error_passive, false, now);
    note(CanFault::restarted, now);
  }
}

std::vector<Tally> CanFaults::tallies() const {
  std::vector<Tally> tallies;
  for (int i = 0; i < kCanFaults; ++i) tallies.push_back({kTellings[i].name, entries_[i].count});
  return tallies;
}

std::string CanFaults::trouble(Nanoseconds now) const {
  std::string all;
  for (int i = 0; i < kCanFaults; ++i) {
    const Telling& telling = kTellings[i];
    const Entry& entry = entries_[i];
    const bool enough = telling.enough > 0 && recent(entry, now) >= telling.enough;
    if (!entry.lasts && !enough) continue;
    all += all.empty() ? interface_ + ": " : "; ";
    all += telling.sentence;
    if (!entry.what.empty()) all += " (" + entry.what + ")";
  }
  return all;
}

}  // namespace selfcal
