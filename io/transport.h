// What the families of transports share: what a port is opened with, whose clock stamps what comes
// in, and the robot's end of a transport, for a robot that is played.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/ports.h"
#include "io/wakeup.h"

namespace selfcal {

/// Whose clock stamps what comes in. Only stamps of one clock say where the joints were at an edge.
enum class StampedBy : std::uint8_t {
  sender,  ///< the robot's, in every message; its transport brings it to ours
  kernel,  ///< this computer's: CLOCK_MONOTONIC, taken as the frame or the edge comes in
};

/// What the transports over DDS are opened with beside the rest: io/dds/context.h, which no other
/// transport includes.
struct DdsContext;

/// What a port is opened with; the wakeup outlives the port.
struct PortContext {
  const DdsContext& dds;
  Wakeup& wakeup;
  Nanoseconds silence = kSecond / 2;  ///< of what repeats itself, after which it counts as lost
};

/// What a robot's end of a transport is opened with.
struct RobotContext {
  const DdsContext& dds;
  Wakeup& wakeup;
  std::string trigger_pull;  ///< gpio-sim's file that drives the trigger line, or empty
};

/// The robot's end of an encoder transport.
class JointSender {
 public:
  virtual ~JointSender() = default;
  /// Sends the readings `q` (rad or m, by joint) of the moment `stamp` (ns). Where the kernel
  /// stamps what comes in, the moment of the call is that moment, or that of the mark before it.
  virtual Result<void> send(Nanoseconds stamp, const std::vector<double>& q) = 0;
  /// Whether the transport marks the moment (SYNC) before it carries the positions.
  virtual bool marks() const { return false; }
  /// Marks the moment, or waits for its mark, and gives it on CLOCK_MONOTONIC; nothing when none
  /// has come within `longest`.
  virtual Result<std::optional<Nanoseconds>> mark(Nanoseconds longest) {
    (void)longest;
    return std::optional<Nanoseconds>();
  }
};

/// The robot's end of a trigger transport.
class TriggerSender {
 public:
  virtual ~TriggerSender() = default;
  /// Sends the level and the moment `stamp` (ns) at which it was taken; may be repeated.
  virtual Result<void> send(Nanoseconds stamp, bool closed) = 0;
};

}  // namespace selfcal
