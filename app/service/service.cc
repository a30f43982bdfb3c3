#include "app/service/service.h"

#include <spdlog/spdlog.h>

namespace selfcal {
namespace {

constexpr std::size_t kMostEvents = 1024;

}  // namespace

Service::Service(Config config, const Ports& ports, Messenger& messenger, Store& store,
                 Journal& journal, Models models, std::string damaged)
    : config_(std::move(config)),
      ports_(ports),
      messenger_(messenger),
      store_(store),
      journal_(journal),
      models_(std::move(models)),
      damaged_(std::move(damaged)),
      reflex_(ports, nanoseconds(config_.touch.debounce)),
      senses_(ports, reflex_, config_.touch.rest, nanoseconds(config_.silence)) {
  now_ = test_began_ = last_turn_ = began_ = ports_.clock->now();
  // Requests of an earlier life must not be taken for ours.
  motion_id_ = static_cast<std::uint64_t>(ports_.clock->unix_ms()) * 1000;
  situation_.since = now_;
  situation_.why = "testing encoders, trigger and store";
  testing_ = true;
  if (!damaged_.empty())
    tell("error", "the store was damaged: " + damaged_);
  else
    recall_damage();
  if (!models_.refused().empty()) tell("error", models_.refused());
  const auto unfinished = store_.unfinished();
  if (stored(unfinished)) situation_.unfinished = unfinished->has_value();
  finish_interrupted_apply();
  recall_use();
  situation_.candidate = models_.candidate();
  outstanding_ = situation_.unfinished;  // of an earlier life, told to stop until it stands
  if (outstanding_) stop("the service has started");
  tell("info", "started with " + models_.name() + " parameters");
  supervisor_.ready();
}

void Service::put(Event event) {
  event.now = now_;
  if (events_.size() < kMostEvents) events_.push_back(std::move(event));
}

void Service::put(Event::What what, bool ok, std::string why) {
  Event event;
  event.what = what;
  event.ok = ok;
  event.why = std::move(why);
  put(std::move(event));
}

template <class T>
bool Service::stored(const Result<T>& result) {
  if (result) return true;
  spdlog::error("{}", result.error().what);
  put(Event::What::broken, false, "store: " + result.error().what);
  return false;
}
template bool Service::stored(const Result<void>&);
template bool Service::stored(const Result<std::optional<SessionRecord>>&);
template bool Service::stored(const Result<std::optional<ResultRecord>>&);
template bool Service::stored(const Result<std::int64_t>&);

void Service::turn() {
  now_ = ports_.clock->now();
  listen();
  check_rivals();
  check_self();
  check_rest();
  check_stop();
  check_schedule();
  std::string failure;
  if (computation_.take(failure) && when_computed_) std::exchange(when_computed_, {})(failure);
  put(Event::What::tick);
  handle_events();
  report();
  if (reflex_.alive(now_)) supervisor_.alive(now_);
  last_turn_ = now_;
  ports_.clock->wait(longest_wait());
}

void Service::listen() {
  senses_.listen(now_, events_);
  check_senses();
  if (senses_.moving()) motion_hours_ += seconds(now_ - last_turn_) / 3600;
  std::vector<CommandMessage> commands;
  messenger_.take(commands);
  for (const CommandMessage& command : commands) handle_command(command);
  tell_refused();
}

void Service::handle_events() {
  while (!events_.empty()) {
    const Event event = std::move(events_.front());
    events_.pop_front();
    if (event.what == Event::What::moved) reached_ = asked_;
    Transition transition = step(situation_, event, config_.limits);
    const bool held = situation_.held;
    situation_ = std::move(transition.next);
    if (situation_.held != held) remember_held();
    for (const Action& action : transition.actions) act(action);
  }
}

Nanoseconds Service::longest_wait() const {
  switch (situation_.state) {
    case ServiceState::collecting:
      // An edge ends the wait early where the trigger can say so.
      return situation_.phase == Phase::touch || situation_.phase == Phase::settle
                 ? 8 * kMillisecond
                 : 20 * kMillisecond;
    case ServiceState::idle:
    case ServiceState::awaiting_acceptance:
    case ServiceState::fault:
      return 100 * kMillisecond;
    default:
      return 20 * kMillisecond;
  }
}

void Service::shut_down() {
  if (may_move(situation_.state)) stop("the service is shutting down");
  if (situation_.engaged) release();
  remember_use();
  tell("info", "shut down");
  supervisor_.stopping();
}

}  // namespace selfcal
