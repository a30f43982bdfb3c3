// From a sender's clock to ours, by one offset for all its topics.
//
// Messages carry the sender's stamps, on a clock of the sender's choice. Their differences say
// where the robot was at the moment of touch and must stay exact, so the offset is taken once,
// from the arrival of the first joint state, and kept: all stamps share its error, the time that
// the message was under way. Only when the sender's clock has stepped by more than a second is it
// taken anew. Clocks of two computers drift apart by up to a tenth of a second in an hour, which no
// touch notices: its edge and its samples share the offset. A drift of a second counts as a step.
#pragma once

#include <atomic>
#include <optional>

#include "io/ports.h"

namespace selfcal {

/// One thread observes; any may ask.
class TimeMapping {
 public:
  static constexpr Nanoseconds kStep = kSecond;

  /// Tells when the newest message arrived (ours), with its stamp (the sender's). True when the
  /// sender's clock has stepped: stamps before this one do not compare with those after it.
  bool observe(Nanoseconds stamp, Nanoseconds arrived);
  /// A sender's stamp on our time base; nothing before the first observe().
  std::optional<Nanoseconds> ours(Nanoseconds stamp) const;
  /// How often the sender's clock has stepped.
  std::uint64_t steps() const { return steps_; }

 private:
  std::atomic<bool> known_ = false;
  std::atomic<Nanoseconds> offset_ = 0;
  std::uint64_t steps_ = 0;
};

}  // namespace selfcal
