// Sends SYNC at a steady period, where the service was told to.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "io/can/socket.h"

namespace selfcal {

class SyncSender {
 public:
  static Result<std::unique_ptr<SyncSender>> open(const std::string& interface, const CanId& id,
                                                  double period);

 private:
  SyncSender(CanSender sender, std::string interface, const CanId& id, double period);
  void run(const std::stop_token& stop);

  CanSender sender_;
  std::string interface_;
  CanId id_;
  Nanoseconds period_;
  std::jthread thread_;  ///< last: ends before what it uses
};

}  // namespace selfcal
