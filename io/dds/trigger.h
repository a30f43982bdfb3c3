// The touch trigger from a topic of stamped levels (selfcal_msgs/StampedBool).
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "io/dds/sole_writer.h"
#include "io/dds/time_mapping.h"
#include "io/ports.h"
#include "io/repeated_level.h"

namespace selfcal {

struct DdsTriggerConfig {
  std::string topic = "touch_trigger";  ///< name in ROS
  Nanoseconds silence = kSecond / 2;    ///< of a publisher that repeats its level; then it has hung
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

  /// Nothing before the first message, while no publisher is there, and while one that has repeated
  /// its level is silent. Of one that tells of changes alone nobody knows whether it has hung.
  std::optional<bool> closed() override;
  Result<void> take(std::vector<Edge>& out) override;
  std::uint64_t dropped() const override { return reader_.lost() + overflowed_; }
  int senders() const override { return reader_.matched(); }
  std::uint64_t strange() const override { return writer_.strange(); }
  std::string trouble() const override;

 private:
  DdsTrigger(std::shared_ptr<TimeMapping> mapping, DdsReader<dds::StampedBool> reader,
             Nanoseconds silence)
      : mapping_(std::move(mapping)), reader_(std::move(reader)), level_(silence) {}
  Result<void> receive();

  std::shared_ptr<TimeMapping> mapping_;
  DdsReader<dds::StampedBool> reader_;
  SoleWriter writer_;
  RepeatedLevel level_;
  std::deque<Edge> waiting_;  ///< not taken yet, with the sender's stamps
  std::uint64_t overflowed_ = 0;
};

}  // namespace selfcal
