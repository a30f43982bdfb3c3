// Another process of this program that plays a robot or a service.
#pragma once

#include <sys/types.h>

#include <string>

namespace selfcal {

class Peer {
 public:
  /// Starts this program as `role`, "robot" or "service", for robot "r" in `domain`.
  Peer(const std::string& role, std::uint32_t domain);
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;
  ~Peer() { kill(); }
  /// Ends it by SIGKILL, without a chance to say goodbye; once only.
  void kill();
  /// Asks it to end, and returns its exit status.
  int end();

 private:
  pid_t pid_ = 0;
};

/// What the other process runs; returns its exit status.
int play(const std::string& role, std::uint32_t domain);

}  // namespace selfcal
