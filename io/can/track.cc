// One joint's counts from frame to frame.
//
// A counter of n steps per turn gives counts modulo n. The count nearest to the last one is taken,
// and the first is the one nearest to the joint's zero: a joint that travels less than half a turn
// of its counter to either side of its zero is known at once, whatever turn it is in. One that
// travels farther must stand there at the start; what may have turned unseen is not known again.

#include "io/can/track.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace selfcal {
namespace {

// Stamps of a steady sender differ from steady times by the bus's arbitration and the interrupt:
// half as fast again, and two counts, is still no jump.
constexpr double kJitter = 1.5, kFlicker = 2;

}  // namespace

double JointTrack::reach(Nanoseconds span) const {
  return joint_->most_speed * std::max(seconds(span), 0.0) / std::abs(joint_->scale.step);
}

bool JointTrack::reachable(std::int64_t before, std::int64_t after, Nanoseconds span) const {
  const double moved = std::abs(static_cast<double>(after) - static_cast<double>(before));
  return moved <= kJitter * reach(span) + kFlicker;
}

// The number equal to `raw` modulo the counter's steps that is nearest to `near`.
std::int64_t JointTrack::nearest(std::int64_t raw, std::int64_t near) const {
  const std::int64_t n = joint_->wraps_at;
  if (n <= 0) return raw;
  std::int64_t apart = (raw % n - near % n) % n;
  if (apart < 0) apart += n;
  if (apart > n / 2) apart -= n;
  return near + apart;
}

JointTrack::Step JointTrack::add(std::int64_t raw, Nanoseconds t) {
  const std::int64_t before = known_ ? counts_ : joint_->scale.zero;
  const Nanoseconds span = t - time_;
  time_ = t;
  counts_ = nearest(raw, joint_->within_one_turn ? joint_->scale.zero : before);
  const std::int64_t back = nearest(raw, trusted_);
  if (jumped_ && std::abs(back - trusted_) < std::abs(counts_ - before) &&
      reachable(trusted_, back, t - trusted_time_)) {
    jumped_ = false;
    trust(back);
    return Step::back;
  }
  if (!std::exchange(known_, true)) {
    trust(counts_);
    return Step::first;
  }
  const bool believed = std::exchange(broke_off_, false);
  if (believed) jumped_ = false;
  if (believed || reachable(before, counts_, span)) {
    const bool guessed = joint_->wraps_at > 0 && !joint_->within_one_turn &&
                         reach(span) > static_cast<double>(joint_->wraps_at) / 2;
    trust(counts_);
    if (std::exchange(jumped_, false)) return Step::stayed;
    return guessed ? Step::guessed : Step::follows;
  }
  jumped_ = true;
  return Step::jumped;
}

void JointTrack::trust(std::int64_t counts) {
  counts_ = trusted_ = counts;
  trusted_time_ = time_;
}

void note_step(CanFaults& faults, JointTrack::Step step, const std::string& joint, Nanoseconds t) {
  if (step == JointTrack::Step::jumped) faults.note(CanFault::jumped, t, joint);
  if (step == JointTrack::Step::stayed) faults.set(CanFault::zero_lost, true, t, joint);
  if (step == JointTrack::Step::guessed) faults.set(CanFault::turns_unknown, true, t, joint);
}

}  // namespace selfcal
