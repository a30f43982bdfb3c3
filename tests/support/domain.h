// A DDS domain of a test's own, on the loopback interface, and waiting for events with a limit.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "io/dds/participant.h"
#include "io/wakeup.h"

namespace selfcal {

/// Long enough for a loaded machine; nothing waits that long when all is well.
inline constexpr Nanoseconds kLimit = 20 * kSecond;

/// Sets the environment so that participants of this process (and of those that it starts) meet
/// only each other, over the loopback interface; a peer that dies is missed after a second. Returns
/// a domain's number that no other test of this process has.
std::uint32_t new_domain();

/// The same for peers on another vendor's DDS, which knows no tags: a domain for one test of this
/// computer at a time.
std::uint32_t open_domain();

/// The value, or a failed test and the end of the program.
template <class T>
T must(Result<T> result) {
  if (result) return *std::move(result);
  ADD_FAILURE() << result.error().what;
  std::abort();
}
inline void must(const Result<void>& result) {
  EXPECT_TRUE(result) << (result ? "" : result.error().what);
}

/// Waits until `holds`, which is asked at every news and every 5 ms at least; false after kLimit.
bool eventually(Wakeup& wakeup, const std::function<bool()>& holds);

/// A test with a domain, a participant and a wakeup.
class DdsTest : public ::testing::Test {
 protected:
  bool eventually(const std::function<bool()>& holds) { return selfcal::eventually(wakeup, holds); }

  std::uint32_t domain = new_domain();
  Wakeup wakeup;
  DdsParticipant participant = must(DdsParticipant::open(domain, "test"));
};

}  // namespace selfcal
