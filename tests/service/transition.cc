// The way of a session and of its touches through the states, as the state machine alone sees it.
#include "app/service/transitions/transition.h"

#include <gmock/gmock.h>

#include "tests/service/script.h"

namespace selfcal {
namespace {

using testing::HasSubstr;
using What = Event::What;
using Do = Action::Do;
using Decision = Event::Decision;

TEST(Transition, ArrivesInEachStateThatTheScriptAsksFor) {
  for (const ServiceState state : kAllStates)
    EXPECT_EQ(to_string(script_at(state).s.state), to_string(state));
  for (const Phase phase : kAllPhases)
    EXPECT_EQ(to_string(script_at(ServiceState::collecting, phase).s.phase), to_string(phase));
}

TEST(Transition, TakesATouchThroughApproachTouchSettleAndRetract) {
  Script script = script_at(ServiceState::planning);
  EXPECT_EQ(script.planned(2).done(), "go_home");
  EXPECT_EQ(script.s.phase, Phase::approach);
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
  EXPECT_EQ(script.s.phase, Phase::touch);
  EXPECT_EQ(script.on(What::closed).done(), "stop");
  EXPECT_EQ(script.s.phase, Phase::settle);
  EXPECT_EQ(script.on(What::at_rest).done(), "read");
  EXPECT_EQ(script.read(true, 1).done(), "go_back");
  EXPECT_EQ(script.s.phase, Phase::retract);
  EXPECT_EQ(script.on(What::opened).done(), "");
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
  EXPECT_EQ(script.s.phase, Phase::approach);
  EXPECT_EQ(script.s.step, 1);
}

TEST(Transition, GoesThroughHomeOnlyWhereThePlanSays) {
  Script script = script_at(ServiceState::planning);
  EXPECT_EQ(script.planned(3, SessionKind::full, 0, false).done(), "go_to_start");
  script.on(What::moved).on(What::closed).on(What::at_rest);
  Event read;
  read.what = What::read;
  read.step = 1;
  read.via_home = true;
  script.on(read).on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "go_home");
}

TEST(Transition, GoesAlongThePlacesOfTheWayBeforeTheStart) {
  Script script = script_at(ServiceState::planning);
  script.planned(3, SessionKind::full, 0, false);
  script.on(What::moved).on(What::closed).on(What::at_rest);
  Event read;
  read.what = What::read;
  read.step = 1;
  read.way = 2;
  script.on(read).on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "go_along");
  EXPECT_EQ(script.s.way, 2);
  EXPECT_EQ(script.on(What::moved).done(), "go_along");
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
  EXPECT_EQ(script.s.step, 1);
}

/// At the start of a touch before whose slow part a stretch is known to be free.
Script script_at_a_start_far_out(int step) {
  Script script = script_at(ServiceState::planning);
  script.planned(3, SessionKind::full, 0, false);
  script.on(What::moved).on(What::closed).on(What::at_rest);
  Event read;
  read.what = What::read;
  read.step = step;
  read.nearer = true;
  script.on(read).on(What::opened).on(What::moved);
  return script;
}

TEST(Transition, ComesNearerBeforeItTouchesWhereThatIsKnownToBeFree) {
  Script script = script_at_a_start_far_out(1);
  EXPECT_EQ(script.done(), "go_to_start");
  EXPECT_EQ(script.on(What::moved).done(), "go_nearer");
  EXPECT_EQ(script.s.phase, Phase::approach);
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
  EXPECT_EQ(script.s.phase, Phase::touch);
}

TEST(Transition, ComesNearerBeforeARepeat) {
  Script script = script_at_a_start_far_out(0);
  EXPECT_EQ(script.done(), "go_nearer");
  EXPECT_EQ(script.s.phase, Phase::approach);
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
}

TEST(Transition, IsSlowAllTheWayOnceItWasStruckWhereItShouldBeFree) {
  Script script = script_at_a_start_far_out(1);
  script.on(What::moved);
  EXPECT_EQ(script.on(What::closed).done(), "stop");
  EXPECT_EQ(script.on(What::at_rest).done(), "tell, back_off");
  script.on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "go_home");
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
}

TEST(Transition, GoesHomeFromAStrayContactWhateverTheWayWas) {
  Script script = script_at(ServiceState::planning);
  Event planned;
  planned.what = What::planned;
  planned.steps = 3;
  planned.way = 2;
  EXPECT_EQ(script.on(planned).done(), "go_along");
  script.on(What::closed).on(What::at_rest).on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "go_home");
  EXPECT_EQ(script.on(What::moved).done(), "go_to_start");
}

TEST(Transition, WaitsForTheTriggerToOpenAfterTheRetractHasEnded) {
  Script script = script_at(ServiceState::collecting, Phase::retract);
  EXPECT_EQ(script.on(What::moved).done(), "");
  EXPECT_EQ(script.s.phase, Phase::retract);
  EXPECT_EQ(script.on(What::opened).done(), "go_to_start");
}

TEST(Transition, TouchesAgainFromTheStartWhenTheStepWantsARepeat) {
  Script script = script_at(ServiceState::collecting, Phase::settle);
  script.on(What::at_rest).read(true, 0).on(What::opened);
  EXPECT_EQ(script.on(What::moved).done(), "go_touch");
  EXPECT_EQ(script.s.attempt, 1);
  EXPECT_EQ(script.s.step, 0);
}

TEST(Transition, TakesASessionFromTheStartToTheNewParameters) {
  Script script;
  EXPECT_EQ(script.on(What::self_tested).done(), "");
  EXPECT_EQ(script.ask(Verb::start).done(), "grant, plan");
  script.planned(2).touch_well(1);
  EXPECT_EQ(script.touch_well(2).done(), "analyse");
  EXPECT_EQ(script.on(What::computed).done(), "identify");
  EXPECT_EQ(script.on(What::computed).done(), "judge");
  EXPECT_EQ(script.decided(Decision::apply).done(), "apply");
  EXPECT_EQ(script.on(What::applied).done(), "publish");
  EXPECT_EQ(script.on(What::published).done(), "");
  EXPECT_EQ(script.s.state, ServiceState::idle);
  EXPECT_EQ(script.s.published, 1);
  EXPECT_FALSE(script.s.unfinished);
}

TEST(Transition, PlansAFurtherRoundFromWhatIsIdentifiedUntilNoMoreIsWanted) {
  Script script = script_at(ServiceState::planning);
  script.planned(1).touch_well(1).on(What::computed);
  Event event;
  event.what = What::computed;
  event.more = true;
  event.why = "the rest";
  EXPECT_EQ(script.on(event).done(), "plan");
  EXPECT_EQ(script.s.state, ServiceState::planning);
  EXPECT_TRUE(script.s.stored) << "it goes on after a restart";
  EXPECT_EQ(script.planned(2, SessionKind::full, 1).s.step, 1) << "further touches";
  EXPECT_EQ(script.touch_well(2).done(), "analyse");
  EXPECT_EQ(script.on(What::computed).done(), "identify");
  EXPECT_EQ(script.on(What::computed).done(), "judge");
}

TEST(Transition, LeavesTheParametersAloneWhenTheRulingSaysSo) {
  Script script = script_at(ServiceState::judging);
  EXPECT_EQ(script.decided(Decision::none, "no better").done(), "publish");
  EXPECT_EQ(script.on(What::published).s.state, ServiceState::idle);
  EXPECT_EQ(script.s.why, "no better");
}

TEST(Transition, AnalysesAtOnceWhatWasCollectedWhole) {
  EXPECT_EQ(script_at(ServiceState::planning).planned(4, SessionKind::full, 4).done(), "analyse");
}

// ----------------------------------------------------------------------- acceptance

TEST(Transition, ShowsACandidateToAPersonAndAppliesItWhenAccepted) {
  Script script = script_at(ServiceState::judging);
  EXPECT_EQ(script.decided(Decision::ask).done(), "publish");
  EXPECT_EQ(script.on(What::published).s.state, ServiceState::awaiting_acceptance);
  EXPECT_EQ(script.ask(Verb::accept).done(), "apply");
  EXPECT_EQ(script.s.state, ServiceState::applying);
  EXPECT_EQ(script.on(What::applied).done(), "publish");
  EXPECT_EQ(script.on(What::published).s.state, ServiceState::idle);
}

TEST(Transition, DropsACandidateThatIsRejectedAndPublishesThat) {
  Script script = script_at(ServiceState::awaiting_acceptance);
  EXPECT_EQ(script.ask(Verb::reject).done(), "reject, publish");
  EXPECT_EQ(script.on(What::published).s.state, ServiceState::idle);
  EXPECT_FALSE(script.s.candidate);
}

TEST(Transition, KeepsACandidateThroughARestartAndAFault) {
  Script script;
  script.s.candidate = true;
  EXPECT_EQ(script.on(What::self_tested).s.state, ServiceState::awaiting_acceptance);
  script.on(What::broken, false, "store").ask(Verb::start);
  EXPECT_EQ(script.on(What::self_tested).s.state, ServiceState::awaiting_acceptance);
}

// ---------------------------------------------------------------------- quick check

TEST(Transition, JudgesAQuickCheckWithoutIdentifyingAnything) {
  Script script = script_at(ServiceState::idle);
  EXPECT_EQ(script.ask(Verb::check).done(), "grant, plan");
  EXPECT_EQ(script.s.kind, SessionKind::check);
  script.planned(1, SessionKind::check).touch_well(1);
  EXPECT_EQ(script.on(What::computed).done(), "judge");
  EXPECT_EQ(script.decided(Decision::none).on(What::published).s.state, ServiceState::idle);
}

TEST(Transition, FollowsAQuickCheckThatIsNotExplainedByAFullSession) {
  Script script = script_at(ServiceState::idle);
  script.ask(Verb::check).planned(1, SessionKind::check).touch_well(1).on(What::computed);
  EXPECT_EQ(script.decided(Decision::full).done(), "publish");
  EXPECT_EQ(script.on(What::published).done(), "plan");
  EXPECT_EQ(script.s.kind, SessionKind::full);
  EXPECT_EQ(script.s.state, ServiceState::planning);
  script.planned(1).touch_well(1).on(What::computed).on(What::computed);
  script.decided(Decision::none).on(What::published);
  EXPECT_EQ(script.s.state, ServiceState::idle) << "one full session follows, not a second";
}

TEST(Transition, ForgetsTheSessionThatWasToFollowWhenAFaultComesBetween) {
  Script script = script_at(ServiceState::idle);
  script.ask(Verb::check).planned(1, SessionKind::check).touch_well(1).on(What::computed);
  script.decided(Decision::full).on(What::broken, false, "store: disk full");
  EXPECT_FALSE(script.s.follow_up);
}

TEST(Transition, BeginsWhatIsDueOnlyWhenIdle) {
  for (const ServiceState state : kAllStates) {
    Script script = script_at(state);
    Event due;
    due.what = What::due;
    due.kind = SessionKind::check;
    due.why = "every 24 h";
    script.on(due);
    EXPECT_EQ(script.done(), state == ServiceState::idle ? "plan" : "") << to_string(state);
    EXPECT_EQ(script.s.state, state == ServiceState::idle ? ServiceState::planning : state);
  }
}

// -------------------------------------------------------------------------- restart

TEST(Transition, ResumesAfterARestartOnlyWhenAsked) {
  Script waiting, going;
  waiting.s.unfinished = going.s.unfinished = true;
  EXPECT_EQ(waiting.on(What::self_tested).done(), "");
  EXPECT_EQ(waiting.s.state, ServiceState::idle);
  EXPECT_THAT(waiting.s.why, HasSubstr("start, or abort"));
  EXPECT_EQ(waiting.ask(Verb::start).done(), "grant, tell, resume");
  EXPECT_EQ(waiting.planned(5, SessionKind::full, 3).s.step, 3);

  Event tested;
  tested.what = What::self_tested;
  tested.resume = true;
  EXPECT_EQ(going.on(tested).done(), "tell, resume");
  EXPECT_EQ(going.s.state, ServiceState::planning);
}

TEST(Transition, HasNothingToResumeWithoutAnUnfinishedSession) {
  Event tested;
  tested.what = What::self_tested;
  tested.resume = true;
  EXPECT_EQ(Script().on(tested).s.state, ServiceState::idle);
}

}  // namespace
}  // namespace selfcal
