#include "app/service/transitions/state.h"

namespace selfcal {
namespace {

constexpr Verb kAllVerbs[] = {Verb::start, Verb::check,  Verb::diagnose, Verb::done,
                              Verb::abort, Verb::accept, Verb::reject,   Verb::rollback};

}  // namespace

std::string_view to_string(ServiceState state) {
  switch (state) {
    case ServiceState::self_test:
      return "self-test";
    case ServiceState::idle:
      return "idle";
    case ServiceState::planning:
      return "planning";
    case ServiceState::collecting:
      return "collecting";
    case ServiceState::analysing:
      return "analysing";
    case ServiceState::identifying:
      return "identifying";
    case ServiceState::judging:
      return "judging";
    case ServiceState::diagnosing:
      return "diagnosing";
    case ServiceState::awaiting_person:
      return "awaiting-person";
    case ServiceState::awaiting_acceptance:
      return "awaiting-acceptance";
    case ServiceState::applying:
      return "applying";
    case ServiceState::publishing:
      return "publishing";
    case ServiceState::fault:
      return "fault";
  }
  return "";
}

std::string_view to_string(Phase phase) {
  switch (phase) {
    case Phase::none:
      return "";
    case Phase::approach:
      return "approach";
    case Phase::touch:
      return "touch";
    case Phase::settle:
      return "settle";
    case Phase::retract:
      return "retract";
    case Phase::lock:
      return "lock";
    case Phase::visit:
      return "visit";
    case Phase::release:
      return "release";
  }
  return "";
}

std::string_view to_string(SessionKind kind) {
  switch (kind) {
    case SessionKind::full:
      return "full";
    case SessionKind::check:
      return "check";
    case SessionKind::cause:
      return "cause";
  }
  return "";
}

std::string_view to_string(Verb verb) {
  switch (verb) {
    case Verb::start:
      return "start";
    case Verb::check:
      return "check";
    case Verb::diagnose:
      return "diagnose";
    case Verb::done:
      return "done";
    case Verb::abort:
      return "abort";
    case Verb::accept:
      return "accept";
    case Verb::reject:
      return "reject";
    case Verb::rollback:
      return "rollback";
  }
  return "";
}

std::optional<Verb> verb_of(std::string_view text) {
  for (const Verb verb : kAllVerbs)
    if (text == to_string(verb)) return verb;
  return std::nullopt;
}

std::optional<SessionKind> kind_of(std::string_view text) {
  for (const SessionKind kind : {SessionKind::full, SessionKind::check, SessionKind::cause})
    if (text == to_string(kind)) return kind;
  return std::nullopt;
}

std::string verb_names() {
  std::string names;
  for (const Verb verb : kAllVerbs)
    names += (names.empty() ? "" : ", ") + std::string(to_string(verb));
  return names;
}

std::string_view hardware_may(ServiceState state, Phase phase) {
  switch (state) {
    case ServiceState::self_test:
      return "stand still; encoders and trigger are listened to";
    case ServiceState::collecting:
      break;
    case ServiceState::awaiting_person:
      return "stand still; a person changes the payload on its tool";
    case ServiceState::fault:
      return "stand still; told to stop; nothing moves until a person says start";
    case ServiceState::idle:
    case ServiceState::awaiting_acceptance:
      return "do what its owner wants; the service asks for no motion";
    default:
      return "stand still; the service computes";
  }
  switch (phase) {
    case Phase::approach:
      return "travel through free space; a touch stops it";
    case Phase::touch:
      return "move slowly towards the surface until the trigger closes";
    case Phase::settle:
      return "stand still; told to stop";
    case Phase::retract:
      return "move slowly out of the contact";
    case Phase::lock:
      return "stand still with every leg held while the lock engages, until the trigger closes";
    case Phase::visit:
      return "move slowly with the lock engaged, its legs giving way; the trigger's opening stops "
             "it";
    case Phase::release:
      return "stand still with every leg held while the lock opens, until the trigger opens";
    case Phase::none:
      return "stand still";
  }
  return "";
}

bool may_move(ServiceState state) { return state == ServiceState::collecting; }

}  // namespace selfcal
