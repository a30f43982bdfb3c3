// What systemd is told of a service of Type=notify: one datagram to the socket that it names.
#pragma once

#include <string_view>

#include "io/ports.h"

namespace selfcal {

class Supervisor {
 public:
  /// Reads NOTIFY_SOCKET and WATCHDOG_USEC; without them every call does nothing.
  Supervisor();
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  void ready();
  void stopping();
  void status(std::string_view words);
  /// Says that the service lives, at most once each half period.
  void alive(Nanoseconds now);

 private:
  void send(std::string_view text) const;

  int socket_ = -1;
  Nanoseconds period_ = 0, last_ = 0;
};

}  // namespace selfcal
