// Motion asked of a robot over DDS.
#pragma once

#include <memory>
#include <string>

#include "io/dds/sole_writer.h"
#include "io/ports.h"

namespace selfcal {

class DdsMotion : public Motion {
 public:
  /// `wakeup` hears of replies and of robots that come and go.
  static Result<std::unique_ptr<DdsMotion>> open(const DdsParticipant& participant,
                                                 const std::string& robot, Wakeup& wakeup);

  /// Fails when no robot listens. Never waits for one: who does not take its requests misses the
  /// older ones, and the move that then never ends is noticed.
  Result<void> request(const MotionRequest& request) override;
  Result<void> stop(const std::string& why) override;
  /// Replies of the robot's own writer alone (sole_writer.h).
  Result<void> take(std::vector<MotionReply>& out) override;
  int senders() const override { return replies_.matched(); }
  std::uint64_t strange() const override { return writer_.strange(); }
  /// Whether a robot listens to requests and sends replies.
  bool connected() const { return requests_.matched() > 0 && replies_.matched() > 0; }

 private:
  DdsMotion(std::string robot, DdsWriter<dds::MotionRequest> requests,
            DdsReader<dds::MotionReply> replies)
      : robot_(std::move(robot)), requests_(std::move(requests)), replies_(std::move(replies)) {}

  std::string robot_;
  DdsWriter<dds::MotionRequest> requests_;
  DdsReader<dds::MotionReply> replies_;
  SoleWriter writer_;       ///< of replies
  std::uint64_t last_ = 0;  ///< id of the last request, which a stop repeats
};

}  // namespace selfcal
