// A robot's side of the topics.

#include "io/dds/robot_side.h"

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/opened.h"

namespace selfcal {

Result<std::unique_ptr<DdsRobotSide>> DdsRobotSide::open(const DdsParticipant& participant,
                                                         const DdsRobotConfig& config,
                                                         Wakeup& wakeup) {
  Endpoints endpoints;
  DdsOpening opening(participant);
  opening.open(endpoints.replies, robot_topic(config.robot, "motion_reply"), kExchange, &wakeup);
  opening.open(endpoints.requests, robot_topic(config.robot, "motion_request"), kExchange, &wakeup);
  opening.open(endpoints.temperature, ros_topic(config.temperature), kSensorWriter, &wakeup);
  return opening.finish(
      [&] { return std::unique_ptr<DdsRobotSide>(new DdsRobotSide(std::move(endpoints))); });
}

Result<void> DdsRobotSide::take(std::vector<RobotRequest>& out) {
  return dds_.requests.take([&](const dds::MotionRequest& received) {
    auto request = to_plain(received);
    if (request) {
      out.push_back(*std::move(request));
      return;
    }
    // Not to be able to refuse it is the same as not to hear it.
    (void)reply({.id = received.id_,
                 .outcome = MotionReply::Outcome::refused,
                 .why = request.error().what});
  });
}

Result<void> DdsRobotSide::reply(const MotionReply& reply) {
  return dds_.replies.write(borrow(reply));
}

Result<void> DdsRobotSide::publish_temperature(Nanoseconds stamp, double celsius) {
  return dds_.temperature.write(
      {.header_ = header_of(stamp), .temperature_ = celsius, .variance_ = 0});
}

}  // namespace selfcal
