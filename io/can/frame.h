// A CAN frame as received, without the kernel's types.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>

#include "io/ports.h"

namespace selfcal {

/// 11 bits, or 29 when extended.
struct CanId {
  std::uint32_t value = 0;
  bool extended = false;
  auto operator<=>(const CanId&) const = default;
  static constexpr std::uint32_t kMostStandard = 0x7ff, kMostExtended = 0x1fffffff;
};
std::string to_string(const CanId& id);  ///< "0x181", "0x18ff0102x" when extended

struct CanFrame {
  CanId id;            ///< of an error frame: its error classes
  bool fd = false;     ///< a frame with flexible data rate
  bool error = false;  ///< the controller's report of an error, no frame of the bus
  std::uint8_t size = 0;
  std::array<std::uint8_t, 64> data{};
  Nanoseconds stamp = 0;   ///< by the kernel, CLOCK_REALTIME
  std::uint32_t lost = 0;  ///< frames the kernel dropped since the one before
};

/// The least payload size that an FD (or classic) frame can have for `bytes`; 64 (8) at most.
std::uint8_t payload_size(int bytes, bool fd);

}  // namespace selfcal
