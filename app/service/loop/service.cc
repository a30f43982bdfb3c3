#include "app/service/loop/service.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <vector>

namespace selfcal {
namespace {

constexpr Nanoseconds kResumeWithin = 120 * kSecond;  // of the start; later only a person resumes
constexpr Nanoseconds kStands = 5 * kSecond;          // before a session begins by itself
constexpr Nanoseconds kRemember = 60 * kSecond;       // between two savings of the hours of motion
constexpr Nanoseconds kPrune = 3600 * kSecond;        // where no session ends

}  // namespace

Service::Service(Config config, const Ports& ports, Messenger& messenger, Store& store,
                 Journal& journal, Models models, const std::string& damaged)
    : c_{std::move(config), ports, messenger, store, journal, std::move(models)},
      collector_(c_),
      analyst_(c_, collector_),
      reporter_(c_, collector_, analyst_, damaged) {
  c_.now = test_began_ = last_turn_ = began_ = moved_ = last_pruned_ = c_.ports.clock->now();
  c_.extended_state.since = c_.now;
  c_.extended_state.why = "testing encoders, trigger and store";
  testing_ = true;
  if (!damaged.empty())
    c_.tell("error", "the store was damaged: " + damaged);
  else
    reporter_.recall_damage();
  if (!c_.models.refused().empty()) c_.tell("error", c_.models.refused());
  const auto unfinished = c_.store.unfinished();
  if (c_.stored(unfinished)) c_.extended_state.unfinished = unfinished->has_value();
  finish_interrupted_apply();
  recall();
  c_.extended_state.candidate = c_.models.candidate();
  if (moves_) {  // by an earlier life, told to stop until it stands
    collector_.expect_motion();
    collector_.stop("the service has started");
  }
  c_.tell("info", "started with " + c_.models.name() + " parameters");
  reporter_.ready();
}

void Service::turn() {
  c_.now = c_.ports.clock->now();
  look_at_clock();
  collector_.listen();
  if (!collector_.stands()) moved_ = c_.now;
  if (collector_.front_end().moving()) c_.use.motion_hours += seconds(c_.now - last_turn_) / 3600;
  handle_commands();
  check_rivals();
  check_self();
  collector_.check_rest();
  collector_.check_stop();
  if (!may_move(c_.extended_state.state) && !collector_.moves()) note_motion(false);
  check_schedule();
  analyst_.take();
  c_.put(Event::What::tick);
  handle_events();
  reporter_.report();
  remember();
  if (collector_.reflex().alive(c_.now)) reporter_.alive();
  last_turn_ = c_.now;
  c_.ports.clock->wait(longest_wait());
}

void Service::handle_events() {
  while (!c_.events.empty()) {
    const Event event = std::move(c_.events.front());
    c_.events.pop_front();
    if (event.what == Event::What::moved) collector_.arrived();
    Transition transition = step(c_.extended_state, event, c_.config.limits);
    const bool held = c_.extended_state.held;
    const auto wanted = c_.extended_state.wanted;
    c_.extended_state = std::move(transition.next);
    // Before anything is written, which may take long.
    std::vector<Action>& actions = transition.actions;
    const auto others =
        std::stable_partition(actions.begin(), actions.end(),
                              [](const Action& each) { return each.what == Action::Do::stop; });
    for (const Action& stop : std::span(actions.begin(), others)) act(stop);
    if (c_.extended_state.held != held)
      c_.stored(c_.store.remember("held", c_.extended_state.held ? "yes" : ""));
    // Before the command is answered: what was granted is not lost.
    if (const auto& now = c_.extended_state.wanted; now != wanted)
      c_.stored(c_.store.remember(kWanted, now ? std::string(to_string(*now)) : ""));
    if (may_move(c_.extended_state.state)) note_motion(true);
    for (const Action& action : std::span(others, actions.end())) act(action);
  }
}

/// Once a session, before the robot is first asked and when it stands at the end: whoever starts
/// after a kill stops the robot in the first case, and leaves it at its work in the other.
void Service::note_motion(bool moves) {
  if (moves_ == moves) return;
  if (c_.stored(c_.store.remember(kMoves, moves ? "yes" : ""))) moves_ = moves;
}

Nanoseconds Service::longest_wait() const {
  switch (c_.extended_state.state) {
    case ServiceState::collecting:
      // An edge ends the wait early where the trigger can say so.
      return c_.extended_state.phase == Phase::touch || c_.extended_state.phase == Phase::settle
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

void Service::begin_test() {
  recall_models();
  testing_ = true;
  test_began_ = c_.now;
}

/// Two services of one robot would both move it: neither does.
void Service::check_rivals() {
  if (testing_ || c_.extended_state.state == ServiceState::fault) return;
  if (std::string others = collector_.rivals(); !others.empty())
    c_.put(Event::What::broken, false, std::move(others));
}

void Service::check_self() {
  if (!testing_) return;
  const std::string why = collector_.missing();
  if (!why.empty() && c_.now - test_began_ < c_.config.limits.self_test) return;
  testing_ = false;
  Event event;
  event.what = Event::What::self_tested;
  event.ok = why.empty();
  event.why = why;
  event.resume = c_.config.resume && !c_.extended_state.tested && c_.now - began_ < kResumeWithin;
  c_.put(std::move(event));
}

/// The robot may be at other work, which nothing that begins by itself disturbs.
void Service::check_schedule() {
  const ExtendedState& s = c_.extended_state;
  if (s.state != ServiceState::idle || c_.now - last_due_ < kSecond) return;
  last_due_ = c_.now;
  if (!c_.config.schedule.any() && !s.postponed) return;
  const std::optional<Due> next = s.postponed ? Due{s.kind, "the robot stands"} : scheduled();
  const bool stands = c_.now - moved_ >= kStands;
  if (next && stands) put_due(*next);
  const bool waits = next && !stands && !s.held && !s.postponed;  // of a postponed one it was told
  if (waits && !waits_)
    c_.tell("info", "a session is due (" + next->why +
                        ") and waits until the robot has stood for " +
                        format_number(seconds(kStands)) + " s");
  waits_ = waits;
}

std::optional<Due> Service::scheduled() {
  // Before the first session the interval begins now.
  if (c_.use.calendar.last_session_ms() == 0) c_.use.calendar.session_ended();
  Since since = c_.since();
  since.calibrated = analyst_.can_check();
  return due(c_.config.schedule, since, c_.unix_ms(), collector_.front_end().celsius(), utc_offset);
}

/// A clock that is not believed is told of where the schedule goes by it.
void Service::look_at_clock() {
  Calendar& calendar = c_.use.calendar;
  const bool believed = calendar.believed();
  calendar.look(c_.now, c_.unix_ms());
  if (calendar.believed() == believed || !c_.config.schedule.by_clock()) return;
  calendar.believed() ? c_.tell("info", "the clock is believed once more")
                      : c_.tell("warning", calendar.doubt());
}

void Service::put_due(const Due& next) {
  Event event;
  event.what = Event::What::due;
  event.kind = next.kind;
  event.why = next.why;
  c_.put(std::move(event));
}

/// Writing may take long: not while the robot is to be stopped at a touch.
void Service::remember() {
  const bool touching =
      c_.extended_state.state == ServiceState::collecting &&
      (c_.extended_state.phase == Phase::touch || c_.extended_state.phase == Phase::settle);
  if (c_.now - last_remembered_ < kRemember || touching) return;
  last_remembered_ = c_.now;
  c_.remember_use();
  if (c_.now - last_pruned_ < kPrune) return;
  last_pruned_ = c_.now;
  c_.prune();
}

void Service::recall() {
  // What cannot be read must not let the robot begin by itself.
  const auto held = c_.store.remembered("held");
  c_.extended_state.held = !held || *held == "yes";
  if (const auto wanted = c_.store.remembered(kWanted); wanted)
    c_.extended_state.wanted = kind_of(*wanted);
  const auto moves = c_.store.remembered(kMoves);
  moves_ = !moves || *moves == "yes";
  const auto line = c_.store.remembered("use");
  Usage& use = c_.use;
  long long last = 0, latest = 0;
  double temperature = std::nan("");
  if (line && std::sscanf(line->c_str(), "%lf %lld %lf %lf %d %lld", &use.motion_hours, &last,
                          &use.motion_hours_then, &temperature, &use.checks, &latest) >= 5) {
    if (!std::isnan(temperature)) use.temperature_then = temperature;
    use.calendar.recall(last, latest);
  }
  look_at_clock();
  tell_result();
}

void Service::shut_down() {
  if (may_move(c_.extended_state.state)) collector_.stop("the service is shutting down");
  if (c_.extended_state.engaged) collector_.release();
  c_.remember_use();
  c_.tell("info", "shut down");
  reporter_.stopping();
}

}  // namespace selfcal
