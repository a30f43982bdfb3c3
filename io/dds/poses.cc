#include "io/dds/poses.h"

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/opened.h"

namespace selfcal {
namespace {

std::vector<double> list_of(const dds_sequence_double& sequence) {
  return {sequence._buffer, sequence._buffer + sequence._length};
}

PoseRequestMessage plain_request(const dds::PoseRequest& request) {
  return {.id = request.id_,
          .position = list_of(request.position_),
          .orientation = list_of(request.orientation_),
          .near = list_of(request.near_),
          .payload = request.payload_,
          .payload_centre = list_of(request.payload_centre_),
          .temperature = request.temperature_};
}

dds::PoseReply borrowed_reply(const PoseReplyMessage& reply) {
  const auto size = static_cast<std::uint32_t>(reply.q.size());
  return {.id_ = borrowed::text(reply.id),
          .status_ = borrowed::text(reply.status),
          .why_ = borrowed::text(reply.why),
          .q_ = {size, size, const_cast<double*>(reply.q.data()), false},
          .iterations_ = reply.iterations,
          .error_ = reply.error,
          .error_angle_ = reply.error_angle,
          .model_ = borrowed::text(reply.model)};
}

}  // namespace

Result<std::unique_ptr<DdsPoses>> DdsPoses::open(const DdsParticipant& participant,
                                                 const std::string& robot, Wakeup& wakeup) {
  std::unique_ptr<DdsPoses> poses(new DdsPoses);
  DdsOpening opening(participant);
  opening.open(poses->replies_, robot_topic(robot, "pose_reply"), kReplies);
  opening.open(poses->requests_, robot_topic(robot, "pose_request"), kPoseReader, &wakeup);
  return opening.finish([&] { return std::move(poses); });
}

bool DdsPoses::answer(const std::function<PoseReplyMessage(const PoseRequestMessage&)>& to) {
  bool answered = false;
  // A failure to read or to write is a bug of ours or of the library's; who asked asks again.
  (void)requests_.take(1, [&](const dds::PoseRequest& received) {
    answered = true;
    const PoseRequestMessage request = plain_request(received);
    PoseReplyMessage reply;
    if (allowance_.take(monotonic_now())) {
      reply = to(request);
    } else {
      reply.status = "refused";
      reply.why = "more than " + std::to_string(kMostPoses) + " poses in a second";
    }
    reply.id = request.id;
    (void)replies_.write(borrowed_reply(reply));
  });
  return answered;
}

}  // namespace selfcal
