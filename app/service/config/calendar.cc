#include "app/service/config/calendar.h"

#include <algorithm>
#include <cstdlib>

#include "app/report/format.h"

namespace selfcal {
namespace {

constexpr std::int64_t kSlack_ms = 60'000;  // a clock that is set right by so much was right
constexpr std::int64_t kHourAhead_ms = 3'600'000;

}  // namespace

void Calendar::recall(std::int64_t last_session_ms, std::int64_t latest_ms) {
  last_ = recalled_last_ = last_session_ms;
  latest_ = std::max(latest_ms, last_session_ms);
}

void Calendar::look(Nanoseconds now, std::int64_t unix_ms) {
  const std::int64_t offset = unix_ms - now / kMillisecond;
  if (!known_) began_ = now;
  const std::int64_t by = known_ ? offset - offset_ : 0;
  const bool doubted = known_ && !believed_;
  unix_ms_ = unix_ms;
  offset_ = offset;
  if (std::abs(by) >= kSet_ms) set_by(by);
  if (!known_ || !believed_) believed_ = unix_ms >= latest_ - kSlack_ms;
  known_ = true;
  if (!believed_ && now - began_ >= kTaken) {
    believed_ = true;
    latest_ = unix_ms;
    if (!last_of_this_life_) session_ended();
  }
  if (!believed_) return;
  if (doubted) set_to_ = unix_ms;
  latest_ = std::max(latest_, unix_ms);
}

void Calendar::set_by(std::int64_t by) {
  // What another life has recorded was so by a clock that was right then.
  const bool moves = by > 0 ? last_of_this_life_ : last_ > unix_ms_ + kHourAhead_ms;
  if (by > 0) set_to_ = unix_ms_;
  if (by < 0) set_to_ = 0;
  if (!believed_) {
    if (last_of_this_life_) last_ += by;
    return;
  }
  if (moves) last_ += by;
  if (by < 0) latest_ = unix_ms_;
}

void Calendar::session_ended() {
  last_ = unix_ms_;
  last_of_this_life_ = true;
}

std::string Calendar::doubt() const {
  if (believed_) return {};
  return "the clock shows " + date_time(unix_ms_) + ", before " + date_time(latest_) +
         ", which is recorded: nothing begins by the clock until it is set";
}

}  // namespace selfcal
