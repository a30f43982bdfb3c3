// Encoders on a CAN bus.

#include "io/can/encoders.h"

#include <net/if.h>
#include <poll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <array>

#include "io/clock.h"

namespace selfcal {
namespace {

// Without frames the clocks are compared, and the interface looked for, so often.
constexpr int kIdle_ms = 100;
// After each reading the thread rests so long: a bus of 20 000 frames a second then costs 1 000
// readings, and its 20 frames are far from filling the kernel's queue.
constexpr int kRest_ms = 1;

CanReceiverOptions options_of(const CanSettings& settings) {
  CanReceiverOptions options;
  options.interface = settings.interface;
  for (const CanMessage& message : settings.map.messages) {
    options.ids.push_back(message.id);
    options.fd = options.fd || message.fd;
  }
  if (settings.map.sync) options.ids.push_back(*settings.map.sync);
  options.receive_buffer = settings.receive_buffer;
  return options;
}

}  // namespace

Result<std::unique_ptr<CanEncoders>> CanEncoders::open(CanSettings settings) {
  CanReceiverOptions options = options_of(settings);
  auto receiver = CanReceiver::open(options);
  if (!receiver) return tl::unexpected(receiver.error());
  Descriptor wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!wake.open()) return device_failed("CAN: no event descriptor");
  std::unique_ptr<SyncSender> sync;
  if (settings.map.sync && settings.sync_send_period > 0) {
    auto opened =
        SyncSender::open(settings.interface, *settings.map.sync, settings.sync_send_period);
    if (!opened) return tl::unexpected(opened.error());
    sync = *std::move(opened);
  }
  std::unique_ptr<CanEncoders> encoders(new CanEncoders(std::move(settings), std::move(options),
                                                        *std::move(receiver), std::move(wake)));
  encoders->sync_ = std::move(sync);
  return encoders;
}

CanEncoders::CanEncoders(CanSettings settings, CanReceiverOptions options, CanReceiver receiver,
                         Descriptor wake)
    : settings_(std::move(settings)),
      options_(std::move(options)),
      scales_(settings_.map.scales()),
      receiver_(std::move(receiver)),
      wake_(std::move(wake)),
      faults_(settings_.interface),
      assembler_(settings_.map, settings_.timing, faults_),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

CanEncoders::~CanEncoders() {
  thread_.request_stop();
  ::eventfd_write(wake_.handle(), 1);
}

Result<void> CanEncoders::take(std::vector<EncoderSample>& out) {
  const std::lock_guard lock(mutex_);
  if (failure_) return tl::unexpected(*failure_);
  out.insert(out.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  return {};
}

std::uint64_t CanEncoders::dropped() const {
  const std::lock_guard lock(mutex_);
  return pushed_out_ + stepped_ + faults_.count(CanFault::overrun);
}

int CanEncoders::senders() const {
  const std::lock_guard lock(mutex_);
  return faults_.lasts(CanFault::second_sender) ? 2 : 1;
}

std::string CanEncoders::trouble() const {
  const std::lock_guard lock(mutex_);
  return faults_.trouble(monotonic_now());
}

std::vector<Tally> CanEncoders::tallies() const {
  const std::lock_guard lock(mutex_);
  return faults_.tallies();
}

std::uint64_t CanEncoders::incomplete() const {
  const std::lock_guard lock(mutex_);
  return assembler_.incomplete();
}

void CanEncoders::run(const std::stop_token& stop) {
  wall_.observe(read_clocks(), false);
  while (wait(stop)) {
    if (receiver_)
      listen();
    else
      reopen();
  }
}

// Waits for frames; false when the thread is to end.
bool CanEncoders::wait(const std::stop_token& stop) {
  std::array<pollfd, 2> waiting{
      {{.fd = wake_.handle(), .events = POLLIN, .revents = 0},
       {.fd = receiver_ ? receiver_->handle() : -1, .events = POLLIN, .revents = 0}}};
  ::poll(waiting.data(), 1, kRest_ms);
  ::poll(waiting.data(), waiting.size(), kIdle_ms);
  return !stop.stop_requested();
}

// Reads until nothing is waiting.
void CanEncoders::listen() {
  for (bool more = true; more;) {
    frames_.clear();
    const Result<CanRead> end = receiver_->read(frames_);
    if (!end) {
      const std::lock_guard lock(mutex_);
      failure_ = end.error();
      receiver_.reset();
      return;
    }
    digest(*end);
    more = *end == CanRead::more;
    if (*end == CanRead::gone) receiver_.reset();
  }
}

void CanEncoders::reopen() {
  auto receiver = CanReceiver::open(options_);
  const std::lock_guard lock(mutex_);
  if (receiver) {
    receiver_ = *std::move(receiver);
    failure_.reset();
  } else if (::if_nametoindex(settings_.interface.c_str()) != 0) {
    // It is back, but not as it was.
    faults_.set(CanFault::interface_down, true, monotonic_now(), receiver.error().what);
  }
}

void CanEncoders::digest(CanRead end) {
  // After the frames were taken: a step before this shows, and they are given up.
  wall_.observe(read_clocks(1), end == CanRead::drained);
  const Nanoseconds now = monotonic_now();
  const std::lock_guard lock(mutex_);
  if (wall_.steps() != steps_) {
    steps_ = wall_.steps();
    faults_.note(CanFault::time_stepped, now);
    assembler_.interrupt();
  }
  samples_.clear();
  for (const CanFrame& frame : frames_) digest(frame, now);
  for (const EncoderSample& sample : samples_) {
    if (waiting_.size() == kMostSamples) {
      waiting_.pop_front();
      ++pushed_out_;
    }
    waiting_.push_back(sample);
  }
  note_interface(end, now);
}

void CanEncoders::digest(const CanFrame& frame, Nanoseconds now) {
  const auto t = wall_.monotonic(frame.stamp);
  if (t || frame.error) return assembler_.add(frame, t.value_or(now), samples_);
  ++stepped_;
  if (frame.lost > 0)
    faults_.note(CanFault::overrun, now, std::to_string(frame.lost) + " frames", frame.lost);
  assembler_.interrupt();
}

void CanEncoders::note_interface(CanRead end, Nanoseconds now) {
  const bool was_down = faults_.lasts(CanFault::interface_down);
  if (end == CanRead::down || end == CanRead::gone) {
    assembler_.interrupt();
    faults_.set(CanFault::interface_down, true, now, end == CanRead::gone ? "it is gone" : "");
    // The controller begins anew with its interface.
    faults_.set(CanFault::bus_off, false, now);
    faults_.set(CanFault::error_passive, false, now);
  } else if (was_down && receiver_->interface_up()) {
    faults_.set(CanFault::interface_down, false, now);
  }
}

}  // namespace selfcal
