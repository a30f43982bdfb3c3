#include "app/service/front_end/debounce.h"

#include <algorithm>

namespace selfcal {

void Debouncer::begin(bool closed) {
  level_ = raw_ = closed;
  burst_.reset();
  ends_.clear();
}

void Debouncer::add(const Edge& edge, Nanoseconds heard) {
  if (burst_ && raw_ == level_ && edge.time - last_ >= quiet_) {
    ++glitches_;
    end_burst(heard);
  }
  if (!burst_ && edge.closed == level_) return;
  if (!burst_) {
    burst_ = edge.time;
    timed_ = edge.timed;
    burst_heard_ = heard;
  }
  raw_ = edge.closed;
  last_ = edge.time;
  heard_ = heard;
}

void Debouncer::end_burst(Nanoseconds now) {
  burst_.reset();
  ends_.push_back(now);
  if (ends_.size() > kChatter) ends_.pop_front();
}

void Debouncer::reconcile(bool closed, Nanoseconds now) {
  if (!burst_ && closed != level_) add({now, closed, false}, now);
}

std::optional<Nanoseconds> Debouncer::settles_in(Nanoseconds now) const {
  if (!burst_) return std::nullopt;
  const Nanoseconds closed = level_ ? heard_ + quiet_ : burst_heard_ + 5 * quiet_;
  return std::max<Nanoseconds>(0, std::min(heard_ + quiet_, closed) - now);
}

std::optional<Edge> Debouncer::settled(Nanoseconds now) {
  if (!burst_) return std::nullopt;
  const bool chatters = !level_ && now - burst_heard_ >= 5 * quiet_;
  if (now - heard_ < quiet_) {
    if (!chatters) return std::nullopt;
    raw_ = true;
  }
  const Edge edge{*burst_, raw_, timed_};
  end_burst(now);
  if (raw_ == level_) {
    ++glitches_;
    return std::nullopt;
  }
  level_ = raw_;
  return edge;
}

}  // namespace selfcal
