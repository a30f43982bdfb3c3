// A robot's side of the topics: takes requests for motion, sends replies and the temperature (joint
// states and the trigger's level: senders.h). For a robot's driver, or a simulated robot in its own
// process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/dds/endpoint.h"
#include "io/ports.h"

namespace selfcal {

struct DdsRobotConfig {
  std::string robot;                        ///< the robot's id
  std::string temperature = "temperature";  ///< name in ROS
};

class DdsRobotSide {
 public:
  /// `wakeup` hears of requests and of services that come and go.
  static Result<std::unique_ptr<DdsRobotSide>> open(const DdsParticipant& participant,
                                                    const DdsRobotConfig& config, Wakeup& wakeup);

  /// Appends the requests since the last call, oldest first. A request that cannot be read is
  /// refused here.
  Result<void> take(std::vector<RobotRequest>& out);
  Result<void> reply(const MotionReply& reply);
  /// `stamp` (ns) is of a clock of the robot's choice.
  Result<void> publish_temperature(Nanoseconds stamp, double celsius);

  /// Whether a service sends requests and hears the replies.
  bool connected() const { return dds_.requests.matched() > 0 && dds_.replies.matched() > 0; }

 private:
  struct Endpoints {
    DdsReader<dds::MotionRequest> requests;
    DdsWriter<dds::MotionReply> replies;
    DdsWriter<dds::Temperature> temperature;
  };
  explicit DdsRobotSide(Endpoints endpoints) : dds_(std::move(endpoints)) {}

  Endpoints dds_;
};

}  // namespace selfcal
