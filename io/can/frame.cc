#include "io/can/frame.h"

#include <algorithm>
#include <cstdio>

namespace selfcal {

std::string to_string(const CanId& id) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), id.extended ? "0x%xx" : "0x%x", id.value);
  return text.data();
}

std::uint8_t payload_size(int bytes, bool fd) {
  if (!fd || bytes <= 8) return static_cast<std::uint8_t>(std::clamp(bytes, 0, 8));
  // ISO 11898-1: data length codes 9 to 15.
  for (const int size : {12, 16, 20, 24, 32, 48})
    if (bytes <= size) return static_cast<std::uint8_t>(size);
  return 64;
}

}  // namespace selfcal
