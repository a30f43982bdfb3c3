// Samples of joints that send whenever they like.

#include "io/can/free_running.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace selfcal {
namespace {

// Parts of a cycle: closer than kTwin a frame repeats the one before, closer than kClose it is one
// too many. Of two senders with one cycle two frames are always closer than half of it.
constexpr double kTwin = 0.25, kClose = 0.6;
// From here on a frame did not come late, but one was left out.
constexpr double kLeftOut = 1.9;

}  // namespace

FreeRunning::FreeRunning(const CanMap& map, const CanTiming& timing, CanFaults& faults)
    : map_(&map),
      faults_(&faults),
      cycle_(nanoseconds(timing.cycle)),
      window_(nanoseconds(timing.window)),
      delay_(nanoseconds(timing.delay)),
      streams_(map.messages.size()) {
  for (const CanJoint& joint : map.joints) tracks_.emplace_back(joint);
}

void FreeRunning::add(const CanFrame& frame, Nanoseconds t, std::vector<EncoderSample>& out) {
  const int found = map_->find(frame.id);
  if (found < 0) return;
  const auto message = static_cast<std::size_t>(found);
  if (!started_) started_ = t;
  const bool first = !streams_[message].known;
  if (accept(message, frame, t)) {
    if (message == 0 && !first) begin(t);
    resolve(message);
  }
  note_silence(t);
  give_up(t);
  emit(out);
}

void FreeRunning::interrupt() {
  incomplete_ += pending_.size();
  pending_.clear();
  for (Stream& stream : streams_) stream.broken = true;
  started_.reset();
  broke_off_ = true;
  for (JointTrack& track : tracks_) track.break_off();
}

// Makes the frame the newest of its stream; false when it cannot be used.
bool FreeRunning::accept(std::size_t message, const CanFrame& frame, Nanoseconds t) {
  Stream& stream = streams_[message];
  if (!well_formed(map_->messages[message], frame)) {
    faults_->note(CanFault::malformed, t, name(message));
    stream.broken = true;
    return false;
  }
  if (stream.known && t + kStampSlack < stream.time) {
    faults_->note(CanFault::out_of_order, t, name(message));
    return false;
  }
  if (stream.known && repeated(message, frame, t)) return false;
  const bool followed = follow(message, frame, t);
  // Between a frame that does not follow and the one before it nothing may be interpolated.
  if (!followed) stream.broken = true;
  return true;
}

// True when the frame is to be passed over.
bool FreeRunning::repeated(std::size_t message, const CanFrame& frame, Nanoseconds t) {
  Stream& stream = streams_[message];
  const Nanoseconds gap = t - stream.time;
  stream.watch.tell(static_cast<double>(gap) < kClose * static_cast<double>(cycle_));
  watch_senders(t);
  if (static_cast<double>(gap) < kTwin * static_cast<double>(cycle_)) {
    faults_->note(CanFault::duplicated, t, name(message));
    // Two values at nearly one moment: which of them is true nobody can tell.
    if (stream.last.data != frame.data) stream.broken = true;
    return true;
  }
  if (gap > window_ && !stream.broken) note_gap(message, gap, t);
  return false;
}

void FreeRunning::note_gap(std::size_t message, Nanoseconds gap, Nanoseconds t) {
  if (static_cast<double>(gap) <= kLeftOut * static_cast<double>(cycle_))
    faults_->note(CanFault::late, t, name(message));
  else if (streams_[message].told == 0)
    faults_->note(CanFault::missing, t, name(message));
}

// Tells each cycle that a message is silent while others are heard.
void FreeRunning::note_silence(Nanoseconds t) {
  for (std::size_t m = 0; m < streams_.size(); ++m) {
    Stream& stream = streams_[m];
    const Nanoseconds silence = t - std::max(stream.time, *started_);
    const std::int64_t cycles = silence > window_ ? 1 + (silence - window_) / cycle_ : 0;
    if (cycles <= stream.told) continue;
    faults_->note(CanFault::missing, t, name(m), static_cast<std::uint64_t>(cycles - stream.told));
    stream.told = cycles;
  }
}

void FreeRunning::watch_senders(Nanoseconds t) {
  std::string doubled;
  for (std::size_t m = 0; m < streams_.size(); ++m)
    if (streams_[m].watch.second()) doubled = name(m);
  faults_->set(CanFault::second_sender, !doubled.empty(), t, doubled);
}

bool FreeRunning::follow(std::size_t message, const CanFrame& frame, Nanoseconds t) {
  Stream& stream = streams_[message];
  stream.before = std::move(stream.counts);
  stream.before_time = stream.time;
  stream.counts.clear();
  bool follows = stream.known;
  for (const int j : map_->messages[message].joints) {
    const JointTrack::Step step = tracks_[j].add(raw_counts(map_->joints[j], frame), t);
    note_step(*faults_, step, map_->joints[j].name, t);
    follows = follows && step != JointTrack::Step::jumped && step != JointTrack::Step::back;
    stream.counts.push_back(tracks_[j].counts());
  }
  stream.last = frame;
  stream.time = t;
  stream.told = 0;
  stream.known = true;
  return follows;
}

// A sample of this time waits for all joints.
void FreeRunning::begin(Nanoseconds t) {
  Pending pending;
  pending.sample.time = t;
  pending.sample.joints = static_cast<int>(map_->joints.size());
  pending.waits_for = (std::uint32_t{1} << streams_.size()) - 1;
  pending_.push_back(pending);
}

// Gives the message's joints to the samples before its newest frame.
void FreeRunning::resolve(std::size_t message) {
  Stream& stream = streams_[message];
  const std::vector<int>& joints = map_->messages[message].joints;
  const std::uint32_t bit = std::uint32_t{1} << message;
  const Nanoseconds gap = stream.time - stream.before_time;
  for (Pending& pending : pending_) {
    const Nanoseconds t = pending.sample.time;
    if ((pending.waits_for & bit) == 0 || t > stream.time) continue;
    pending.waits_for &= ~bit;
    const bool around = !stream.broken && gap <= window_ && stream.before_time <= t;
    if (!around && !(message == 0 && !stream.broken)) {
      pending.spoilt = true;
      continue;
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      pending.sample.counts[joints[i]] = stream.counts[i];
      if (t == stream.time) continue;
      const double back = static_cast<double>(stream.time - t) / static_cast<double>(gap);
      const auto moved = static_cast<double>(stream.counts[i] - stream.before[i]);
      pending.sample.counts[joints[i]] -= std::llround(back * moved);
    }
  }
  stream.broken = false;
}

// Nobody waits longer than a window for a joint's next frame.
void FreeRunning::give_up(Nanoseconds t) {
  while (!pending_.empty() && pending_.front().waits_for != 0 &&
         t - pending_.front().sample.time > window_) {
    ++incomplete_;
    pending_.pop_front();
  }
}

void FreeRunning::emit(std::vector<EncoderSample>& out) {
  for (; !pending_.empty() && pending_.front().waits_for == 0; pending_.pop_front()) {
    Pending& done = pending_.front();
    if (done.spoilt || faults_->readings_are_doubtful()) {
      ++incomplete_;
      continue;
    }
    done.sample.time -= delay_;
    done.sample.follows = !std::exchange(broke_off_, false);
    out.push_back(done.sample);
  }
}

std::string FreeRunning::name(std::size_t message) const {
  return name_of(*map_, map_->messages[message]);
}

}  // namespace selfcal
