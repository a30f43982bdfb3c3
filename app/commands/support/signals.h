// The signals that end what runs until it is told to stop.
#pragma once

#include "io/clock.h"

namespace selfcal {

/// The longest wait of such a loop: a signal is obeyed so soon.
inline constexpr Nanoseconds kSignalWait = kSecond / 10;

/// Ends the loop that asks for it: SIGINT, SIGTERM or SIGHUP has come.
bool told_to_stop();
/// From now on these signals end loops and not the process.
void listen_to_signals();

}  // namespace selfcal
