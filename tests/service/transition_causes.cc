// Looking for a cause, and what a restart begins of what was granted.
#include <gmock/gmock.h>

#include "tests/service/script.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using What = Event::What;
using Do = Action::Do;
using Decision = Event::Decision;

Event decided_with_more(Decision decision) {
  Event event;
  event.what = What::decided;
  event.decision = decision;
  event.why = "the decision";
  event.cause = true;
  return event;
}

TEST(CauseTransition, TouchesAndDiagnosesInTurnUntilTheCauseIsDecided) {
  Script script = script_at(ServiceState::idle);
  EXPECT_EQ(script.ask(Verb::diagnose).done(), "grant, diagnose");
  EXPECT_EQ(script.s.state, ServiceState::diagnosing);
  script.planned(1, SessionKind::cause);
  EXPECT_EQ(script.s.state, ServiceState::collecting);
  EXPECT_EQ(script.touch_well(1).done(), "analyse");
  EXPECT_EQ(script.on(What::computed).done(), "diagnose");
  EXPECT_EQ(script.planned(3, SessionKind::cause, 1).s.step, 1) << "further touches";
  script.touch_well(2).touch_well(3).on(What::computed);
  EXPECT_EQ(script.decided(Decision::ask).done(), "publish");
  script.on(What::published);
  EXPECT_EQ(script.s.state, ServiceState::awaiting_acceptance);
}

TEST(CauseTransition, ComesToAResultWithoutAnyTouch) {
  Script script = script_at(ServiceState::diagnosing);
  Event decided;
  decided.what = What::decided;
  decided.session = 9;
  EXPECT_EQ(script.on(decided).done(), "publish");
  EXPECT_EQ(script.s.session, 9);
  EXPECT_EQ(script.on(What::published).s.state, ServiceState::idle);
}

TEST(CauseTransition, FollowsAFullSessionThatLeavesMoreThanNoise) {
  for (const Decision decision : {Decision::none, Decision::ask}) {
    Script script = script_at(ServiceState::judging);
    script.on(decided_with_more(decision));
    EXPECT_EQ(script.on(What::published).done(), "diagnose");
    EXPECT_EQ(script.s.kind, SessionKind::cause);
    EXPECT_EQ(script.s.candidate, decision == Decision::ask) << "it waits meanwhile";
    script.decided(Decision::none).on(What::published);
    EXPECT_EQ(script.s.state,
              decision == Decision::ask ? ServiceState::awaiting_acceptance : ServiceState::idle);
  }
  Script applied = script_at(ServiceState::judging);
  EXPECT_EQ(applied.on(decided_with_more(Decision::apply)).done(), "apply");
  applied.on(What::applied);
  EXPECT_EQ(applied.on(What::published).done(), "diagnose");
}

TEST(CauseTransition, LeavesAResultUndecidedWhileItsCauseIsLookedFor) {
  Script script = script_at(ServiceState::judging);
  script.on(decided_with_more(Decision::ask)).on(What::published);
  EXPECT_EQ(script.ask(Verb::accept).done(), "refuse");
  EXPECT_EQ(script.why(Do::refuse), "the service is diagnosing");
}

TEST(CauseTransition, KeepsWhatWasTouchedAndNothingBeforeThat) {
  Script before = script_at(ServiceState::diagnosing);
  EXPECT_FALSE(before.on(What::broken, false, "no reading").s.unfinished);
  Script after = script_at(ServiceState::diagnosing);
  after.planned(1, SessionKind::cause).touch_well(1).on(What::computed);
  EXPECT_TRUE(after.on(What::broken, false, "no reading").s.unfinished);
}

/// Good touches up to the next step, which wants the payload or not.
void touch_then(Script& script, int next, bool loaded) {
  while (script.s.via_home || script.s.way > 0) script.on(What::moved);
  script.on(What::moved).on(What::closed).on(What::at_rest);
  Event read;
  read.what = What::read;
  read.step = next;
  read.loaded = loaded;
  script.on(read).on(What::opened).on(What::moved);
}

TEST(CauseTransition, AsksAPersonToHangThePayloadOnAndToTakeItOff) {
  Script script = script_at(ServiceState::diagnosing);
  script.planned(2, SessionKind::cause);
  touch_then(script, 1, true);
  EXPECT_EQ(script.s.state, ServiceState::awaiting_person);
  EXPECT_THAT(script.s.why, HasSubstr("hang the payload on the tool"));
  EXPECT_EQ(script.ask(Verb::done).done(), "grant, go_home");
  EXPECT_EQ(script.s.state, ServiceState::collecting);
  touch_then(script, 2, false);
  EXPECT_EQ(script.s.state, ServiceState::awaiting_person);
  EXPECT_THAT(script.s.why, HasSubstr("take the payload off"));
  EXPECT_EQ(script.ask(Verb::done).done(), "grant, analyse");
}

// The way out of a contact is one that no contact ends.
TEST(CauseTransition, GoesNowhereFromAPersonWhileTheTriggerIsClosed) {
  Script script = script_at(ServiceState::diagnosing);
  script.planned(2, SessionKind::cause);
  touch_then(script, 1, true);
  script.on(What::closed);  // the payload leans on the probe
  EXPECT_EQ(script.ask(Verb::done).done(), "refuse");
  EXPECT_THAT(script.why(Do::refuse), HasSubstr("the trigger is closed"));
  EXPECT_EQ(script.s.state, ServiceState::awaiting_person);
  script.on(What::opened);
  EXPECT_EQ(script.ask(Verb::done).done(), "grant, go_home");

  touch_then(script, 2, false);
  script.on(What::closed);
  EXPECT_EQ(script.ask(Verb::done).done(), "grant, analyse") << "nothing moves";
}

TEST(CauseTransition, LeavesAContactOfAnEarlierLifeBeforeItAsksForThePayload) {
  Script script = script_at(ServiceState::diagnosing);
  script.on(What::closed);
  Event planned;
  planned.what = What::planned;
  planned.kind = SessionKind::cause;
  planned.steps = 3;
  planned.via_home = false;  // it stands in the touch that comes next
  planned.load_unknown = true;
  EXPECT_EQ(script.on(planned).done(), "back_off");
  script.on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "tell");
  EXPECT_EQ(script.s.state, ServiceState::awaiting_person);
}

TEST(CauseTransition, AsksForThePayloadAgainWhereAnEarlierLifeMayHaveChangedIt) {
  for (const bool loaded : {false, true}) {
    Script script = script_at(ServiceState::diagnosing);
    Event planned;
    planned.what = What::planned;
    planned.kind = SessionKind::cause;
    planned.steps = 3;
    planned.via_home = true;
    planned.loaded = loaded;
    planned.load_unknown = true;
    script.on(planned);
    EXPECT_EQ(script.s.state, ServiceState::awaiting_person);
    EXPECT_EQ(script.ask(Verb::done).done(), "grant, go_home");
    EXPECT_EQ(script.s.loaded, loaded);
  }
}

TEST(CauseTransition, SaysThatThePayloadIsStillOnTheToolWhenItEndsEarly) {
  Script script = script_at(ServiceState::awaiting_person);
  script.ask(Verb::done);
  Script broken = script;
  EXPECT_EQ(script.ask(Verb::abort).done(), "grant, stop, tell, abort");
  EXPECT_FALSE(script.s.loaded);
  EXPECT_THAT(broken.on(What::broken, false, "no reading").actions.back().why,
              HasSubstr("take it off"));
}

TEST(CauseTransition, TakesNoLongerThanItsLimit) {
  Script script = script_at(ServiceState::diagnosing);
  script.after(script.limits.diagnosing + kSecond);
  EXPECT_EQ(script.s.state, ServiceState::fault);
  EXPECT_EQ(script.s.why, "diagnosing took longer than 1800 s");
}

// ---------------------------------------------------------------------- granted, and killed

Event tested(bool resume) {
  Event event;
  event.what = What::self_tested;
  event.resume = resume;
  return event;
}

TEST(Granted, IsBegunByTheRestart) {
  for (const Verb verb : {Verb::start, Verb::check, Verb::diagnose}) {
    Script killed = script_at(ServiceState::idle);
    killed.ask(verb);
    ASSERT_TRUE(killed.s.wanted);
    Script restarted;
    restarted.s.wanted = killed.s.wanted;
    restarted.on(tested(true));
    EXPECT_EQ(restarted.done(), verb == Verb::diagnose ? "tell, diagnose" : "tell, plan");
    EXPECT_EQ(restarted.s.kind, killed.s.kind);
  }
}

TEST(Granted, IsDoneOnceItIsInTheStoreOrEnded) {
  EXPECT_FALSE(script_at(ServiceState::planning).planned(5).s.wanted);
  EXPECT_FALSE(script_at(ServiceState::planning).ask(Verb::abort).s.wanted);
  EXPECT_FALSE(script_at(ServiceState::planning).on(What::planned, false, "no plan").s.wanted);
}

TEST(Granted, IsToldOfWhereNothingMayBeginByItself) {
  Script restarted;
  restarted.s.wanted = SessionKind::full;
  restarted.on(tested(false));
  EXPECT_EQ(restarted.s.state, ServiceState::idle);
  EXPECT_THAT(restarted.s.why, HasSubstr("full session that was to begin before a restart"));
  EXPECT_FALSE(restarted.s.wanted);
}

TEST(Granted, WaitsForASelfTestThatFailsAtFirst) {
  Script restarted;
  restarted.s.wanted = SessionKind::full;
  restarted.on(What::self_tested, false, "no encoder readings come in");
  restarted.after(restarted.limits.retry_self_test + kSecond);
  EXPECT_EQ(restarted.on(tested(true)).done(), "tell, plan");
}

TEST(Granted, IncludesWhatFollowsAResult) {
  Script script = script_at(ServiceState::idle);
  script.ask(Verb::check).planned(1, SessionKind::check).touch_well(1).on(What::computed);
  script.decided(Decision::full);
  EXPECT_EQ(script.s.wanted, SessionKind::full);
}

}  // namespace
}  // namespace selfcal
