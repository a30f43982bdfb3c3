// The service's voice and ear over DDS: its status, progress, results and health, and commands.
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <string>

#include "io/dds/allowance.h"
#include "io/dds/endpoint.h"
#include "io/messages.h"
#include "io/ports.h"

namespace selfcal {

/// Whether a service of `robot` is heard within `limit`: a second one must not even begin.
/// `wakeup` must outlive the call alone.
Result<bool> has_service(const DdsParticipant& participant, const std::string& robot,
                         Nanoseconds limit, Wakeup& wakeup);

class DdsMessenger : public Messenger {
 public:
  /// Heard in a second, and as many again of `abort`, which no flood of others may keep away.
  static constexpr int kMostCommands = 16;
  /// Of a command's id, verb or sender (bytes); longer ones are refused.
  static constexpr std::size_t kMostText = 256;
  /// Looked at in one call; the others wait for the next.
  static constexpr std::size_t kMostRead = 256;

  /// `robot` is the robot's id. `wakeup` hears of commands. Both others must outlive the messenger.
  static Result<std::unique_ptr<DdsMessenger>> open(const DdsParticipant& participant,
                                                    const std::string& robot, Wakeup& wakeup);

  void publish(const StatusMessage& status) override;
  void publish(const ProgressMessage& progress) override;
  void publish(const ResultMessage& result) override;
  /// The names are sent as "ROBOT/NAME", since all robots of a domain share the topic.
  void publish(const std::vector<HealthMessage>& health, const std::string& hardware_id) override;
  void reply(const CommandReplyMessage& reply) override;
  /// A command that was sent again is not taken again: its reply is repeated.
  void take(std::vector<CommandMessage>& out) override;

  std::uint64_t refused() const override { return refused_; }

  int rivals() const override { return std::max(0, dds_.own_status.matched() - 1); }

  std::uint64_t unsent() const override { return unsent_; }

 private:
  struct Endpoints {
    DdsWriter<dds::Status> status;
    DdsWriter<dds::Progress> progress;
    DdsWriter<dds::Result> result;
    DdsWriter<dds::DiagnosticArray> diagnostics;
    DdsWriter<dds::CommandReply> reply;
    DdsReader<dds::Command> command;
    DdsReader<dds::Status> own_status;  ///< tells of who else writes it; we are one
  };
  /// A command that was taken, and its reply once there is one.
  struct Known {
    CommandReplyMessage reply;
    bool replied = false;
    Nanoseconds taken = 0;
  };

  DdsMessenger(std::string robot, Endpoints endpoints)
      : robot_(std::move(robot)), dds_(std::move(endpoints)) {}
  bool known(const CommandMessage& command);
  void remember(CommandReplyMessage reply);
  void send(const CommandReplyMessage& reply);
  void count(const Result<void>& written);

  std::string robot_;
  Endpoints dds_;
  std::deque<Known> known_;  ///< the last commands, so that none is obeyed twice
  Allowance commands_{kMostCommands, kMostCommands}, aborts_{kMostCommands, kMostCommands};
  std::uint64_t refused_ = 0, unsent_ = 0;
};

}  // namespace selfcal
