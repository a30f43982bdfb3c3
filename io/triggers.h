// Where the touch comes from: the family of trigger transports, one line each in triggers.def.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/transport.h"
#include "kinematics/description.h"

namespace selfcal {

/// The settings of one transport, read and checked; opens its port.
class TriggerKind {
 public:
  virtual ~TriggerKind() = default;
  virtual StampedBy stamped_by() const = 0;
  /// Where it listens, for a person: "line 3 of gpiochip0".
  virtual std::string source() const = 0;
  virtual Result<std::unique_ptr<TouchTrigger>> open(const PortContext& context) const = 0;
  /// The robot's end, for a robot that is played.
  virtual Result<std::unique_ptr<TriggerSender>> open_sender(const RobotContext& context) const = 0;
};
using TriggerKindPtr = std::shared_ptr<const TriggerKind>;

/// What a kind is made from.
struct TriggerEntry {
  const Node& node;          ///< the kind's own keys; it refuses any other
  const std::string& robot;  ///< the robot's id
  Problems& problems;
};

/// Names of all kinds, as the list has them.
const std::vector<std::string_view>& trigger_kinds();
/// One of trigger_kinds(); what is wrong in the entry becomes a problem, and nothing may come back.
TriggerKindPtr make_trigger(std::string_view kind, const TriggerEntry& entry);

}  // namespace selfcal
