// Raw CAN sockets (Linux, PF_CAN). One class only hears and one only speaks: who opens a receiver
// cannot write to the bus.
#pragma once

#include <string>
#include <vector>

#include "io/can/descriptor.h"
#include "io/can/frame.h"
#include "io/result.h"

namespace selfcal {

/// How a reading ended.
enum class CanRead : std::uint8_t {
  drained,  ///< nothing is waiting any more
  more,     ///< more is waiting
  down,     ///< the interface has gone down; the socket hears again when it is up
  gone,     ///< the interface is no longer there: open it anew
};

struct CanReceiverOptions {
  std::string interface;
  std::vector<CanId> ids;        ///< the kernel passes on data frames of these only
  bool fd = false;               ///< FD frames too
  bool errors = true;            ///< the controller's reports too
  int receive_buffer = 1 << 20;  ///< bytes asked for; the kernel gives what it may
};

class CanReceiver {
 public:
  static constexpr std::size_t kMost = 64;  ///< frames in one reading

  /// An interface that is down is opened, and heard once it is up.
  static Result<CanReceiver> open(const CanReceiverOptions& options);

  /// Appends what is waiting, at most kMost, with the kernel's stamps and losses. Never blocks.
  /// For some milliseconds after the opening data frames may be passed over, as their stamps say
  /// nothing.
  Result<CanRead> read(std::vector<CanFrame>& out);
  /// Readable when something is waiting.
  int handle() const { return socket_.handle(); }
  bool interface_up() const;

 private:
  CanReceiver(Descriptor socket, std::string interface)
      : socket_(std::move(socket)), interface_(std::move(interface)) {}

  Descriptor socket_;
  std::string interface_;
  std::uint32_t dropped_ = 0;  ///< by the kernel since the opening, as of the last frame
  bool stamped_ = false;       ///< frames are stamped as they come in, which was seen
};

class CanSender {
 public:
  static Result<CanSender> open(const std::string& interface, bool fd);
  /// Hands the frame to the interface, or fails at once.
  Result<void> send(const CanFrame& frame);

 private:
  CanSender(Descriptor socket, std::string interface)
      : socket_(std::move(socket)), interface_(std::move(interface)) {}

  Descriptor socket_;
  std::string interface_;
};

}  // namespace selfcal
