// The service's voice and ear over DDS.
//
// Reader and writer of a topic do not find each other at the same moment, so the first reply to a
// sender may find nobody. The sender says its command again then, with the same id; it is known
// here for kReplyRemembered and answered from memory.

#include "io/dds/messenger.h"

#include <algorithm>

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/opened.h"

namespace selfcal {
namespace {

constexpr Nanoseconds kReplyRemembered = 60 * kSecond;
constexpr std::size_t kMostKnown =
    2 * DdsMessenger::kMostCommands * (kReplyRemembered / kSecond + 1);

}  // namespace

Result<bool> has_service(const DdsParticipant& participant, const std::string& robot,
                         Nanoseconds limit, Wakeup& wakeup) {
  const auto status =
      DdsReader<dds::Status>::open(participant, robot_topic(robot, "status"), kLatched, &wakeup);
  if (!status) return tl::unexpected(status.error());
  for (const Nanoseconds end = monotonic_now() + limit; status->matched() == 0;) {
    const Nanoseconds left = end - monotonic_now();
    if (left <= 0) return false;
    wakeup.wait(left);
  }
  return true;
}

Result<std::unique_ptr<DdsMessenger>> DdsMessenger::open(const DdsParticipant& participant,
                                                         const std::string& robot, Wakeup& wakeup) {
  Endpoints endpoints;
  DdsOpening opening(participant);
  opening.open(endpoints.status, robot_topic(robot, "status"), kLatched);
  opening.open(endpoints.progress, robot_topic(robot, "progress"), kProgress);
  opening.open(endpoints.result, robot_topic(robot, "result"), kLatched);
  opening.open(endpoints.diagnostics, ros_topic("diagnostics"), kDiagnostics);
  opening.open(endpoints.reply, robot_topic(robot, "command_reply"), kReplies);
  opening.open(endpoints.command, robot_topic(robot, "command"), kExchangeReader, &wakeup);
  opening.open(endpoints.own_status, robot_topic(robot, "status"), kLatched);
  return opening.finish(
      [&] { return std::unique_ptr<DdsMessenger>(new DdsMessenger(robot, std::move(endpoints))); });
}

void DdsMessenger::publish(const StatusMessage& status) {
  count(dds_.status.write(borrow(status)));
}

void DdsMessenger::publish(const ProgressMessage& progress) {
  count(dds_.progress.write(borrow(progress)));
}

void DdsMessenger::publish(const ResultMessage& result) {
  count(dds_.result.write(borrow(result)));
}

void DdsMessenger::publish(const std::vector<HealthMessage>& health,
                           const std::string& hardware_id) {
  const DiagnosticsToSend diagnostics(health, robot_, hardware_id, realtime_now() / kMillisecond);
  count(dds_.diagnostics.write(diagnostics.message()));
}

void DdsMessenger::reply(const CommandReplyMessage& reply) {
  const auto of = std::find_if(known_.begin(), known_.end(),
                               [&](const Known& known) { return known.reply.id == reply.id; });
  if (of != known_.end()) {
    of->reply = reply;
    of->replied = true;
  }
  send(reply);
}

void DdsMessenger::take(std::vector<CommandMessage>& out) {
  const Nanoseconds now = monotonic_now();
  // A failure to read is a bug of ours or of the library's; the next call tries again.
  (void)dds_.command.take(kMostRead, [&](const dds::Command& received) {
    CommandMessage command = to_plain(received);
    if (std::max({command.id.size(), command.verb.size(), command.from.size()}) > kMostText) {
      ++refused_;
      return send({.id = command.id.substr(0, kMostText),
                   .verb = command.verb.substr(0, kMostText),
                   .accepted = false,
                   .why = "longer than any command"});
    }
    if (known(command)) return;
    CommandReplyMessage reply{.id = command.id, .verb = command.verb, .accepted = false, .why = ""};
    if (!(command.verb == "abort" ? aborts_ : commands_).take(now)) {
      ++refused_;
      reply.why = "more than " + std::to_string(kMostCommands) + " commands in a second";
      send(reply);
      return;
    }
    remember(std::move(reply));
    out.push_back(std::move(command));
  });
}

// Whether the command has been taken before; its reply is repeated then.
bool DdsMessenger::known(const CommandMessage& command) {
  const Nanoseconds now = monotonic_now();
  std::erase_if(known_, [&](const Known& known) { return now - known.taken > kReplyRemembered; });
  for (const auto& known : known_) {
    if (command.id.empty() || known.reply.id != command.id) continue;
    if (known.replied) send(known.reply);
    return true;
  }
  return false;
}

void DdsMessenger::remember(CommandReplyMessage reply) {
  if (known_.size() >= kMostKnown) known_.pop_front();
  known_.push_back({.reply = std::move(reply), .taken = monotonic_now()});
}

void DdsMessenger::send(const CommandReplyMessage& reply) {
  count(dds_.reply.write(borrow(reply)));
}

void DdsMessenger::count(const Result<void>& written) {
  if (!written) ++unsent_;
}

}  // namespace selfcal
