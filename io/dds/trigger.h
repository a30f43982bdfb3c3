// The touch trigger from a topic of stamped levels (selfcal_msgs/StampedBool).
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "io/dds/sole_writer.h"
#include "io/dds/time_mapping.h"
#include "io/ports.h"

namespace selfcal {

struct DdsTriggerConfig {
  std::string topic = "touch_trigger";  ///< name in ROS
};

class DdsTrigger : public TouchTrigger {
 public:
  /// Takes levels of reliable and of best-effort publishers. What gets lost on the way is not sent
  /// again, but a publisher that repeats its level now and then, with the stamp of its change,
  /// loses neither edge nor stamp. `mapping` is that of the machine's DdsEncoders, which alone
  /// tells it of time: edges wait until the first joint state has come. `wakeup` hears of levels.
  static Result<std::unique_ptr<DdsTrigger>> open(const DdsParticipant& participant,
                                                  const DdsTriggerConfig& config,
                                                  std::shared_ptr<TimeMapping> mapping,
                                                  Wakeup& wakeup);

  /// Nothing before the first message and while no publisher is there.
  std::optional<bool> closed() override;
  Result<void> take(std::vector<Edge>& out) override;
  std::uint64_t dropped() const override { return reader_.lost() + overflowed_; }
  int senders() const override { return reader_.matched(); }
  std::uint64_t strange() const override { return writer_.strange(); }

 private:
  DdsTrigger(std::shared_ptr<TimeMapping> mapping, DdsReader<dds::StampedBool> reader)
      : mapping_(std::move(mapping)), reader_(std::move(reader)) {}
  Result<void> receive();

  std::shared_ptr<TimeMapping> mapping_;
  DdsReader<dds::StampedBool> reader_;
  SoleWriter writer_;
  std::optional<bool> level_;
  std::deque<Edge> waiting_;  ///< not taken yet, with the sender's stamps
  std::uint64_t overflowed_ = 0;
};

}  // namespace selfcal
