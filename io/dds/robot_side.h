// A robot's side of the topics: takes requests for motion, sends replies and the temperature; joint
// states and the trigger's level too, where they have no bus of their own. For a robot's driver, or
// a pretend robot in its own process.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/dds/endpoint.h"
#include "io/dds/senders.h"
#include "io/ports.h"

namespace selfcal {

struct DdsRobotConfig {
  std::string robot;                          ///< the robot's id
  std::vector<std::string> joints;            ///< names, by joint
  std::string joint_states = "joint_states";  ///< names in ROS; empty: not sent here
  std::string trigger = "touch_trigger";
  std::string temperature = "temperature";
};

/// What a robot is asked: a move, or to stop.
struct RobotRequest {
  bool stop = false;
  std::string why;     ///< of a stop
  MotionRequest move;  ///< of a move
};

class DdsRobotSide {
 public:
  /// `wakeup` hears of requests and of services that come and go.
  static Result<std::unique_ptr<DdsRobotSide>> open(const DdsParticipant& participant,
                                                    DdsRobotConfig config, Wakeup& wakeup);

  /// Appends the requests since the last call, oldest first. A request that cannot be read is
  /// refused here.
  Result<void> take(std::vector<RobotRequest>& out);
  Result<void> reply(const MotionReply& reply);

  /// Stamps (ns) are of one clock of the robot's choice, the same for joints and trigger. `q` (rad
  /// or m) has as many values as there are joints. Only with topics for them.
  Result<void> publish_joints(Nanoseconds stamp, const std::vector<double>& q) {
    return dds_.joints->send(stamp, q);
  }
  /// `stamp` is the moment the level changed; repeat both about ten times a second.
  Result<void> publish_trigger(Nanoseconds stamp, bool closed) {
    return dds_.trigger->send(stamp, closed);
  }
  Result<void> publish_temperature(Nanoseconds stamp, double celsius);

  /// Whether a service sends requests and hears the replies.
  bool connected() const { return dds_.requests.matched() > 0 && dds_.replies.matched() > 0; }
  /// Whether someone hears joint states and trigger.
  bool heard() const { return dds_.joints->matched() > 0 && dds_.trigger->matched() > 0; }

 private:
  struct Endpoints {
    DdsReader<dds::MotionRequest> requests;
    DdsWriter<dds::MotionReply> replies;
    DdsWriter<dds::Temperature> temperature;
    std::unique_ptr<DdsJointSender> joints;
    std::unique_ptr<DdsTriggerSender> trigger;
  };
  explicit DdsRobotSide(Endpoints endpoints) : dds_(std::move(endpoints)) {}

  Endpoints dds_;
};

}  // namespace selfcal
