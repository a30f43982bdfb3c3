// The parameters in use: what becomes of a result.
#include "app/service/loop/service.h"

namespace selfcal {

bool Service::reload_models() {
  auto models = Models::load(c_.models.factory(), c_.store);
  if (!models) {
    c_.put(Event::What::broken, false, std::string(kStoreFailed) + models.error().what);
    return false;
  }
  return use(std::move(*models));
}

bool Service::use(Models models) {
  c_.models = std::move(models);
  if (const auto written = c_.models.write_active(c_.config.state); !written) {
    c_.put(Event::What::broken, false, std::string(kStoreFailed) + written.error().what);
    return false;
  }
  return true;
}

/// A command is answered once what it asks is in the store, or cannot be.
bool Service::came_about(const Result<void>& done) {
  if (command_)
    answer(done ? Action{Action::Do::grant, command_->verb}
                : Action{Action::Do::refuse, done.error().what});
  return c_.stored(done);
}

/// What was decided when the store failed may have come about or not; what is damaged stays as it
/// is known until a start sets it aside.
void Service::recall_models() {
  auto models = Models::load(c_.models.factory(), c_.store);
  if (!models || !use(std::move(*models))) return;
  finish_interrupted_apply();
  c_.extended_state.candidate = c_.models.candidate();
}

void Service::apply(const std::string& why) {
  if (!came_about(c_.store.accept(c_.unix_ms()))) return;
  analyst_.forget_check();
  c_.put(Event::What::applied);
  if (reload_models()) c_.tell("info", c_.models.name() + " is active: " + why);
}

void Service::finish_interrupted_apply() {
  const auto last = c_.store.results(1);
  if (!last || last->empty() || last->front().decision != ResultDecision::applying) return;
  const auto slot = c_.store.slot(Slot::candidate);
  if (!slot || !*slot || (*slot)->session != last->front().session ||
      (*slot)->model_hash != c_.models.hash())
    return;
  if (c_.stored(c_.store.accept(c_.unix_ms())) && reload_models())
    c_.tell("info", c_.models.name() + " is active, as was decided before an interruption");
}

void Service::reject() {
  if (came_about(c_.store.reject(c_.unix_ms()))) reload_models();
}

void Service::roll_back() {
  const auto active = c_.store.slot(Slot::active);
  if (active && *active && (*active)->session != 0 && (*active)->model_hash != c_.models.hash()) {
    if (command_)
      refuse(*command_,
             "what is stored belongs to another robot, or to this one by another file: "
             "it is left as it is; active: " +
                 c_.models.name());
    return;
  }
  const std::string given_up = c_.models.name();
  const auto done = c_.store.roll_back(c_.unix_ms());
  if (!done) {
    if (command_) refuse(*command_, done.error().what + "; active: " + c_.models.name());
    return;
  }
  if (!reload_models()) return;
  analyst_.forget_check();
  tell_result();
  const std::string said = c_.models.name() + " is active now; " + given_up +
                           " was rolled back and is not used again by itself";
  if (command_) grant(*command_, said);
  c_.tell("warning", said);
  c_.put(Event::What::rolled_back, true, said);
}

void Service::publish() {
  tell_result();
  c_.put(Event::What::published);
}

/// The last one, with what became of it.
void Service::tell_result() {
  const auto results = c_.store.results(1);
  if (results && !results->empty()) {
    const auto result = c_.store.result(results->front().session);
    if (!c_.stored(result) || !*result) return;
    const auto session = c_.store.session(results->front().session);
    if (session && session->model_hash == c_.models.hash()) reporter_.result(**result);
  }
}

}  // namespace selfcal
