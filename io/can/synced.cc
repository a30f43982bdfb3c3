// Samples of joints that take their positions at SYNC.

#include "io/can/synced.h"

#include <algorithm>
#include <utility>

namespace selfcal {

SyncedCycles::SyncedCycles(const CanMap& map, const CanTiming& timing, CanFaults& faults)
    : map_(&map),
      faults_(&faults),
      window_(nanoseconds(timing.window)),
      delay_(nanoseconds(timing.delay)),
      slots_(map.messages.size()) {
  for (const CanJoint& joint : map.joints) tracks_.emplace_back(joint);
}

void SyncedCycles::add(const CanFrame& frame, Nanoseconds t, std::vector<EncoderSample>& out) {
  if (t + kStampSlack < newest_) {
    // On which side of a SYNC it belongs nobody can tell.
    faults_->note(CanFault::out_of_order, t, to_string(frame.id));
    spoilt_ = true;
    return;
  }
  newest_ = std::max(newest_, t);
  if (frame.id == *map_->sync) {
    if (sync_ && t <= *sync_) {  // two at once: no cycle lies between them
      faults_->note(CanFault::duplicated, t, "SYNC");
      spoilt_ = true;
      return;
    }
    end(out);
    begin(t);
    return;
  }
  const int message = map_->find(frame.id);
  if (message >= 0) put(static_cast<std::size_t>(message), frame, t);
}

void SyncedCycles::interrupt() {
  if (sync_) ++incomplete_;
  broke_off_ = true;
  for (JointTrack& track : tracks_) track.break_off();
  sync_.reset();
  period_ = 0;
  for (Slot& slot : slots_) slot.filled = slot.doubled = false;
}

void SyncedCycles::begin(Nanoseconds t) {
  // Smoothed: after a late SYNC comes one that seems early.
  if (sync_) period_ = period_ == 0 ? t - *sync_ : period_ + (t - *sync_ - period_) / 8;
  sync_ = t;
  spoilt_ = false;
  for (Slot& slot : slots_) slot.filled = slot.doubled = false;
}

void SyncedCycles::put(std::size_t message, const CanFrame& frame, Nanoseconds t) {
  Slot& slot = slots_[message];
  if (!sync_) {
    // Nothing to be said of the first frames after a start or an interruption.
    if (std::exchange(slot.filled, true)) faults_->note(CanFault::missing, t, "SYNC");
    return;
  }
  if (!well_formed(map_->messages[message], frame)) {
    faults_->note(CanFault::malformed, t, name(message));
    spoilt_ = true;
    return;
  }
  if (!in_window(message, t)) return;
  if (!slot.filled) {
    slot.filled = true;
    slot.frame = frame;
    return;
  }
  faults_->note(CanFault::duplicated, t, name(message));
  slot.doubled = true;
  // The same again does no harm; another value may be the late one of the cycle before.
  if (slot.frame.data != frame.data) spoilt_ = true;
}

bool SyncedCycles::in_window(std::size_t message, Nanoseconds t) {
  const Nanoseconds since = t - *sync_;
  // A SYNC may have been lost before it: whose cycle it is nobody can tell.
  if (period_ > 0 && since > period_ * 9 / 10 && since <= window_) {
    spoilt_ = true;
    faults_->note(CanFault::late, t, name(message) + ", hardly before the next SYNC");
  }
  if (since <= window_) return true;
  spoilt_ = true;
  const bool no_sync = since > 2 * std::max(period_, window_);
  if (no_sync)
    faults_->note(CanFault::missing, t, "SYNC");
  else
    faults_->note(CanFault::late, t, name(message));
  return false;
}

void SyncedCycles::end(std::vector<EncoderSample>& out) {
  if (!sync_) return;
  watch_senders();
  EncoderSample sample;
  sample.time = *sync_ - delay_;
  sample.joints = static_cast<int>(map_->joints.size());
  const bool there = all_there();
  if (!there || spoilt_ || !follow(sample) || faults_->readings_are_doubtful()) {
    ++incomplete_;
    return;
  }
  sample.follows = !std::exchange(broke_off_, false);
  out.push_back(sample);
}

void SyncedCycles::watch_senders() {
  std::string doubled;
  for (std::size_t m = 0; m < slots_.size(); ++m) {
    slots_[m].watch.tell(slots_[m].doubled);
    if (slots_[m].watch.second()) doubled = name(m);
  }
  faults_->set(CanFault::second_sender, !doubled.empty(), newest_, doubled);
}

bool SyncedCycles::all_there() {
  std::string missing;
  for (std::size_t m = 0; m < slots_.size(); ++m)
    if (!slots_[m].filled) missing += (missing.empty() ? "" : ", ") + name(m);
  if (missing.empty()) return true;
  // A frame that came too late was told then.
  if (!spoilt_) faults_->note(CanFault::missing, newest_, missing);
  return false;
}

// Counts the turns on; false when a joint cannot have moved so far.
bool SyncedCycles::follow(EncoderSample& sample) {
  bool follows = true;
  for (std::size_t m = 0; m < slots_.size(); ++m)
    for (const int j : map_->messages[m].joints) {
      const std::int64_t raw = raw_counts(map_->joints[j], slots_[m].frame);
      const JointTrack::Step step = tracks_[j].add(raw, *sync_);
      sample.counts[j] = tracks_[j].counts();
      follows = follows && step != JointTrack::Step::jumped;
      note_step(*faults_, step, map_->joints[j].name, *sync_);
    }
  return follows;
}

std::string SyncedCycles::name(std::size_t message) const {
  return name_of(*map_, map_->messages[message]);
}

}  // namespace selfcal
