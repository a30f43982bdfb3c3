// Encoders on a CAN bus (io/can/encoders.h), stamped by the kernel; the keys are in
// io/can/settings.h.

#include "io/can/encoders.h"
#include "io/can/senders.h"
#include "io/encoders.h"

namespace selfcal {
namespace {

class SocketCan final : public EncoderKind {
 public:
  explicit SocketCan(CanSettings settings) : settings_(std::move(settings)) {}

  StampedBy stamped_by() const override { return StampedBy::kernel; }
  std::string source() const override { return "CAN interface " + settings_.interface; }
  Result<std::unique_ptr<EncoderSource>> open(const PortContext&) const override {
    return CanEncoders::open(settings_);
  }
  Result<std::unique_ptr<JointSender>> open_sender(const RobotContext&) const override {
    return CanJointSender::open(settings_);
  }

 private:
  CanSettings settings_;
};

}  // namespace

EncoderKindPtr make_socketcan(const EncoderEntry& entry) {
  CanSettings settings = read_can_settings(entry.node, entry.joints, entry.folder, entry.problems);
  return std::make_shared<SocketCan>(std::move(settings));
}

}  // namespace selfcal
