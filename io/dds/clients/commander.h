// Commands to a service, each with its reply.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "io/dds/endpoint.h"
#include "io/messages.h"
#include "io/ports.h"

namespace selfcal {

class DdsCommander {
 public:
  static Result<std::unique_ptr<DdsCommander>> open(const DdsParticipant& participant,
                                                    const std::string& robot);

  /// Waits for the service, sends the command and waits for its reply, all within `limit`. The id
  /// must be new: as long as no reply comes the command is said again, and the service obeys an id
  /// once. Fails when no service or no reply comes; a refusal is a reply.
  Result<CommandReplyMessage> send(const CommandMessage& command, Nanoseconds limit);

  /// An id never used before.
  static std::string new_id();

 private:
  explicit DdsCommander(std::string robot) : robot_(std::move(robot)) {}
  bool connected() const { return commands_.matched() > 0 && replies_.matched() > 0; }
  Result<std::optional<CommandReplyMessage>> take_reply(const std::string& id);

  Wakeup wakeup_;
  std::string robot_;
  DdsWriter<dds::Command> commands_;
  DdsReader<dds::CommandReply> replies_;
};

}  // namespace selfcal
