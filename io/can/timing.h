// When frames are expected, and the signs of a second sender.
#pragma once

#include <algorithm>

#include "io/ports.h"

namespace selfcal {

struct CanTiming {
  double cycle = 0;   ///< s, from one frame of a joint to its next; without SYNC
  double window = 0;  ///< s, at most from SYNC to a joint's frame, or between two frames of a joint
  double delay = 0;   ///< s, from the moment a position is taken to the stamp of its frame or SYNC
};

/// Frames are in order when their stamps are but so much apart: the conversion of stamps moves by
/// as much while it gets tighter.
inline constexpr Nanoseconds kStampSlack = 10'000;

/// One frame too many is an accident, one too many cycle after cycle a second sender.
class SenderWatch {
 public:
  /// Tells of each cycle whether there was a frame too many.
  void tell(bool doubled) { level_ = doubled ? std::min(level_ + 4, 20) : std::max(level_ - 1, 0); }
  /// Begins with the fourth in a row or so, and ends when 20 cycles in a row are well.
  bool second() {
    second_ = second_ ? level_ > 0 : level_ > 12;
    return second_;
  }

 private:
  int level_ = 0;
  bool second_ = false;
};

}  // namespace selfcal
