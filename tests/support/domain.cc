#include "tests/support/domain.h"

#include <stdlib.h>
#include <unistd.h>

#include "io/clock.h"

namespace selfcal {

namespace {

/// Participants that meet only over the loopback interface, and only those with the same tag.
void meet_on_loopback(const std::string& tag) {
  const std::string configuration =
      "<General><Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>"
      "<AllowMulticast>false</AllowMulticast></General>"
      "<Discovery><Tag>" +
      tag +
      "</Tag><ParticipantIndex>auto</ParticipantIndex>"
      "<MaxAutoParticipantIndex>30</MaxAutoParticipantIndex>"
      "<Peers><Peer address=\"127.0.0.1\"/></Peers><SPDPInterval>100ms</SPDPInterval>"
      "<LeaseDuration>1s</LeaseDuration></Discovery>";
  setenv("CYCLONEDDS_URI", configuration.c_str(), 1);
}

}  // namespace

std::uint32_t new_domain() {
  static std::uint32_t count = 0;
  // The tag parts processes that come upon the same number. Beyond 100 the ports would be those
  // that the system hands out to anyone.
  meet_on_loopback(std::to_string(getpid()) + "." + std::to_string(count));
  return 1 + (static_cast<std::uint32_t>(getpid()) * 13 + count++) % 100;
}

std::uint32_t open_domain() {
  meet_on_loopback("");
  return 101;
}

bool eventually(Wakeup& wakeup, const std::function<bool()>& holds) {
  const Nanoseconds end = monotonic_now() + kLimit;
  while (!holds()) {
    if (monotonic_now() > end) return false;
    wakeup.wait(5 * kMillisecond);
  }
  return true;
}

}  // namespace selfcal
