// Encoders on a CAN bus (io/can/encoders.h), stamped by the kernel; the keys are in
// io/can/settings.h.

#include <algorithm>
#include <cmath>

#include "io/can/encoders.h"
#include "io/can/senders.h"
#include "io/encoders.h"

namespace selfcal {
namespace {

bool lies_within_one_turn(const CanJoint& joint, const Joint& limits) {
  const double half = std::abs(joint.scale.step) * static_cast<double>(joint.wraps_at) / 2;
  return limits.limited() && std::max(std::abs(limits.lower), std::abs(limits.upper)) < half;
}

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
  CanSettings settings =
      read_can_settings(entry.node, entry.of_robot, entry.folder, entry.problems);
  for (size_t j = 0; j < settings.map.joints.size() && j < entry.of_robot.size(); ++j) {
    CanJoint& joint = settings.map.joints[j];
    joint.within_one_turn = lies_within_one_turn(joint, entry.of_robot[j]);
  }
  return std::make_shared<SocketCan>(std::move(settings));
}

}  // namespace selfcal
