// Computations beside the loop: never waited for, given up at their next word.
#include "app/service/loop/computation.h"

#include <gtest/gtest.h>

#include <atomic>

#include "io/clock.h"

namespace selfcal {
namespace {

/// Waits until `holds`; false after 20 s.
bool soon(const std::function<bool()>& holds) {
  const Nanoseconds end = monotonic_now() + 20 * kSecond;
  while (!holds()) {
    if (monotonic_now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(Computations, GiveTheirOutcomeOnce) {
  Computation computation;
  computation.start([](const Computation::Tell&) { return std::string("too warm"); });
  std::string failure;
  ASSERT_TRUE(soon([&] { return computation.take(failure); }));
  EXPECT_EQ(failure, "too warm");
  EXPECT_FALSE(computation.take(failure));
  EXPECT_FALSE(computation.running());
}

TEST(Computations, AreNotWaitedForWhenTheNextIsStarted) {
  Computation computation;
  std::atomic<bool> begun = false, let_go = false;
  computation.start([&](const Computation::Tell& tell) {
    begun = true;
    while (!let_go) std::this_thread::yield();
    tell("after", 1);
    return std::string("the first");
  });
  ASSERT_TRUE(soon([&] { return begun.load(); }));

  // Were the first waited for here, this thread could never let it go.
  computation.start([](const Computation::Tell&) { return std::string("the second"); });
  EXPECT_TRUE(computation.running());
  std::string failure;
  EXPECT_FALSE(computation.take(failure));
  let_go = true;

  ASSERT_TRUE(soon([&] { return computation.take(failure); }));
  EXPECT_EQ(failure, "the second");
}

TEST(Computations, EndAtTheirNextWordWhenGivenUp) {
  Computation computation;
  std::atomic<bool> went_on = false, begun = false;
  computation.start([&](const Computation::Tell& tell) {
    begun = true;
    for (;;) tell("planning", 0.5);
    went_on = true;
    return std::string();
  });
  ASSERT_TRUE(soon([&] { return begun.load(); }));
  computation.give_up();
  EXPECT_FALSE(computation.running());
  std::string failure;
  EXPECT_FALSE(computation.take(failure));
  computation.start([](const Computation::Tell&) { return std::string("next"); });
  ASSERT_TRUE(soon([&] { return computation.take(failure); }));
  EXPECT_EQ(failure, "next");
  EXPECT_FALSE(went_on);
}

TEST(Computations, TurnAnExceptionIntoAFailure) {
  Computation computation;
  computation.start(
      [](const Computation::Tell&) -> std::string { throw std::runtime_error("no memory"); });
  std::string failure;
  ASSERT_TRUE(soon([&] { return computation.take(failure); }));
  EXPECT_EQ(failure, "no memory");
}

}  // namespace
}  // namespace selfcal
