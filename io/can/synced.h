// Samples of joints that take their positions at SYNC (CiA 301, synchronous TPDOs).
//
// A cycle lasts from SYNC to SYNC. It is judged at its end, when it is known that no joint has sent
// twice; the sample so comes one cycle late, which costs nothing, since a reading at an edge is
// interpolated between two samples anyway.
#pragma once

#include <optional>
#include <vector>

#include "io/can/faults.h"
#include "io/can/map.h"
#include "io/can/timing.h"
#include "io/can/track.h"

namespace selfcal {

class SyncedCycles {
 public:
  SyncedCycles(const CanMap& map, const CanTiming& timing, CanFaults& faults);

  void add(const CanFrame& frame, Nanoseconds t, std::vector<EncoderSample>& out);
  void interrupt();
  std::uint64_t incomplete() const { return incomplete_; }

 private:
  struct Slot {
    bool filled = false, doubled = false;
    CanFrame frame;
    SenderWatch watch;
  };
  void begin(Nanoseconds t);
  void end(std::vector<EncoderSample>& out);
  void put(std::size_t message, const CanFrame& frame, Nanoseconds t);
  bool in_window(std::size_t message, Nanoseconds t);
  void watch_senders();
  bool all_there();
  bool follow(EncoderSample& sample);
  std::string name(std::size_t message) const;

  const CanMap* map_;
  CanFaults* faults_;
  Nanoseconds window_, delay_;
  std::vector<Slot> slots_;  ///< by message
  std::vector<JointTrack> tracks_;
  std::optional<Nanoseconds> sync_;  ///< when the cycle began
  Nanoseconds period_ = 0;           ///< of the last SYNCs, smoothed; 0: not known
  Nanoseconds newest_ = 0;
  bool spoilt_ = false, broke_off_ = false;
  std::uint64_t incomplete_ = 0;
};

}  // namespace selfcal
