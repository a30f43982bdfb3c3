// Commands to a service, each with its reply.

#include "io/dds/clients/commander.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "io/dds/convert.h"
#include "io/dds/names.h"
#include "io/dds/opened.h"

namespace selfcal {
namespace {

// A command without a reply is said again after this long.
constexpr Nanoseconds kPatience = 250 * kMillisecond;

}  // namespace

Result<std::unique_ptr<DdsCommander>> DdsCommander::open(const DdsParticipant& participant,
                                                         const std::string& robot) {
  std::unique_ptr<DdsCommander> commander(new DdsCommander(robot));
  Wakeup* wakeup = &commander->wakeup_;
  DdsOpening opening(participant);
  opening.open(commander->replies_, robot_topic(robot, "command_reply"), kExchange, wakeup);
  opening.open(commander->commands_, robot_topic(robot, "command"), kExchange, wakeup);
  return opening.finish([&] { return std::move(commander); });
}

Result<CommandReplyMessage> DdsCommander::send(const CommandMessage& command, Nanoseconds limit) {
  const Nanoseconds end = monotonic_now() + limit;
  Nanoseconds next = 0;  // when to say it (again)
  bool said = false;
  for (Nanoseconds now = monotonic_now(); now < end; now = monotonic_now()) {
    if (connected() && now >= next) {
      if (auto written = commands_.write(borrow(command)); !written)
        return tl::make_unexpected(written.error());
      said = true;
      next = now + kPatience;
    }
    wakeup_.wait(std::min(end, said ? next : end) - now);
    auto reply = take_reply(command.id);
    if (!reply) return tl::make_unexpected(reply.error());
    if (*reply) return **std::move(reply);
  }
  if (said) return device_failed("the service of robot " + robot_ + " does not reply");
  return device_failed("there is no service of robot " + robot_ + " in this DDS domain");
}

Result<std::optional<CommandReplyMessage>> DdsCommander::take_reply(const std::string& id) {
  std::optional<CommandReplyMessage> found;
  auto taken = replies_.take([&](const dds::CommandReply& reply) {
    if (id == reply.id_) found = to_plain(reply);
  });
  if (!taken) return tl::make_unexpected(taken.error());
  return found;
}

std::string DdsCommander::new_id() {
  static std::atomic<int> count = 0;
  return std::to_string(realtime_now()) + "-" + std::to_string(getpid()) + "-" +
         std::to_string(++count);
}

}  // namespace selfcal
