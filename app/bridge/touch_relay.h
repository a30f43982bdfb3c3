// A touch without a stamp as the service's trigger.
#pragma once

#include <memory>
#include <string>

#include "io/dds/sole_writer.h"
#include "io/repeated_level.h"
#include "io/transport.h"

namespace selfcal {

/// std_msgs/Bool of one publisher (true: in contact) becomes the levels that a trigger of kind dds
/// hears. The stamp is DDS's own of the moment the message was written, on the publisher's wall
/// clock: the one that joint states must be stamped by, too.
class TouchRelay {
 public:
  /// `topic` is the name in ROS; `trigger` the configuration's.
  static Result<std::unique_ptr<TouchRelay>> open(const DdsParticipant& participant,
                                                  const std::string& topic,
                                                  std::unique_ptr<TriggerSender> trigger,
                                                  Wakeup& wakeup);
  /// Passes on what has come, and repeats the level ten times a second for as long as its publisher
  /// is there, but not where that has repeated it and is silent: it has hung then.
  Result<void> turn(Nanoseconds now);
  int publishers() const { return reader_.matched(); }
  std::uint64_t strange() const { return writer_.strange(); }  ///< of others than the first

 private:
  static constexpr Nanoseconds kSilence = kSecond / 2;

  TouchRelay(DdsReader<dds::Bool> reader, std::unique_ptr<TriggerSender> trigger)
      : reader_(std::move(reader)), trigger_(std::move(trigger)) {}

  DdsReader<dds::Bool> reader_;
  SoleWriter writer_;
  std::unique_ptr<TriggerSender> trigger_;
  RepeatedLevel level_{kSilence};
  Nanoseconds changed_ = 0, repeated_ = 0;
};

}  // namespace selfcal
