// Encoders on a CAN bus (SocketCAN): only heard, unless the settings say that the service sends
// SYNC.
//
// A thread of its own reads the socket, so that the kernel's queue does not fill while the service
// computes. All stamps are the kernel's.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "io/can/assembler.h"
#include "io/can/settings.h"
#include "io/can/socket.h"
#include "io/can/sync_sender.h"
#include "io/ports.h"
#include "io/wall_clock.h"

namespace selfcal {

class CanEncoders : public EncoderSource {
 public:
  /// Fails when there is no such interface; one that is down, or goes, is waited for.
  static Result<std::unique_ptr<CanEncoders>> open(CanSettings settings);
  ~CanEncoders() override;

  const std::vector<EncoderScale>& scales() const override { return scales_; }
  Result<void> take(std::vector<EncoderSample>& out) override;
  /// Samples pushed out before they were taken, frames that the kernel had no room for, and frames
  /// around a step of the wall clock.
  std::uint64_t dropped() const override;
  int senders() const override;
  std::string trouble() const override;

  /// Every fault and how often it was met.
  std::vector<Tally> tallies() const override;
  /// Cycles that gave no sample.
  std::uint64_t incomplete() const;

 private:
  CanEncoders(CanSettings settings, CanReceiverOptions options, CanReceiver receiver,
              Descriptor wake);
  void run(const std::stop_token& stop);
  bool wait(const std::stop_token& stop);
  void listen();
  void reopen();
  void digest(CanRead end);
  void digest(const CanFrame& frame, Nanoseconds now);
  void note_interface(CanRead end, Nanoseconds now);

  const CanSettings settings_;
  const CanReceiverOptions options_;
  const std::vector<EncoderScale> scales_;

  // Of the thread alone.
  std::optional<CanReceiver> receiver_;  ///< nothing while the interface is gone
  Descriptor wake_;                      ///< readable when the thread is to end
  std::vector<CanFrame> frames_;
  std::vector<EncoderSample> samples_;
  WallClock wall_;
  std::uint64_t steps_ = 0;

  mutable std::mutex mutex_;  ///< for what follows
  CanFaults faults_;
  CanAssembler assembler_;
  std::deque<EncoderSample> waiting_;
  std::uint64_t pushed_out_ = 0, stepped_ = 0;
  std::optional<Failure> failure_;

  std::unique_ptr<SyncSender> sync_;
  std::jthread thread_;  ///< last: ends before what it uses
};

}  // namespace selfcal
