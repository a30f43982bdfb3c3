// Commands: taken, handled at once, answered.
#include "app/service/service.h"

namespace selfcal {
namespace {

constexpr std::size_t kMostName = 64;  // of who sends a command

std::optional<Verb> verb_of(const std::string& text) {
  for (const Verb verb :
       {Verb::start, Verb::check, Verb::abort, Verb::accept, Verb::reject, Verb::rollback})
    if (text == to_string(verb)) return verb;
  return std::nullopt;
}

}  // namespace

void Service::handle_command(const CommandMessage& command) {
  const std::optional<Verb> verb = verb_of(command.verb);
  if (!verb)
    return messenger_.reply({command.id, command.verb, false,
                             "no command is called '" + command.verb +
                                 "'; known: start, check, abort, accept, reject, rollback"});
  if (*verb == Verb::check && !can_check())
    return messenger_.reply({command.id, command.verb, false,
                             "a quick check compares with an accepted session of this robot and "
                             "configuration, and there is none: start a full one"});
  // What came in before the command is handled first, so that it meets the situation as it is.
  handle_events();
  command_ = command;
  tell("info", "command " + command.verb + " from " + command.from.substr(0, kMostName));
  Event event;
  event.what = Event::What::asked;
  event.verb = *verb;
  put(std::move(event));
  handle_events();
  command_.reset();
}

void Service::answer(const Action& action) {
  if (!command_) return;
  const bool granted = action.what == Action::Do::grant;
  messenger_.reply({command_->id, command_->verb, granted, action.why});
  if (!granted) tell("warning", command_->verb + " refused: " + action.why);
}

}  // namespace selfcal
