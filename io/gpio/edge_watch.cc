// From what the kernel reports of a line to edges that alternate, with what was lost on the way.

#include "io/gpio/edge_watch.h"

#include <cstdlib>

namespace selfcal {
namespace {

// No edge waits so long to be read; kernels before 5.7 stamp with CLOCK_REALTIME.
constexpr Nanoseconds kOldest = 60 * kSecond;

}  // namespace

void EdgeWatch::add(const std::vector<LineEvent>& events, Nanoseconds now, std::vector<Edge>& out) {
  for (const LineEvent& event : events) {
    const bool numbered = event.number > 0 && number_ > 0;
    const std::uint64_t skipped =
        numbered && event.number > number_ ? event.number - number_ - 1 : 0;
    number_ = event.number;
    lost_ += skipped;
    gap_ = gap_ || skipped > 0;
    if (skipped > 0) overran_ = now;
    foreign_ = std::abs(now - event.time) > kOldest;
    const Nanoseconds time = foreign_ ? now : event.time;
    const bool timed = !gap_ && !foreign_;
    if (event.closed == level_) {
      // It has been away and back; after a gap that is counted already.
      if (!gap_) ++lost_;
      out.push_back({time, !event.closed, timed});
    }
    out.push_back({time, event.closed, timed});
    level_ = event.closed;
    count(time);
    gap_ = false;
  }
  // What came while the queue was full is gone, and nothing says so: an even number leaves the
  // level right.
  gap_ = events.size() >= kQueue && events.back().number == 0;
  if (gap_) {
    ++lost_;
    overran_ = now;
  }
  mismatch_ = false;
}

void EdgeWatch::check(bool closed, Nanoseconds now, std::vector<Edge>& out) {
  if (closed == level_) {
    gap_ = mismatch_ = false;
    return;
  }
  if (!mismatch_) {
    mismatch_ = true;
    return;
  }
  if (!gap_) ++lost_;
  gap_ = mismatch_ = false;
  level_ = closed;
  out.push_back({now, closed, false});
}

void EdgeWatch::count(Nanoseconds time) {
  if (!changes_.empty() && time - changes_.back() < kBounce) return;
  changes_.push_back(time);
  if (changes_.size() > kChatter) changes_.pop_front();
  if (changes_.size() == kChatter && time - changes_.front() <= kChatterSpan) chattered_ = time;
}

std::optional<bool> EdgeWatch::closed(Nanoseconds now) const {
  if (now - began_ < kWatchFirst) return std::nullopt;
  return level_;
}

std::string EdgeWatch::trouble(Nanoseconds now) const {
  if (foreign_) return "the kernel stamps edges by another clock: Linux 5.7 or newer is needed";
  if (chattered_ && now - *chattered_ < kTellFor)
    return "the trigger chatters, more than 80 changes a second: a loose wire, or no bias?";
  if (overran_ && now - *overran_ < kTellFor)
    return "more edges came at once than the kernel keeps: some are lost";
  return {};
}

}  // namespace selfcal
