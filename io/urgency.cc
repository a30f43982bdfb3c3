// Real-time priority for the threads between a contact and the stop.
#include "io/urgency.h"

#include <pthread.h>
#include <sched.h>

#include <cstdlib>
#include <string>
#include <thread>

namespace selfcal {

bool become_urgent() {
  sched_param parameters{};
  parameters.sched_priority = kUrgentPriority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool may_become_urgent() {
  bool allowed = false;
  std::thread([&] { allowed = become_urgent(); }).join();
  return allowed;
}

// The library adds what stands behind a comma to what stands before it.
void receive_urgently() {
  if (!may_become_urgent()) return;
  const char* given = std::getenv("CYCLONEDDS_URI");
  std::string configuration = given && *given ? std::string(given) + "," : std::string();
  // Of several receiving threads only the one of this name takes a priority.
  configuration += "<Threads><Thread name=\"recv\"><Scheduling><Class>Realtime</Class><Priority>" +
                   std::to_string(kUrgentPriority) +
                   "</Priority></Scheduling></Thread></Threads>"
                   "<Internal><MultipleReceiveThreads>false</MultipleReceiveThreads></Internal>";
  setenv("CYCLONEDDS_URI", configuration.c_str(), 1);
}

}  // namespace selfcal
