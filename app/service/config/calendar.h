// The wall clock as far as it can be believed, beside the monotonic one, which is never set.
//
// A computer without a clock of its own begins with an old time and learns the true one later. A
// clock that shows a time before the latest one that is recorded is not believed until it has been
// set, or nobody has set it for a day.
#pragma once

#include <cstdint>
#include <string>

#include "io/ports.h"

namespace selfcal {

class Calendar {
 public:
  /// A change of the wall clock against the monotonic one that somebody has made.
  static constexpr std::int64_t kSet_ms = 10 * 60'000;
  /// A clock that is not believed is taken as it is when nobody has set it for so long.
  static constexpr Nanoseconds kTaken = 24 * 3600 * kSecond;

  /// What earlier lives have recorded (ms since 1970, 0 for nothing): when the last session ended,
  /// and the latest moment that had come.
  void recall(std::int64_t last_session_ms, std::int64_t latest_ms);
  /// What both clocks show now. Where the wall clock was set, what this life has recorded is as
  /// long ago as it was.
  void look(Nanoseconds now, std::int64_t unix_ms);
  /// The schedule counts from now.
  void session_ended();

  bool believed() const { return believed_; }
  /// Why the clock is not believed; empty where it is.
  std::string doubt() const;
  /// As the wall clock counts; 0 before the first.
  std::int64_t last_session_ms() const { return last_; }
  /// The clock was set forward to this moment, and no time of day before it has come; 0: never.
  std::int64_t set_to_ms() const { return set_to_; }
  /// What a later life is to recall: nothing that a clock has told which is not believed.
  std::int64_t last_session_to_keep_ms() const { return believed_ ? last_ : recalled_last_; }
  std::int64_t latest_ms() const { return latest_; }

 private:
  void set_by(std::int64_t by);

  bool known_ = false, believed_ = true;
  Nanoseconds began_ = 0;     ///< of the first look
  std::int64_t unix_ms_ = 0;  ///< of the last look
  std::int64_t offset_ = 0;   ///< wall clock less the monotonic one (ms), at the last look
  std::int64_t last_ = 0;     ///< session's end
  bool last_of_this_life_ = false;
  std::int64_t recalled_last_ = 0;
  std::int64_t latest_ = 0;
  std::int64_t set_to_ = 0;
};

}  // namespace selfcal
