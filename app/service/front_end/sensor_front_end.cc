#include "app/service/front_end/sensor_front_end.h"

#include <algorithm>

namespace selfcal {
namespace {

constexpr Nanoseconds kRestSpan = 20 * kMillisecond;

Event event_of(Event::What what, Nanoseconds now, std::string why = {}) {
  Event event;
  event.what = what;
  event.now = now;
  event.why = std::move(why);
  return event;
}

}  // namespace

void SensorFrontEnd::listen(Nanoseconds now, std::deque<Event>& events) {
  listen_to_encoders(now, events);
  listen_to_trigger(now, events);
  listen_to_motion(now, events);
}

void SensorFrontEnd::listen_to_encoders(Nanoseconds now, std::deque<Event>& events) {
  new_samples_.clear();
  if (const auto taken = ports_.encoders->take(new_samples_); !taken)
    events.push_back(event_of(Event::What::broken, now, taken.error().what));
  for (const EncoderSample& sample : new_samples_) {
    if (!samples_.empty()) period_ = sample.time - samples_.last().time;
    if (samples_.add(sample)) heard_ = now;
  }
  counted_ += new_samples_.size();
  if (now - counted_from_ >= kSecond) {
    rate_ = static_cast<double>(counted_) / seconds(now - counted_from_);
    counted_from_ = now;
    counted_ = 0;
  }
}

void SensorFrontEnd::listen_to_trigger(Nanoseconds now, std::deque<Event>& events) {
  trigger_ = reflex_.take(now);
  if (!trigger_.broken.empty())
    events.push_back(event_of(Event::What::broken, now, trigger_.broken));
  for (const Edge& edge : trigger_.settled) {
    if (edge.closed && !closing_) closing_ = edge;
    events.push_back(event_of(edge.closed ? Event::What::closed : Event::What::opened, now));
  }
}

void SensorFrontEnd::listen_to_motion(Nanoseconds now, std::deque<Event>& events) {
  new_replies_.clear();
  if (const auto taken = ports_.motion->take(new_replies_); !taken)
    events.push_back(event_of(Event::What::broken, now, taken.error().what));
  for (const MotionReply& reply : new_replies_) {
    if (reply.id != expected_ || expected_ == 0) continue;
    if (reply.outcome == MotionReply::Outcome::accepted) continue;
    if (reply.outcome == MotionReply::Outcome::stopped && reflex_.has_stopped(reply.id)) continue;
    expected_ = 0;
    const bool done = reply.outcome == MotionReply::Outcome::done;
    events.push_back(event_of(done ? Event::What::moved : Event::What::refused, now, reply.why));
  }
}

std::optional<bool> SensorFrontEnd::at_rest() const {
  return samples_.at_rest(ports_.encoders->scales(), units_, rest_,
                          std::max(kRestSpan, 4 * period_));
}

std::optional<Eigen::VectorXd> SensorFrontEnd::q() const {
  if (samples_.empty()) return std::nullopt;
  return reading_of(samples_.last(), ports_.encoders->scales());
}

}  // namespace selfcal
