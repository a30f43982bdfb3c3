// Every command in every state, and two hundred thousand events in no order at all.
#include <gmock/gmock.h>

#include <random>
#include <set>

#include "tests/service/script.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using What = Event::What;
using Do = Action::Do;

constexpr Verb kVerbs[] = {Verb::start, Verb::check,  Verb::diagnose, Verb::done,
                           Verb::abort, Verb::accept, Verb::reject,   Verb::rollback};

/// Where a command is accepted, as the README has it.
bool accepted(Verb verb, ServiceState state) {
  switch (verb) {
    case Verb::start:
    case Verb::check:
    case Verb::diagnose:
      return state == ServiceState::idle || state == ServiceState::fault;
    case Verb::abort:
      return state == ServiceState::planning || state == ServiceState::collecting ||
             state == ServiceState::analysing || state == ServiceState::identifying ||
             state == ServiceState::judging || state == ServiceState::diagnosing ||
             state == ServiceState::awaiting_person;
    case Verb::done:
      return state == ServiceState::awaiting_person;
    case Verb::accept:
    case Verb::reject:
      return state == ServiceState::awaiting_acceptance;
    case Verb::rollback:
      return state == ServiceState::idle || state == ServiceState::fault;
  }
  return false;
}

/// What the store alone can answer is answered once it has done so.
bool answers(Do what) {
  return what == Do::grant || what == Do::refuse || what == Do::apply || what == Do::reject ||
         what == Do::roll_back;
}

TEST(Command, IsAcceptedOrRefusedWithAReasonInEveryState) {
  for (const ServiceState state : kAllStates)
    for (const Verb verb : kVerbs) {
      SCOPED_TRACE(std::string(to_string(verb)) + " in " + std::string(to_string(state)));
      Script script = script_at(state);
      const ExtendedState before = script.s;
      script.ask(verb);
      if (accepted(verb, state)) {
        EXPECT_TRUE(answers(script.actions.front().what));
        EXPECT_NE(script.actions.front().what, Do::refuse);
      } else {
        EXPECT_EQ(script.done(), "refuse");
        EXPECT_NE(script.why(Do::refuse), "");
        EXPECT_EQ(script.s.state, before.state);
        EXPECT_EQ(script.s.phase, before.phase);
        EXPECT_EQ(script.s.since, before.since);
      }
    }
}

TEST(Command, SaysInWhichStateTheServiceIsWhenItRefusesAStart) {
  EXPECT_EQ(script_at(ServiceState::collecting).ask(Verb::start).why(Do::refuse),
            "the service is collecting");
  EXPECT_THAT(script_at(ServiceState::awaiting_acceptance).ask(Verb::start).why(Do::refuse),
              HasSubstr("accept or reject it first"));
}

TEST(Command, DoesNotSayThatNoResultWaitsWhereOneDoes) {
  Script script = script_at(ServiceState::awaiting_acceptance);
  script.on(What::broken, false, "no reading");
  ASSERT_EQ(script.s.state, ServiceState::fault);
  for (const Verb verb : {Verb::accept, Verb::reject})
    EXPECT_EQ(script.ask(verb).why(Do::refuse), "the service is fault");
}

TEST(Command, AbortsByStoppingTheRobotBeforeAnythingElseHappens) {
  for (const Phase phase : kAllPhases)
    EXPECT_EQ(script_at(ServiceState::collecting, phase).ask(Verb::abort).done(),
              "grant, stop, abort");
  for (const ServiceState state :
       {ServiceState::planning, ServiceState::analysing, ServiceState::identifying,
        ServiceState::judging, ServiceState::diagnosing}) {
    Script script = script_at(state);
    EXPECT_EQ(script.ask(Verb::abort).done(), "grant, stop, abort");
    EXPECT_EQ(script.s.state, ServiceState::idle);
    EXPECT_FALSE(script.s.unfinished);
  }
}

TEST(Command, AbortsAnUnfinishedSessionThatWaitsAndLeavesTheStateAsItIs) {
  for (const ServiceState state : {ServiceState::self_test, ServiceState::idle,
                                   ServiceState::awaiting_acceptance, ServiceState::fault}) {
    Script script = script_at(state);
    script.s.unfinished = true;
    EXPECT_EQ(script.ask(Verb::abort).done(), "grant, stop, abort") << to_string(state);
    EXPECT_EQ(to_string(script.s.state), to_string(state));
    EXPECT_FALSE(script.s.unfinished);
  }
}

TEST(Command, DoesNotAbortWhileParametersAreBeingApplied) {
  Script script = script_at(ServiceState::applying);
  script.s.unfinished = true;
  EXPECT_EQ(script.ask(Verb::abort).done(), "refuse");
  EXPECT_EQ(script.on(What::applied).done(), "publish");
}

// ---------------------------------------------------------------------- in no order

Event random_event(std::mt19937_64& random, const ExtendedState& s) {
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Event event;
  event.what = static_cast<What>(below(static_cast<int>(What::broken) + 1));
  if (event.what == What::broken && below(8) != 0) event.what = What::moved;
  event.ok = below(6) != 0;
  event.resume = below(2) == 0;
  event.why = "because";
  event.verb = kVerbs[below(8)];
  event.kind = static_cast<SessionKind>(below(3));
  event.cause = below(4) == 0;
  event.loaded = below(4) == 0;
  event.load_unknown = below(4) == 0;
  event.session = 1;
  event.steps = event.what == What::planned ? 1 + below(5) : 0;
  event.step = event.what == What::planned ? below(event.steps + 1) : s.step + below(2);
  event.via_home = below(2) == 0;
  event.way = below(3);
  event.nearer = below(2) == 0;
  event.decision = static_cast<Event::Decision>(below(4));
  return event;
}

bool moves(Do what) {
  return what == Do::go_home || what == Do::go_to_start || what == Do::go_nearer ||
         what == Do::go_touch || what == Do::go_back || what == Do::back_off;
}

TEST(Transition, HoldsItsPromisesWhateverHappensInWhateverOrder) {
  std::set<ServiceState> seen;
  std::set<Phase> phases;
  const Limits limits;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937_64 random(seed);
    ExtendedState s;
    Nanoseconds now = 0;
    bool needs_start = false;  // a fault after the first self-test
    for (int i = 0; i < 1000; ++i) {
      now += static_cast<Nanoseconds>(random() % 500) * kMillisecond;
      Event event = random_event(random, s);
      event.now = now;
      const Transition t = step(s, event, limits);
      const std::string at = "seed " + std::to_string(seed) + ", event " + std::to_string(i) +
                             " in " + std::string(to_string(s.state));
      if (event.what == What::commanded &&
          (event.verb == Verb::start || event.verb == Verb::check || event.verb == Verb::diagnose))
        needs_start = false;
      for (const Action& action : t.actions)
        ASSERT_TRUE(!moves(action.what) || (may_move(t.next.state) && !needs_start))
            << at << name_of(action.what);
      const bool failed = t.next.state == ServiceState::fault && s.state != ServiceState::fault;
      const bool left = may_move(s.state) && !may_move(t.next.state);
      if (failed) {
        needs_start = s.tested;
        ASSERT_FALSE(t.actions.empty()) << at;
        ASSERT_EQ(t.actions.front().what, Do::stop) << at;
        ASSERT_NE(t.actions.front().why, "") << at;
        ASSERT_TRUE(!left || t.next.unfinished) << at;
      }
      ASSERT_EQ(t.next.phase == Phase::none, t.next.state != ServiceState::collecting) << at;
      ASSERT_LE(t.next.since, now) << at;
      if (t.next.state == ServiceState::collecting) {
        Event later;
        later.now = t.next.since + 61 * kSecond;  // longer than every limit of a phase
        ASSERT_EQ(step(t.next, later, limits).next.state, ServiceState::fault) << at;
        ASSERT_LT(t.next.step, t.next.steps) << at;
      }
      if (event.what == What::commanded) {
        int answered = 0;
        for (const Action& action : t.actions) answered += answers(action.what);
        ASSERT_EQ(answered, 1) << at;
      }
      s = t.next;
      seen.insert(s.state);
      phases.insert(s.phase);
    }
  }
  EXPECT_EQ(seen.size(), std::size(kAllStates)) << "the events reach every state";
  EXPECT_EQ(phases.size(), std::size(kAllPhases) + 1);
}

}  // namespace
}  // namespace selfcal
