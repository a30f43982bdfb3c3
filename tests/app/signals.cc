// What ends a command that runs until it is told to stop.
#include "app/commands/support/signals.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

namespace selfcal {
namespace {

/// 0 where the signal ends the loop, 1 where it is not heard; the signal's own end otherwise.
[[noreturn]] void listen_and_get(int signal) {
  listen_to_signals();
  std::raise(signal);
  std::exit(told_to_stop() ? 0 : 1);
}

TEST(Signals, EndTheLoopAndNotTheProcess) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    EXPECT_EXIT(listen_and_get(signal), testing::ExitedWithCode(0), "") << signal;
}

TEST(Signals, OfALostTerminalAreIgnoredUnderNohup) {
  const auto under_nohup = [] {
    std::signal(SIGHUP, SIG_IGN);
    listen_and_get(SIGHUP);
  };
  EXPECT_EXIT(under_nohup(), testing::ExitedWithCode(1), "");
}

}  // namespace
}  // namespace selfcal
