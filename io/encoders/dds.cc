// Encoders from a topic of joint states (io/dds/encoders.h), stamped by the sender.
//
//   key              default       range        meaning
//   topic            joint_states               sensor_msgs/JointState; the names in it are
//   `joints`

#include "io/dds/encoders.h"

#include "io/dds/context.h"
#include "io/dds/senders.h"
#include "io/encoders.h"

namespace selfcal {
namespace {

class DdsEncoderKind final : public EncoderKind {
 public:
  explicit DdsEncoderKind(DdsEncodersConfig config) : config_(std::move(config)) {}

  StampedBy stamped_by() const override { return StampedBy::sender; }
  std::string source() const override { return "topic " + config_.topic; }
  Result<std::unique_ptr<EncoderSource>> open(const PortContext& context) const override {
    return DdsEncoders::open(context.dds.participant, config_, context.dds.mapping);
  }
  Result<std::unique_ptr<JointSender>> open_sender(const RobotContext& context) const override {
    return DdsJointSender::open(context.dds.participant, config_.topic, config_.joints,
                                context.wakeup);
  }

 private:
  DdsEncodersConfig config_;
};

}  // namespace

EncoderKindPtr make_dds(const EncoderEntry& entry) {
  Fields fields(entry.node, "encoders", entry.problems);
  DdsEncodersConfig config;
  config.topic = fields.text("topic", config.topic);
  config.joints = entry.joints;
  fields.refuse_unknown();
  return std::make_shared<DdsEncoderKind>(std::move(config));
}

}  // namespace selfcal
