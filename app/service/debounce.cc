#include "app/service/debounce.h"

namespace selfcal {

void Debouncer::begin(bool closed) {
  level_ = raw_ = closed;
  burst_.reset();
}

void Debouncer::add(const Edge& edge, Nanoseconds heard) {
  if (burst_ && raw_ == level_ && edge.time - last_ >= quiet_) {
    ++glitches_;
    burst_.reset();
  }
  if (!burst_ && edge.closed == level_) return;
  if (!burst_) burst_ = edge.time;
  raw_ = edge.closed;
  last_ = edge.time;
  heard_ = heard;
}

std::optional<Edge> Debouncer::settled(Nanoseconds now) {
  if (!burst_ || now - heard_ < quiet_) return std::nullopt;
  const Edge edge{*burst_, raw_};
  burst_.reset();
  if (raw_ == level_) {
    ++glitches_;
    return std::nullopt;
  }
  level_ = raw_;
  return edge;
}

}  // namespace selfcal
