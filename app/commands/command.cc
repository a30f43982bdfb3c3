// selfcal command VERB: asks the service, and says what it answers.
#include <cstdio>
#include <memory>

#include "app/commands/support/find_robot.h"
#include "app/commands/support/user.h"
#include "app/report/format.h"
#include "app/report/live/message_json.h"
#include "io/dds/clients/commander.h"

namespace selfcal {
namespace {

struct CommandArguments {
  std::string verb;
  Whom whom;
};

void print_reply(const CommandReplyMessage& reply, const std::string& robot, bool json) {
  if (json) {
    const auto object = nlohmann::ordered_json::object(
        {{"robot", robot}, {"verb", reply.verb}, {"accepted", reply.accepted}, {"why", reply.why}});
    std::printf("%s\n", line_of(object).c_str());
    return;
  }
  std::string text = reply.accepted ? "accepted" : "refused";
  if (!reply.why.empty() && reply.why != reply.verb) text += ": " + one_line(reply.why);
  std::printf("%s\n", text.c_str());
}

int ask_command(const CommandArguments& arguments) {
  const auto participant =
      DdsParticipant::open(static_cast<std::uint32_t>(arguments.whom.domain), "selfcal command");
  if (!participant) return tell(participant.error());
  const auto robot = find_robot(*participant, arguments.whom);
  if (!robot) return tell(robot.error());
  if (!*robot) return kDone;
  const auto commander = DdsCommander::open(*participant, **robot);
  if (!commander) return tell(commander.error());
  const auto reply =
      (*commander)
          ->send({.id = DdsCommander::new_id(), .verb = arguments.verb, .from = user_at_host()},
                 nanoseconds(arguments.whom.wait));
  if (!reply) return tell(reply.error());
  print_reply(*reply, **robot, arguments.whom.json);
  return reply->accepted ? kDone : kAnswerIsNo;
}

}  // namespace

void add_command(CLI::App& app, int& status) {
  auto arguments = std::make_shared<CommandArguments>();
  CLI::App* command =
      app.add_subcommand("command", "Ask the service; exit 1 when it refuses, with its reason");
  command
      ->add_option("VERB", arguments->verb,
                   "start a session, a quick check; diagnose what calibration leaves; done with "
                   "what it asks of a person; abort; "
                   "accept or reject the result that waits; "
                   "rollback to the parameters before")
      ->required()
      ->check(CLI::IsMember(
          {"start", "check", "diagnose", "done", "abort", "accept", "reject", "rollback"}));
  add_whom(*command, arguments->whom, "Most seconds to wait for a service, and for its reply");
  command->callback([arguments, &status] { status = ask_command(*arguments); });
}

}  // namespace selfcal
