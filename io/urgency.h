// Real-time priority for the threads between a contact and the stop.
//
// Everything else on the computer waits for these, a runaway program on every core too; they sleep
// until an edge comes and then run for microseconds. The system allows it to root, or up to
// RLIMIT_RTPRIO (systemd: LimitRTPRIO).
#pragma once

namespace selfcal {

/// Of SCHED_FIFO, 1 to 99: above every ordinary thread, below the kernel's own (50).
inline constexpr int kUrgentPriority = 20;

/// Gives the calling thread the priority; false, and nothing changed, where that is not allowed.
bool become_urgent();
/// Whether become_urgent() is allowed here.
bool may_become_urgent();
/// Tells the DDS library, before the first participant is opened, to receive at that priority.
/// Nothing where that is not allowed: the library would not start.
void receive_urgently();

}  // namespace selfcal
