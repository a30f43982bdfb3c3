#include "app/service/service.h"

#include <spdlog/spdlog.h>

#include <ctime>

namespace selfcal {
namespace {

constexpr std::size_t kMostEvents = 1024;
constexpr std::size_t kMostName = 64;                 // of who sends a command
constexpr Nanoseconds kResumeWithin = 120 * kSecond;  // of the start; later only a person resumes
constexpr Nanoseconds kStopAgain = kSecond / 2;       // until the robot stands

std::optional<Verb> verb_of(const std::string& text) {
  for (const Verb verb :
       {Verb::start, Verb::check, Verb::abort, Verb::accept, Verb::reject, Verb::rollback})
    if (text == to_string(verb)) return verb;
  return std::nullopt;
}

int utc_offset(std::int64_t unix_ms) {
  const std::time_t t = unix_ms / 1000;
  std::tm local{};
  localtime_r(&t, &local);
  return static_cast<int>(local.tm_gmtoff);
}

}  // namespace

Service::Service(Config config, const Ports& ports, Messenger& messenger, Store& store,
                 Models models, std::string damaged)
    : config_(std::move(config)),
      ports_(ports),
      messenger_(messenger),
      store_(store),
      models_(std::move(models)),
      damaged_(std::move(damaged)),
      senses_(ports, nanoseconds(config_.touch.debounce), config_.touch.rest,
              nanoseconds(config_.silence)) {
  now_ = test_began_ = last_turn_ = began_ = ports_.clock->now();
  // Requests of an earlier life must not be taken for ours.
  motion_id_ = static_cast<std::uint64_t>(ports_.clock->unix_ms()) * 1000;
  situation_.since = now_;
  situation_.why = "testing encoders, trigger and store";
  testing_ = true;
  if (!damaged_.empty()) tell("error", "the store was damaged: " + damaged_);
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
  check_self();
  check_rest();
  check_stop();
  check_schedule();
  std::string failure;
  if (computation_.take(failure) && when_computed_) std::exchange(when_computed_, {})(failure);
  put(Event::What::tick);
  handle_events();
  report();
  supervisor_.alive(now_);
  last_turn_ = now_;
  ports_.clock->wait(longest_wait());
}

void Service::listen() {
  senses_.listen(now_, events_);
  const bool needed = may_move(situation_.state);
  if (needed && !senses_.encoders_alive(now_))
    put(Event::What::broken, false,
        "no encoder reading for " + format_number(config_.silence) + " s");
  if (needed && !senses_.closed()) put(Event::What::broken, false, "the trigger is gone");
  if (needed && ports_.encoders->senders() > 1)
    put(Event::What::broken, false, "two senders of encoder readings: are they of two robots?");
  if (senses_.moving()) motion_hours_ += seconds(now_ - last_turn_) / 3600;
  std::vector<CommandMessage> commands;
  messenger_.take(commands);
  for (const CommandMessage& command : commands) handle_command(command);
}

void Service::check_self() {
  if (!testing_) return;
  const auto joints = static_cast<int>(config_.robot->joints().size());
  std::string missing;
  if (!senses_.encoders_alive(now_) || !senses_.at_rest())
    missing = "no encoder readings come in";
  else if (ports_.encoders->senders() > 1)
    missing = "two senders of encoder readings: are they of two robots?";
  else if (situation_.unfinished && !*senses_.at_rest())
    missing = "the robot moves";
  else if (senses_.samples().last().joints != joints)
    missing = "the encoders give " + std::to_string(senses_.samples().last().joints) +
              " joints, the robot has " + std::to_string(joints);
  else if (!senses_.closed())
    missing = "the trigger's level is not known";
  else if (*senses_.closed() && !situation_.unfinished)
    missing = "the trigger is closed: stuck, inverted, or in contact";
  if (!missing.empty() && now_ - test_began_ < config_.limits.self_test - kSecond) return;
  testing_ = false;
  Event event;
  event.what = Event::What::self_tested;
  event.ok = missing.empty();
  event.why = missing;
  event.resume = config_.resume && !situation_.tested && now_ - began_ < kResumeWithin;
  put(std::move(event));
}

void Service::check_rest() {
  if (situation_.state != ServiceState::collecting || situation_.phase != Phase::settle) return;
  if (senses_.at_rest() != true || !senses_.closing()) return;
  const Nanoseconds edge = senses_.closing()->time - nanoseconds(config_.touch.delay);
  if (senses_.samples().last().time > edge) put(Event::What::at_rest);
}

/// A stop may be lost on the way, or come before the robot listens: it is said until it stands.
void Service::check_stop() {
  if (stopped_ == 0) return;
  if (senses_.encoders_alive(now_) && senses_.at_rest() == true && now_ - stopped_ > kStopAgain) {
    stopped_ = 0;
    outstanding_ = false;
    return;
  }
  if (now_ - stopped_ < kStopAgain || may_move(situation_.state)) return;
  stop("until it stands");
}

void Service::check_schedule() {
  if (situation_.state != ServiceState::idle || !config_.schedule.any()) return;
  if (now_ - last_due_ < kSecond) return;
  last_due_ = now_;
  const std::int64_t unix_ms = ports_.clock->unix_ms();
  // Before the first session, and after the clock was set back, the interval begins now.
  if (since_.unix_ms == 0 || since_.unix_ms > unix_ms + 3'600'000) since_.unix_ms = unix_ms;
  Since since = since_;
  since.motion_hours = motion_hours_ - since_.motion_hours;
  since.calibrated = can_check();
  const auto next = due(config_.schedule, since, unix_ms, senses_.celsius(), utc_offset(unix_ms));
  if (!next) return;
  Event event;
  event.what = Event::What::due;
  event.kind = next->kind;
  event.why = next->why;
  put(std::move(event));
}

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

void Service::act(const Action& action) {
  using Do = Action::Do;
  const auto reply = [&](bool accepted) {
    if (command_) messenger_.reply({command_->id, command_->verb, accepted, action.why});
    if (!accepted && command_) tell("warning", command_->verb + " refused: " + action.why);
  };
  const bool at_step =
      situation_.step >= 0 && situation_.step < static_cast<int>(session_.plan.size());
  static const StepRecord kNoStep;
  const StepRecord& step = at_step ? session_.plan[situation_.step] : kNoStep;
  const double travel = config_.speeds.travel;
  switch (action.what) {
    case Do::stop:
      return stop(action.why);
    case Do::give_up:
      computation_.give_up();
      when_computed_ = {};
      return;
    case Do::test:
      testing_ = true;
      test_began_ = now_;
      return;
    case Do::plan:
      return begin_plan(action.why);
    case Do::resume:
      return resume();
    case Do::go_home:
      return move(MoveKind::travel, {config_.plan.home.begin(), config_.plan.home.end()}, travel);
    case Do::go_to_start:
      return situation_.closed ? move(MoveKind::retract, step.start, touch_speed(step))
                               : move(MoveKind::travel, step.start, travel);
    case Do::go_touch:
      return move(step.group.empty() ? MoveKind::touch : MoveKind::seat, step.end,
                  touch_speed(step));
    case Do::go_back:
      return move(MoveKind::retract, step.start, 2 * touch_speed(step));
    case Do::back_off:
      return move(MoveKind::retract, reached_, travel / 4);
    case Do::read:
      return read_touch();
    case Do::put_aside:
      return put_aside(action.why);
    case Do::analyse:
      return analyse();
    case Do::identify:
      return identify();
    case Do::judge:
      return judge();
    case Do::apply:
      return apply(action.why);
    case Do::reject:
      return reject();
    case Do::roll_back:
      return roll_back();
    case Do::publish:
      return publish();
    case Do::abort:
      return abort(action.why);
    case Do::grant:
      return reply(true);
    case Do::refuse:
      return reply(false);
    case Do::tell:
      return tell(situation_.state == ServiceState::fault ? "error" : "info", action.why);
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
  remember_use();
  tell("info", "shut down");
  supervisor_.stopping();
}

}  // namespace selfcal
