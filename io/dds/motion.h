// Motion asked of a robot over DDS.
#pragma once

#include <memory>
#include <string>

#include "io/dds/endpoint.h"
#include "io/ports.h"

namespace selfcal {

class DdsMotion : public Motion {
 public:
  /// `wakeup` hears of replies and of robots that come and go.
  static Result<std::unique_ptr<DdsMotion>> open(const DdsParticipant& participant,
                                                 const std::string& robot, Wakeup& wakeup);

  /// Fails when no robot listens, or when it has not taken earlier requests in time.
  Result<void> request(const MotionRequest& request) override;
  Result<void> stop(const std::string& why) override;
  Result<void> take(std::vector<MotionReply>& out) override;
  /// Whether a robot listens to requests and sends replies.
  bool connected() const { return requests_.matched() > 0 && replies_.matched() > 0; }

 private:
  DdsMotion(std::string robot, DdsWriter<dds::MotionRequest> requests,
            DdsReader<dds::MotionReply> replies)
      : robot_(std::move(robot)), requests_(std::move(requests)), replies_(std::move(replies)) {}

  std::string robot_;
  DdsWriter<dds::MotionRequest> requests_;
  DdsReader<dds::MotionReply> replies_;
  std::uint64_t last_ = 0;  ///< id of the last request, which a stop repeats
};

}  // namespace selfcal
