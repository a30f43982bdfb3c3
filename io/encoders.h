// Where joint readings come from: the family of encoder transports, one line each in encoders.def.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/transport.h"
#include "kinematics/description.h"
#include "kinematics/robot.h"

namespace selfcal {

/// The settings of one transport, read and checked; opens its port.
class EncoderKind {
 public:
  virtual ~EncoderKind() = default;
  virtual StampedBy stamped_by() const = 0;
  /// Where it listens, for a person: "topic joint_states".
  virtual std::string source() const = 0;
  virtual Result<std::unique_ptr<EncoderSource>> open(const PortContext& context) const = 0;
  /// The robot's end, for a robot that is played.
  virtual Result<std::unique_ptr<JointSender>> open_sender(const RobotContext& context) const = 0;
};
using EncoderKindPtr = std::shared_ptr<const EncoderKind>;

/// What a kind is made from.
struct EncoderEntry {
  const Node& node;                        ///< the kind's own keys; it refuses any other
  const std::vector<std::string>& joints;  ///< names, by joint
  const std::vector<Joint>& of_robot;      ///< the same joints, with their limits
  const std::filesystem::path& folder;     ///< where relative paths begin
  Problems& problems;
};

/// Names of all kinds, as the list has them.
const std::vector<std::string_view>& encoder_kinds();
/// One of encoder_kinds(); what is wrong in the entry becomes a problem, and nothing may come back.
EncoderKindPtr make_encoders(std::string_view kind, const EncoderEntry& entry);

}  // namespace selfcal
