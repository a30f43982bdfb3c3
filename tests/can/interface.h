// A real CAN interface for the tests that need the kernel: $SELFCAL_CAN_INTERFACE, or vcan0;
// $SELFCAL_CAN_ROBOT may name another one on the same bus, from which the robot sends. Such tests
// take turns, and skip with the reason where there is none.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "io/can/descriptor.h"
#include "io/can/encoders.h"
#include "io/can/robot_side.h"

namespace selfcal {

class CanInterfaceTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// Whether the interface is there in software only: what one sends all others hear at once.
  bool is_virtual() const;
  /// Brings the interface up or down, or gives its frames another size; false when not allowed.
  bool set_up(bool up) const;
  bool set_mtu(int mtu) const;
  int mtu() const;
  /// Frames that anybody has sent on it.
  std::uint64_t sent() const;

  /// Cia 402 nodes 1 and 2 with SYNC, 1 urad a count.
  CanSettings settings() const;

  std::string interface_;
  std::string robot_interface_;  ///< another one on the same bus, or the same

 private:
  Descriptor turn_;
  int mtu_ = 0;
};

/// Waits until `holds`, which is asked every millisecond; false after 20 s.
bool eventually(const std::function<bool()>& holds);

/// Sends until what is sent is heard: for some milliseconds after its opening a receiver passes
/// frames over. Reads all that was sent.
void settle(CanReceiver& receiver, CanSender& sender, const CanId& id);

/// The next `count` frames; fewer when they do not come.
std::vector<CanFrame> read_frames(CanReceiver& receiver, std::size_t count);

}  // namespace selfcal
