// From frames of single joints to samples of all: complete, or not there at all.
//
// With SYNC every joint takes its position when SYNC arrives and sends it afterwards: the sample's
// time is SYNC's, the same for all joints, and nothing is interpolated (io/can/synced.h). Without,
// each joint sends when it likes, and all are interpolated to the stamps of one of them
// (io/can/free_running.h).
//
// Pure: frames and their times in, samples and faults out.
#pragma once

#include <variant>
#include <vector>

#include "io/can/free_running.h"
#include "io/can/synced.h"

namespace selfcal {

class CanAssembler {
 public:
  /// `map` (finished) and `faults` must outlive it.
  CanAssembler(const CanMap& map, const CanTiming& timing, CanFaults& faults);

  /// Takes the next frame of the bus, of time `t` on the time base, and appends what it completes.
  /// Frames that the map does not name are passed over.
  void add(const CanFrame& frame, Nanoseconds t, std::vector<EncoderSample>& out);
  /// Frames may be missing from here on: nothing from before is put together with what follows.
  void interrupt();
  /// Cycles that gave no sample, for whatever reason.
  std::uint64_t incomplete() const;

 private:
  CanFaults* faults_;
  std::variant<SyncedCycles, FreeRunning> way_;
};

}  // namespace selfcal
