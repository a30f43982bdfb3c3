// Samples of joints that send whenever they like.
//
// The stamps of the first message of the map are the samples' times; every other joint is
// interpolated between its two frames around them. That is exact at a steady speed and off by
// a t^2 / 8 under an acceleration a over the time t between them: 1.3 urad for 10 rad/s^2 at 1 kHz,
// where the mean of the stamps as a common time would be off by the speed times half the spread of
// the stamps, 2.5 urad already at 0.01 rad/s and 0.5 ms.
//
// Whether a frame is one too many is told by the configured cycle and not by the frames: with a
// second sender half a cycle apart a learned cycle would halve and all look well.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "io/can/faults.h"
#include "io/can/map.h"
#include "io/can/timing.h"
#include "io/can/track.h"

namespace selfcal {

class FreeRunning {
 public:
  FreeRunning(const CanMap& map, const CanTiming& timing, CanFaults& faults);

  void add(const CanFrame& frame, Nanoseconds t, std::vector<EncoderSample>& out);
  void interrupt();
  std::uint64_t incomplete() const { return incomplete_; }

 private:
  /// The frames of one message.
  struct Stream {
    bool known = false;   ///< `last` is there
    bool broken = false;  ///< nothing may be interpolated from `last` on
    CanFrame last;
    Nanoseconds time = 0;
    std::vector<std::int64_t> counts, before;  ///< of its joints, now and at `before_time`
    Nanoseconds before_time = 0;
    std::int64_t told = 0;  ///< cycles of silence that were told as missing
    SenderWatch watch;
  };
  /// A sample that waits for the frames after its time.
  struct Pending {
    EncoderSample sample;
    std::uint32_t waits_for = 0;  ///< a bit for each message
    bool spoilt = false;
  };
  bool accept(std::size_t message, const CanFrame& frame, Nanoseconds t);
  bool repeated(std::size_t message, const CanFrame& frame, Nanoseconds t);
  bool follow(std::size_t message, const CanFrame& frame, Nanoseconds t);
  void resolve(std::size_t message);
  void begin(Nanoseconds t);
  void give_up(Nanoseconds t);
  void emit(std::vector<EncoderSample>& out);
  void watch_senders(Nanoseconds t);
  void note_gap(std::size_t message, Nanoseconds gap, Nanoseconds t);
  void note_silence(Nanoseconds t);
  std::string name(std::size_t message) const;

  const CanMap* map_;
  CanFaults* faults_;
  Nanoseconds cycle_, window_, delay_;
  std::vector<Stream> streams_;  ///< by message
  std::vector<JointTrack> tracks_;
  std::deque<Pending> pending_;
  std::optional<Nanoseconds> started_;  ///< silence before it says nothing
  std::uint64_t incomplete_ = 0;
  bool broke_off_ = false;  ///< since the last sample
};

}  // namespace selfcal
