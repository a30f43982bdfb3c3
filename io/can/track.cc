// One joint's counts from frame to frame.
//
// A counter of n steps per turn gives counts modulo n. The count nearest to the last one is taken,
// and the first is the one nearest to the joint's zero: a joint that travels less than half a turn
// of its counter to either side of its zero is known at once, whatever turn it is in.

#include "io/can/track.h"

#include <algorithm>
#include <cmath>

namespace selfcal {
namespace {

// Stamps of a steady sender differ from steady times by the bus's arbitration and the interrupt:
// half as fast again, and two counts, is still no jump.
constexpr double kJitter = 1.5, kFlicker = 2;

// The number equal to `raw` modulo `n` that is nearest to `near`.
std::int64_t nearest(std::int64_t raw, std::int64_t near, std::int64_t n) {
  std::int64_t apart = (raw % n - near % n) % n;
  if (apart < 0) apart += n;
  if (apart > n / 2) apart -= n;
  return near + apart;
}

}  // namespace

double JointTrack::reach(Nanoseconds span) const {
  return joint_->most_speed * std::max(seconds(span), 0.0) / std::abs(joint_->scale.step);
}

JointTrack::Step JointTrack::add(std::int64_t raw, Nanoseconds t) {
  const std::int64_t n = joint_->wraps_at;
  const std::int64_t before = known_ ? counts_ : joint_->scale.zero;
  counts_ = n > 0 ? nearest(raw, before, n) : raw;
  const double reached = reach(t - time_);
  const bool was_known = known_;
  known_ = true;
  time_ = t;
  if (!was_known) return Step::first;
  if (n > 0 && reached > static_cast<double>(n) / 2) return Step::guessed;
  const double moved = std::abs(static_cast<double>(counts_) - static_cast<double>(before));
  return moved > kJitter * reached + kFlicker ? Step::jumped : Step::follows;
}

void note_step(CanFaults& faults, JointTrack::Step step, const std::string& joint, Nanoseconds t) {
  if (step == JointTrack::Step::jumped) faults.note(CanFault::jumped, t, joint);
  if (step == JointTrack::Step::guessed) faults.note(CanFault::turns_unknown, t, joint);
}

}  // namespace selfcal
