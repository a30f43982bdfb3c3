// Motion asked of a robot over DDS.

#include "io/dds/motion.h"

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/opened.h"

namespace selfcal {

Result<std::unique_ptr<DdsMotion>> DdsMotion::open(const DdsParticipant& participant,
                                                   const std::string& robot, Wakeup& wakeup) {
  DdsWriter<dds::MotionRequest> requests;
  DdsReader<dds::MotionReply> replies;
  DdsOpening opening(participant);
  opening.open(requests, robot_topic(robot, "motion_request"), kMotion, &wakeup);
  opening.open(replies, robot_topic(robot, "motion_reply"), kExchangeReader, &wakeup);
  return opening.finish([&] {
    return std::unique_ptr<DdsMotion>(
        new DdsMotion(robot, std::move(requests), std::move(replies)));
  });
}

Result<void> DdsMotion::request(const MotionRequest& request) {
  if (!connected())
    return device_failed("no robot listens on " + robot_topic(robot_, "motion_request"));
  last_ = request.id;
  return requests_.write(borrow(request));
}

Result<void> DdsMotion::stop(const std::string& why) {
  return requests_.write(borrow_stop(last_, why));
}

Result<void> DdsMotion::take(std::vector<MotionReply>& out) {
  writer_.look(replies_);
  return replies_.take([&](const dds::MotionReply& reply, dds_instance_handle_t writer) {
    if (writer_.believes(writer, replies_)) out.push_back(to_plain(reply));
  });
}

}  // namespace selfcal
