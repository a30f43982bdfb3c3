// Commands: taken, handled at once, answered.
#include "app/service/loop/service.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostName = 64;  // of who sends a command

}  // namespace

void Service::handle_commands() {
  std::vector<CommandMessage> commands;
  c_.messenger.take(commands);
  for (const CommandMessage& command : commands) handle_command(command);
  tell_refused();
  reporter_.refused(refused_.total);
}

void Service::handle_command(const CommandMessage& command) {
  const std::optional<Verb> verb = verb_of(command.verb);
  if (!verb)
    return refuse(command, "no command is called '" + command.verb.substr(0, kMostName) +
                               "'; known: " + verb_names());
  if (const std::string forbidden = c_.config.commands.forbids(*verb); !forbidden.empty())
    return refuse(command, forbidden);
  if (*verb == Verb::check && !analyst_.can_check())
    return refuse(command,
                  "a quick check compares with an accepted session of this robot and "
                  "configuration, and there is none: start a full one");
  if (*verb == Verb::diagnose && !analyst_.can_diagnose())
    return refuse(command,
                  "a cause is looked for in what a full session of this robot and configuration "
                  "leaves, and there is none: start one");
  if (*verb == Verb::done)
    if (const std::string unfit = collector_.unfit_to_go_on(); !unfit.empty())
      return refuse(command, unfit);
  // What came in before the command is handled first, so that it meets the state as it is.
  handle_events();
  command_ = command;
  Event event;
  event.what = Event::What::commanded;
  event.verb = *verb;
  c_.put(std::move(event));
  handle_events();
  command_.reset();
}

void Service::answer(const Action& action) {
  if (!command_) return;
  if (action.what != Action::Do::grant) return refuse(*command_, action.why);
  grant(*command_, action.why);
}

void Service::grant(const CommandMessage& command, const std::string& why) {
  c_.messenger.reply({command.id, command.verb, true, why});
  c_.record("info", "command " + command.verb + " from " + command.from.substr(0, kMostName));
}

void Service::refuse(const CommandMessage& command, const std::string& why) {
  c_.messenger.reply({command.id, command.verb, false, why});
  ++refused_.total;
  refused_.last =
      command.verb.substr(0, kMostName) + " from " + command.from.substr(0, kMostName) + ": " + why;
}

/// Once a second at most: who asks again and again must not fill the log, nor keep the loop.
void Service::tell_refused() {
  const std::uint64_t unheard = c_.messenger.refused();
  if (unheard > refused_.unheard) refused_.last = "too many in a second";
  refused_.total += unheard - refused_.unheard;
  refused_.unheard = unheard;
  if (refused_.total == refused_.told || c_.now - refused_.told_at < kSecond) return;
  const std::uint64_t count = refused_.total - refused_.told;
  c_.tell("warning",
          (count == 1 ? "refused " : std::to_string(count) + " commands refused, the last: ") +
              refused_.last);
  refused_.told = refused_.total;
  refused_.told_at = c_.now;
}

}  // namespace selfcal
